// sim/replay.hpp: replays a recorded CARMEN log behind the robot port.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "algo/robot.hpp"
#include "sim/carmen_log.hpp"

namespace sim {

/// Replays a log one scan per tick, timed by its stamps. If stamps are missing, repeated or
/// decreasing, a scan takes 0.2 s. The run clock starts at 0 with the first scan.
///
/// Reads the whole log when opened and keeps it as packed beams. Ignores commands. Use from one
/// thread only.
class Replay final : public algo::Robot {
 public:
  /// [s] A tick without a usable stamp in the log.
  static constexpr double kFallbackPeriod = 0.2;

  /// Throws std::runtime_error with a sentence if there is no such file or no scan in it.
  explicit Replay(const std::filesystem::path& file);
  /// The same from a stream; `name` names the file in messages.
  Replay(std::istream& log, const std::string& name);

  const algo::RobotSpec& spec() const override { return spec_; }
  void reset(algo::Observation& observation) override;
  /// False after the last scan.
  bool step(const algo::Command& command, algo::Observation& observation) override;
  /// [s] to the next scan; 0 after the last.
  double next_period() const override;
  void stop() noexcept override {}

  std::size_t size() const { return scans_.size(); }
  /// [s] Of the current scan, on the recording's clock; 0 if the log has none.
  double recorded_stamp() const { return scans_[current_].recorded; }
  CarmenUnit unit() const { return unit_; }
  /// The lines that were left out: "3 unreadable (line 1: REASON)"; empty if there are none.
  std::string damage() const;

 private:
  struct Scan {
    CarmenLaser laser = CarmenLaser::Front;
    double stamp = 0;     // [s] run clock
    double recorded = 0;  // [s] the recording's clock
    algo::Pose2 pose_W{};
    algo::Pose2 mount_R{};                      // constant for a laser: that of its first scan
    double angle_min = 0, angle_increment = 0;  // [rad]
    std::size_t first = 0, beams = 0;           // in wire_
  };

  void read(std::istream& log);
  void keep(const CarmenScan& scan, std::vector<std::uint32_t>& readings_mm);
  void time_scans();
  void describe();
  void deliver(algo::Observation& observation) const;

  std::string name_{};
  algo::RobotSpec spec_{};
  std::vector<Scan> scans_{};
  std::vector<std::uint16_t> wire_{};
  CarmenUnit unit_ = CarmenUnit::Centimetre;
  std::size_t unreadable_ = 0;  // lines
  std::string first_unreadable_{};
  std::size_t lines_ = 0;
  std::size_t current_ = 0;
};

}  // namespace sim
