// drivers/lms200_scan.cpp: converts the value words of an LMS2xx to beams.
#include "drivers/lms200_scan.hpp"

#include <cmath>

#include "algo/units.hpp"

namespace drivers::lms200 {
namespace {

using algo::units::kRadiansPerDegree;

constexpr std::size_t kIndexBytes = 2;

/// Count word: bits 0-9 values, 11-12 part, 13 partial, 14-15 unit (0 cm, 1 mm).
struct CountWord {
  unsigned word = 0;

  std::size_t values() const { return word & 0x3FFU; }
  std::uint8_t part() const { return static_cast<std::uint8_t>((word >> 11U) & 3U); }
  bool partial() const { return (word & 0x2000U) != 0; }
  unsigned unit() const { return word >> 14U; }
};

/// The fields before the count word in each kind of answer.
struct Prefix {
  bool averaged = false;
  bool range = false;
  std::size_t size() const { return (averaged ? 1U : 0U) + (range ? 4U : 0U); }
};

std::optional<Prefix> prefix_of(std::uint8_t code) {
  switch (static_cast<Answer>(code)) {
    case Answer::Values:
      return Prefix{};
    case Answer::Means:
      return Prefix{.averaged = true};
    case Answer::RangeValues:
      return Prefix{.range = true};
    case Answer::MeanRange:
      return Prefix{.averaged = true, .range = true};
    default:
      return std::nullopt;
  }
}

/// The last digit of a code gives its meaning; the meaning of other digits is unknown.
void decode_code(unsigned code, std::size_t i, algo::LaserScan& scan) {
  using algo::BeamCode;
  const auto digit = static_cast<BeamCode>(code & 0xFU);
  switch (digit) {
    case BeamCode::BeyondRange:
      scan.set_free(i);
      return;
    case BeamCode::ReadError:
    case BeamCode::WeakSignal:
    case BeamCode::Overflow:
    case BeamCode::Dazzled:
    case BeamCode::NoEcho:
      scan.set_invalid(i, digit);
      return;
    default:
      scan.set_invalid(i, BeamCode::Unknown);
  }
}

double metres_per_unit(bool in_millimetres) {
  return in_millimetres ? 0.001 : 0.01;
}

bool interlaced(const Variant& variant) {
  return variant == Variant{180, 25};
}

}  // namespace

std::size_t scan_bytes(const Variant& variant) {
  constexpr std::size_t kAround = 4;  // code, count word, status
  return 2 * variant.beams() + kAround + kFrameBytes;
}

bool carries(const Variant& variant, unsigned baud) {
  const Variant part{180, 100};
  return !interlaced(variant) || transfer_time(scan_bytes(part), baud) <= kTurnPeriod;
}

double scan_period(const Variant& variant, unsigned baud) {
  const double sweep = variant.turns() * kTurnPeriod;
  const double turns = transfer_time(scan_bytes(variant), baud) / sweep;
  if (turns <= 1 || interlaced(variant)) return sweep;
  return (std::ceil(turns) + 1) * sweep;
}

std::optional<MeasuredValues> measured_values(const Telegram& telegram) {
  constexpr std::size_t kAround = 2;  // code and status
  const std::optional<Prefix> prefix = prefix_of(telegram.code());
  if (!prefix || telegram.payload.size() < kAround + prefix->size() + 2) return std::nullopt;
  const ByteView data = telegram.data();
  const CountWord count{word_at(data, prefix->size())};
  const ByteView rest = data.subspan(prefix->size() + 2);
  const std::size_t bytes = 2 * count.values();
  const bool indexed = rest.size() == bytes + kIndexBytes;
  if ((rest.size() != bytes && !indexed) || count.unit() > 1) return std::nullopt;

  MeasuredValues values{.in_millimetres = count.unit() == 1,
                        .partial = count.partial(),
                        .part = count.part(),
                        .range = prefix->range,
                        .words = rest.first(bytes),
                        .health = Health(telegram.status())};
  if (prefix->averaged) values.averaged = data[0];
  if (prefix->range) {
    const std::size_t at = prefix->averaged ? 1 : 0;
    values.first = word_at(data, at);
    const std::size_t last = word_at(data, at + 2);
    if (values.first == 0 || last + 1 != values.first + values.size()) return std::nullopt;
  }
  if (indexed) values.indices = Indices{.turn = rest[bytes], .telegram = rest[bytes + 1]};
  return values;
}

std::optional<WordFormat> word_format(std::uint8_t measuring_mode) {
  switch (measuring_mode) {
    case 0x00:
    case 0x01:
    case 0x02:
      return WordFormat{.mask = 0x1FFF, .top = 0x1FFF};
    case 0x03:
    case 0x04:
      return WordFormat{.mask = 0x3FFF, .top = 0x3FFF};
    case 0x05:
    case 0x06:
      return WordFormat{.mask = 0x7FFF, .top = 0x7FFF};
    case 0x0F:
      // All bits hold the distance, yet the range is 32 m as in the modes above. The manual does
      // not give this mode's codes. No distance can reach the codes of the other modes.
      return WordFormat{.mask = 0xFFFF, .top = 0x7FFF};
    default:
      return std::nullopt;
  }
}

void ScanDecoder::prepare(bool in_millimetres,
                          std::size_t first,
                          std::size_t beams,
                          algo::LaserScan& scan) const {
  // Right to left: 0 degrees of the device is its right side. Its smaller field of view is centred
  // in the larger one.
  const double step_degrees = variant_.step_centidegrees / 100.0;
  const double first_degrees =
      static_cast<double>(first) * step_degrees - variant_.angle_degrees / 2.0;
  scan.angle_min = first_degrees * kRadiansPerDegree;
  scan.angle_increment = step_degrees * kRadiansPerDegree;
  scan.range_max = format_.top * metres_per_unit(in_millimetres);
  scan.turn_period = kTurnPeriod;
  scan.turns = variant_.turns();
  scan.resize(beams);
}

void ScanDecoder::decode_word(std::uint16_t word,
                              bool in_millimetres,
                              std::size_t i,
                              algo::LaserScan& scan) const {
  constexpr unsigned kCodes = 8;  // values below the top that are codes
  const unsigned value = word & format_.mask;
  if (value + kCodes >= format_.top) {
    decode_code(value, i, scan);
  } else {
    // Divides as algo/laser_scan.hpp does, so that a packed beam gives the same bits as the device.
    scan.set_ok(i, static_cast<double>(value) / (in_millimetres ? 1000.0 : 100.0));
  }
}

bool ScanDecoder::decode(const MeasuredValues& values, algo::LaserScan& scan) const {
  const std::size_t first = values.first - 1U;
  const std::size_t beams = variant_.beams();
  // Beam 0 of a LaserScan is of the first mirror turn, so a range must begin at such a beam.
  const bool range_fits =
      values.size() > 0 && first + values.size() <= beams && first % variant_.turns() == 0;
  const bool fits = values.range ? range_fits : values.size() == beams;
  if (values.partial || !fits) return false;
  prepare(values.in_millimetres, first, values.size(), scan);
  for (std::size_t i = 0; i < values.size(); ++i) {
    decode_word(values.word(i), values.in_millimetres, i, scan);
  }
  return true;
}

bool PartialScans::follows(const MeasuredValues& values) const {
  // Parts are counted in quarters of a degree.
  const std::uint32_t quarters = decoder_.variant().step_centidegrees / 25U;
  if (values.part != turn_ * quarters) return false;
  if (turn_ == 0) return true;
  if (values.in_millimetres != in_millimetres_) return false;
  if (!values.indices || !last_) return values.indices.has_value() == last_.has_value();
  return values.indices->turn == static_cast<std::uint8_t>(last_->turn + 1U);
}

bool PartialScans::add(const MeasuredValues& values, algo::LaserScan& scan) {
  const std::uint32_t turns = decoder_.variant().turns();
  const std::size_t beams = decoder_.variant().angle_degrees + (values.part == 0 ? 1U : 0U);
  if (!values.partial || values.size() != beams || !follows(values)) {
    if (turn_ != 0) ++dropped_;
    turn_ = 0;
    // A part out of order may begin the next sweep.
    if (!values.partial || values.size() != beams || values.part != 0) return false;
  }
  if (turn_ == 0) {
    in_millimetres_ = values.in_millimetres;
    decoder_.prepare(in_millimetres_, 0, decoder_.variant().beams(), scan);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    decoder_.decode_word(values.word(i), in_millimetres_, i * turns + turn_, scan);
  }
  last_ = values.indices;
  turn_ = (turn_ + 1) % turns;
  return turn_ == 0;
}

}  // namespace drivers::lms200
