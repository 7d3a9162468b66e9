// drivers/lms200_telegram.cpp: check value and frame of LMS2xx telegrams.
#include "drivers/lms200_telegram.hpp"

namespace drivers::lms200 {
namespace {

constexpr std::size_t kHeaderBytes = 4;  // start mark, address, length
constexpr std::size_t kCrcBytes = 2;

}  // namespace

std::uint16_t crc(ByteView bytes) {
  constexpr unsigned kPolynomial = 0x8005;
  unsigned value = 0;
  unsigned previous = 0;
  for (const std::uint8_t byte : bytes) {
    const bool carry = (value & 0x8000U) != 0;
    value = (value << 1U) & 0xFFFFU;
    if (carry) value ^= kPolynomial;
    value ^= (previous << 8U) | byte;
    previous = byte;
  }
  return static_cast<std::uint16_t>(value);
}

Telegram telegram_of(ByteView frame) {
  return {.address = frame[1], .payload = frame.subspan(kHeaderBytes, frame.size() - kFrameBytes)};
}

FrameStart Framing::start(ByteView bytes) const {
  using Kind = FrameStart::Kind;
  if (bytes[0] != kStart) return {};
  if (bytes.size() < 2) return {.kind = Kind::TooShortToTell};
  const bool from_device = bytes[1] >= kAnswerAddress;
  if (from_device != (sender == Sender::Device)) return {};
  if (bytes.size() < kHeaderBytes) return {.kind = Kind::TooShortToTell};
  const std::size_t length = word_at(bytes, 2);
  const std::size_t shortest = from_device ? 2 : 1;  // code and status, or the code alone
  if (length < shortest || length > kLongestLength) return {};
  return {.kind = Kind::Frame, .size = length + kFrameBytes};
}

bool Framing::intact(ByteView frame) const {
  const ByteView checked = frame.first(frame.size() - kCrcBytes);
  return crc(checked) == word_at(frame, checked.size());
}

}  // namespace drivers::lms200
