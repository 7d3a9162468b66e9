// drivers/psd_machine.cpp: takes lines, judges them, and reports in words.
#include "drivers/psd_machine.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace drivers::psd {
namespace {

constexpr double kWake = 0.1;     // [s] between two looks at a silent line
constexpr double kBroken = 0.25;  // [s] after which the rest of a line does not come any more
constexpr double kStormShare = 0.5;
constexpr double kCalmShare = 0.1;
constexpr double kWeight = 0.1;  // of a line in the share of damaged ones, and in the mean interval
constexpr double kSlow = 2 * kPeriod;     // [s] mean interval of an adapter that is too slow
constexpr double kLongest = 4 * kPeriod;  // [s] a longer one is a silence, and counts as this

}  // namespace

void PsdMachine::opened(double now, unsigned baud) {
  reader_.clear();
  stuck_.restart();
  clock_.restart();
  open_ = true;
  running_ = storm_ = false;
  damaged_ = 0;
  interval_ = kPeriod;
  stray_ = 0;
  port_baud_ = baud;
  last_ = heard_ = 0;
  wake_ = now + kWake;
}

void PsdMachine::closed(double /*now*/, const std::string& why) {
  reader_.clear();
  open_ = running_ = fresh_ = false;
  trouble_ = why;
  wake_ = std::numeric_limits<double>::infinity();
}

void PsdMachine::receive(double now, ByteView bytes) {
  if (bytes.empty()) return;
  heard_ = now;
  const std::uint64_t bad = reader_.counters().bad_checks;
  reader_.feed(
      bytes,
      [&](ByteView line) { take_line(now, line); },
      [&](std::uint8_t byte) { stray_ += byte == '\r' || byte == '\n' ? 0U : 1U; });
  for (std::uint64_t i = bad; i < reader_.counters().bad_checks; ++i) note_damage(true);
  for (; stray_ >= kLineBytes; stray_ -= kLineBytes) note_damage(true);
}

void PsdMachine::take_line(double now, ByteView line) {
  const Reading reading = *parse(line);  // the reader has checked it
  note_damage(false);
  stray_ = 0;
  ++readings_;
  newest_ = reading;
  running_ = true;
  if (last_ > 0) note_interval(now - last_);
  last_ = now;
  stuck_.see(reading);
  clock_.see(now, reading.clock_ms);
  constexpr double kBitsOfAByte = 10;
  const double sending = port_baud_ == 0 ? 0 : kBitsOfAByte * kLineBytes / port_baud_;
  std::array<double, kSensors> metres{};
  for (std::size_t i = 0; i < kSensors; ++i) metres[i] = setup_.tables[i].distance(volts(i));
  ranges_ = {now - sending, metres[0], metres[1], metres[2], metres[3]};
  fresh_ = true;
}

void PsdMachine::note_damage(bool damaged) {
  damaged_ += kWeight * ((damaged ? 1.0 : 0.0) - damaged_);
  storm_ = damaged_ > (storm_ ? kCalmShare : kStormShare);
}

void PsdMachine::note_interval(double seconds) {
  interval_ += kWeight * (std::min(seconds, kLongest) - interval_);
}

void PsdMachine::advance(double now) {
  if (!open_) return;
  if (reader_.pending() > 0 && now - heard_ > kBroken) {
    reader_.expire([&](ByteView line) { take_line(now, line); }, [](std::uint8_t) {});
  }
  if (now - last_ > kSilent) running_ = false;
  if (now >= wake_) wake_ = now + kWake;
}

double PsdMachine::volts(std::size_t sensor) const {
  return newest_.counts[sensor] * setup_.full_scale / (algo::kPsdMostCounts + 1);
}

bool PsdMachine::take(algo::FloorRanges& ranges) {
  if (!fresh_) return false;
  ranges = ranges_;
  fresh_ = false;
  return true;
}

PsdMachine::Fault PsdMachine::fault(double now) const {
  if (!running_) return Fault::None;  // the robot sees that it is not
  if (storm_) return Fault::BadLine;
  if (clock_.jump(now)) return Fault::ClockJumped;
  if (interval_ > kSlow) return Fault::Slow;
  if (stuck_.frozen()) return Fault::Frozen;
  if (stuck_.stuck()) return Fault::Stuck;
  return Fault::None;
}

std::string PsdMachine::words(Fault fault, double now) const {
  switch (fault) {
    case Fault::None:
      return "Well.";
    case Fault::BadLine:
      return fmt::format(
          "{:.0f} % of its lines are damaged: look at the cable and its shield, and at `rate`.",
          100 * damaged_);
    case Fault::ClockJumped:
      return fmt::format("Its clock jumped by {:.1f} s: it restarted, or it held readings back.",
                         clock_.jump(now).value_or(0));
    case Fault::Slow:
      return fmt::format(
          "{:.0f} readings a second arrive instead of {:.0f}: its program is too slow.",
          1 / interval_,
          1 / kPeriod);
    case Fault::Frozen:
      return fmt::format(
          "None of its four counts has changed for {} readings: its converter stands still.",
          StuckWatch::kReadings);
    case Fault::Stuck:
      break;
  }
  const std::size_t sensor = stuck_.stuck().value_or(0);
  return fmt::format(
      "The {} sensor is stuck: its count was {} in {} readings while others changed. Look at its "
      "plug, its supply, and whether something lies right before it.",
      kSensorNames[sensor],
      newest_.counts[sensor],
      StuckWatch::kReadings);
}

std::string PsdMachine::why_silent(double now) const {
  if (!open_) return trouble_;
  if (heard_ > last_ + kSilent / 2 && now - heard_ < kSilent) {
    return fmt::format(
        "Bytes arrive at {} bit/s, but no whole line: look at `rate` and at the cable.",
        setup_.baud);
  }
  if (last_ > 0) return fmt::format("It has been silent for {:.1f} s.", now - last_);
  return "Nothing arrives: is the adapter powered, and is this its port?";
}

FloorState PsdMachine::state(double now) const {
  return {.running = running_,
          .last_reading = last_,
          .period = kPeriod,
          .faulty = fault(now) != Fault::None};
}

algo::DeviceReport PsdMachine::report(double now) const {
  algo::DeviceReport out;
  const Fault wrong = fault(now);
  const bool silent = !running_ || now - last_ > kSilent / 2;
  out.well = wrong == Fault::None && !silent;
  out.sentence = wrong == Fault::None && silent ? why_silent(now) : words(wrong, now);
  out.facts = {{"kind", "adapter of four Sharp GP2D12"}};
  if (port_baud_ > 0) out.facts.emplace_back("rate", fmt::format("{} bit/s", port_baud_));
  if (readings_ > 0) {
    for (std::size_t i = 0; i < kSensors; ++i) {
      const double metres = setup_.tables[i].distance(volts(i));
      out.facts.emplace_back(kSensorNames[i],
                             std::isnan(metres)
                                 ? fmt::format("nothing within range ({:.2f} V)", volts(i))
                                 : fmt::format("{:.3f} m ({:.2f} V)", metres, volts(i)));
    }
    out.facts.emplace_back("newest reading", fmt::format("{:.2f} s ago", now - last_));
  }
  out.facts.emplace_back("readings", std::to_string(readings_));
  const LineCounters& line = reader_.counters();
  out.facts.emplace_back("damaged lines", std::to_string(line.bad_checks + line.given_up));
  out.facts.emplace_back("clock jumps", std::to_string(clock_.jumps()));
  return out;
}

}  // namespace drivers::psd
