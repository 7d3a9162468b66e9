// drivers/psd_protocol.cpp: lines of the floor sensors' adapter, written and read.
#include "drivers/psd_protocol.hpp"

#include <algorithm>
#include <string_view>

namespace drivers::psd {
namespace {

constexpr std::string_view kMark = "$PSD,";
constexpr std::size_t kClockDigits = 10;
constexpr std::size_t kCountDigits = 4;
constexpr std::size_t kCheckDigits = 4;
constexpr std::size_t kCheckAt = Framing::kLongest - kCheckDigits - 1;  // of the asterisk

/// `value` in `digits` digits to `base`, with zeros in front.
template <std::size_t N>
void put(FixedBytes<N>& out, std::uint64_t value, std::size_t digits, unsigned base) {
  std::uint64_t unit = 1;
  for (std::size_t i = 1; i < digits; ++i) unit *= base;
  for (; unit > 0; unit /= base) {
    out.push_back(static_cast<std::uint8_t>("0123456789ABCDEF"[value / unit % base]));
  }
}

/// The value of one digit to `base`; nothing for another character.
std::optional<unsigned> digit_of(std::uint8_t byte, unsigned base) {
  unsigned value = base;
  if (byte >= '0' && byte <= '9') value = byte - unsigned{'0'};
  if (byte >= 'A' && byte <= 'F') value = 10 + byte - unsigned{'A'};
  if (value >= base) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> number_in(ByteView digits, unsigned base) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : digits) {
    const auto digit = digit_of(byte, base);
    if (!digit) return std::nullopt;
    value = value * base + *digit;
  }
  return value;
}

}  // namespace

std::uint16_t crc(ByteView bytes) {
  unsigned sum = 0xFFFFU;
  for (const std::uint8_t byte : bytes) {
    sum ^= unsigned{byte} << 8U;
    for (int bit = 0; bit < 8; ++bit) {
      sum = ((sum << 1U) ^ ((sum & 0x8000U) != 0 ? 0x1021U : 0U)) & 0xFFFFU;
    }
  }
  return static_cast<std::uint16_t>(sum);
}

FixedBytes<kLineBytes> line_of(const Reading& reading) {
  FixedBytes<kLineBytes> line;
  line.append(kMark);
  put(line, reading.clock_ms, kClockDigits, 10);
  for (const std::uint16_t count : reading.counts) {
    line.append(",");
    put(line, std::min(count, algo::kPsdMostCounts), kCountDigits, 10);
  }
  const std::uint16_t check = crc(line.view().subspan(1));
  line.append("*");
  put(line, check, kCheckDigits, 16);
  line.append("\r\n");
  return line;
}

std::optional<Reading> parse(ByteView frame) {
  if (frame.size() != Framing::kLongest || !text_of(frame).starts_with(kMark)) return std::nullopt;
  const auto check = number_in(frame.subspan(kCheckAt + 1), 16);
  if (frame[kCheckAt] != '*' || check != crc(frame.subspan(1, kCheckAt - 1))) return std::nullopt;
  Reading reading;
  std::size_t at = kMark.size();
  const auto clock = number_in(frame.subspan(at, kClockDigits), 10);
  if (!clock || *clock > UINT32_MAX) return std::nullopt;
  reading.clock_ms = static_cast<std::uint32_t>(*clock);
  at += kClockDigits;
  for (std::uint16_t& count : reading.counts) {
    const auto value = number_in(frame.subspan(at + 1, kCountDigits), 10);
    if (frame[at] != ',' || !value || *value > algo::kPsdMostCounts) return std::nullopt;
    count = static_cast<std::uint16_t>(*value);
    at += 1 + kCountDigits;
  }
  return reading;
}

FrameStart Framing::start(ByteView bytes) const {
  const std::size_t known = std::min(bytes.size(), kMark.size());
  if (text_of(bytes.first(known)) != kMark.substr(0, known)) return {};
  if (known < kMark.size()) return {FrameStart::Kind::TooShortToTell, 0};
  return {FrameStart::Kind::Frame, kLongest};
}

}  // namespace drivers::psd
