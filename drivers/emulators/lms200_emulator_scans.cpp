// drivers/emulators/lms200_emulator_scans.cpp: measured values of an LMS200 and their telegrams.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "algo/units.hpp"
#include "drivers/emulators/lms200_emulator.hpp"
#include "drivers/emulators/lms200_words.hpp"

namespace drivers::lms200 {

void Emulator::dazzle(bool on, double cone) {
  dazzled_ = on;
  cone_ = cone;
  was_dazzled_ = was_dazzled_ || on;
}

void Emulator::note_sweep() {
  sweep_ = {.variant = variant_};
  if (!stream_.parts) return;
  const bool quarters = options_.interlaced && variant_.angle_degrees == 180;
  const unsigned step = quarters ? 1 : variant_.step_centidegrees / 25U;
  for (unsigned part = 0; part < 4; part += step) {
    sweep_.parts.push_back(static_cast<std::uint8_t>(part));
  }
}

std::uint16_t Emulator::word_of(const algo::LaserScan& scan, std::size_t beam) const {
  constexpr std::uint16_t kEnergy = 100;  // a mid-range value, without a unit
  const auto layout = layout_of(configuration_.measuring_mode());
  if (!layout) return scan.status[beam] == algo::Beam::Ok ? kEnergy : 0;
  const auto code = [&layout](algo::BeamCode digit) {
    return static_cast<std::uint16_t>((layout->top & ~0xFU) | static_cast<unsigned>(digit));
  };
  if (dazzled_ && std::abs(scan.angle(beam)) <= cone_ / 2) {
    return static_cast<std::uint16_t>(code(algo::BeamCode::Dazzled) | layout->dazzle);
  }
  if (scan.status[beam] == algo::Beam::Free) return code(algo::BeamCode::BeyondRange);
  if (scan.status[beam] == algo::Beam::Invalid) {
    const bool known = scan.codes[beam] > algo::BeamCode::Unknown;
    return code(known ? scan.codes[beam] : algo::BeamCode::NoEcho);
  }
  const double per_metre = configuration_.in_millimetres() ? 1000 : 100;
  const int value = rounded(scan.ranges[beam] * per_metre, 0xFFFF);
  if (value < 0 || static_cast<unsigned>(value) + kCodes >= layout->top) {
    return code(algo::BeamCode::BeyondRange);
  }
  const bool in_field = scan.ranges[beam] < options_.field_a;
  return static_cast<std::uint16_t>(static_cast<unsigned>(value) |
                                    (in_field ? layout->field_a : 0U));
}

void Emulator::convert(const algo::LaserScan& scan, std::optional<std::uint8_t> part) {
  using algo::units::kRadiansPerDegree;
  const std::size_t values =
      part ? variant_.angle_degrees + (*part == 0 ? 1U : 0U) : variant_.beams();
  const double step = (part ? 100 : variant_.step_centidegrees) / 100.0 * kRadiansPerDegree;
  const double first = -variant_.angle_degrees / 2.0 * kRadiansPerDegree +
                       (part ? *part * 0.25 * kRadiansPerDegree : 0.0);
  const auto layout = layout_of(configuration_.measuring_mode());
  words_.assign(values, layout ? layout->top : std::uint16_t{0});
  for (std::size_t i = 0; i < values; ++i) {
    const double bearing = first + static_cast<double>(i) * step;
    const double beam = (bearing - scan.angle_min) / scan.angle_increment;
    if (!(beam > -0.5) || beam > static_cast<double>(scan.size()) - 0.5) continue;
    words_[i] = word_of(scan, static_cast<std::size_t>(std::lround(std::max(beam, 0.0))));
  }
}

/// Adds words_ to the sums, without flags and codes.
void Emulator::average() {
  if (summed_ == 0 || sums_.size() != words_.size()) {
    sums_.assign(words_.size(), 0);
    summands_.assign(words_.size(), 0);
    summed_ = 0;
  }
  const auto layout = layout_of(configuration_.measuring_mode()).value_or(WordLayout{});
  for (std::size_t i = 0; i < words_.size(); ++i) {
    const unsigned value = words_[i] & layout.top;
    if (value + kCodes >= layout.top) continue;
    sums_[i] += value;
    ++summands_[i];
  }
  ++summed_;
}

void Emulator::offer(const algo::LaserScan& scan, double now, std::optional<std::uint8_t> part) {
  advance(now);
  if (!started(now)) return;
  ++sweeps_;
  turn_index_ = static_cast<std::uint8_t>(turn_index_ + (part ? 1U : variant_.turns()));
  const bool once = once_.code != 0;
  const Taking taking = once ? once_ : stream_;
  if (taking.code == 0 || taking.parts != part.has_value()) return;
  convert(scan, part);
  if (taking.means > 1) {
    average();
    if (summed_ < taking.means) return;
    summed_ = 0;
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (summands_[i] > 0) {
        words_[i] = static_cast<std::uint16_t>(std::lround(sums_[i] / summands_[i]));
      }
    }
  }
  send_values(taking, now, part);
  if (once) once_ = {};
}

void Emulator::send_values(const Taking& taking, double now, std::optional<std::uint8_t> part) {
  constexpr unsigned kPartial = 0x2000;
  constexpr unsigned kMillimetres = 0x4000;
  SentScan scan{.number = sweeps_, .part = part};
  std::span<const std::uint16_t> words(words_);
  if (taking.range) {
    words = words.subspan(taking.range->first - 1U, taking.range->last - taking.range->first + 1U);
  }
  const auto layout = layout_of(configuration_.measuring_mode());
  for (const std::uint16_t word : words) {
    scan.beams.push_back(layout ? beam_of(word, *layout, configuration_.in_millimetres()) : word);
  }
  // The line carries one telegram at a time, and the device buffers no second one.
  if (line().free_at() > now || !jobs_.empty() || now < deaf_until_) {
    scan.fate = SentScan::Fate::Lost;
    scan.end = now;
    if (on_scan) on_scan(scan);
    return;
  }
  FixedBytes<kLongestLength> data;
  if (taking.means > 1) data.push_back(static_cast<std::uint8_t>(taking.means));
  if (taking.range) {
    data.append_word(taking.range->first);
    data.append_word(taking.range->last);
  }
  auto count = static_cast<unsigned>(words.size());
  if (part) count |= kPartial | (unsigned{*part} << 11U);
  if (configuration_.in_millimetres()) count |= kMillimetres;
  data.append_word(static_cast<std::uint16_t>(count));
  for (const std::uint16_t word : words) data.append_word(word);
  if (configuration_.sends_indices()) {
    data.push_back(turn_index_);
    data.push_back(telegram_index_);
  }
  ++telegram_index_;
  const emulators::Sending sending = say(taking.code, data.view(), now);
  scan.fate = sending.intact ? SentScan::Fate::Sent : SentScan::Fate::Damaged;
  scan.end = sending.end;
  leaving_ = std::move(scan);
}

void Emulator::close_scan(SentScan::Fate fate) {
  SentScan scan = std::move(*leaving_);
  leaving_.reset();
  scan.fate = fate;
  if (on_scan) on_scan(scan);
}

}  // namespace drivers::lms200
