// drivers/psd_machine.hpp: the floor sensors' adapter: its lines as distances, and its faults.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "drivers/floor_sense.hpp"
#include "drivers/machine.hpp"
#include "drivers/psd_protocol.hpp"
#include "drivers/psd_table.hpp"
#include "drivers/psd_watch.hpp"

namespace drivers::psd {

/// [psd] of the robot's file.
struct PsdSetup {
  unsigned baud = 115'200;
  double full_scale = algo::kPsdReference;  // [V] of the converter: one count beyond its last
  std::array<Table, kSensors> tables{};
};

/// As people call the sensors, in the line's order.
constexpr std::array<const char*, kSensors> kSensorNames{
    "far left", "far right", "near left", "near right"};

/// The adapter sends by itself; nothing is sent to it.
class PsdMachine final : public Machine {
 public:
  explicit PsdMachine(PsdSetup setup) : setup_(std::move(setup)) {}

  unsigned opening_baud() const override { return setup_.baud; }
  void opened(double now, unsigned baud) override;
  void closed(double now, const std::string& why) override;
  void rate_set(double /*now*/, unsigned /*baud*/) override {}
  void receive(double now, ByteView bytes) override;
  void lost_bytes() override { reader_.clear(); }
  void advance(double now) override;
  double wake_time() const override { return wake_; }
  std::optional<LineOrder> next_order() override { return std::nullopt; }
  void leave(double /*now*/) override {}
  bool left() const override { return true; }

  /// As in FloorSense.
  bool take(algo::FloorRanges& ranges);
  FloorState state(double now) const;
  const Reading& newest() const { return newest_; }
  std::uint64_t readings() const { return readings_; }
  /// The caller fills name and port.
  algo::DeviceReport report(double now) const;

 private:
  static constexpr double kSilent = 1.0;  // [s] without a line: it is not running

  /// Why readings that come are not to be trusted.
  enum class Fault : std::uint8_t { None, BadLine, ClockJumped, Slow, Frozen, Stuck };

  void take_line(double now, ByteView line);
  void note_damage(bool damaged);
  void note_interval(double seconds);
  double volts(std::size_t sensor) const;
  Fault fault(double now) const;
  std::string words(Fault fault, double now) const;
  std::string why_silent(double now) const;

  PsdSetup setup_;
  Reader reader_{};
  StuckWatch stuck_{};
  ClockWatch clock_{};
  bool open_ = false;
  bool running_ = false;
  bool storm_ = false;         // too many lines are damaged, until far fewer are
  double damaged_ = 0;         // recent share of damaged lines, 0 to 1
  double interval_ = kPeriod;  // [s] recent mean from one line to the next
  std::uint64_t stray_ = 0;    // bytes outside of lines since the last line
  unsigned port_baud_ = 0;     // [bit/s]; 0: unknown
  double last_ = 0;            // [s] of the newest line; 0: none yet
  double heard_ = 0;           // [s] of the newest byte; 0: none yet
  double wake_ = std::numeric_limits<double>::infinity();
  std::string trouble_ = "The port has not been opened yet.";
  Reading newest_{};
  algo::FloorRanges ranges_{};
  bool fresh_ = false;
  std::uint64_t readings_ = 0;
};

}  // namespace drivers::psd
