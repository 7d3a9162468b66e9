// sim/drive_errors.hpp: what lies between a command and the base, and between the base and what
// its odometry reports.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algo/observation.hpp"
#include "sim/random.hpp"
#include "sim/scenario.hpp"

namespace sim {

/// What is wrong with the configuration as a sentence part, or nothing.
std::optional<std::string> defect(const DriveConfig& config);

/// Delay and slip of commands, drift of the odometry. Without errors both pass unchanged, bit for
/// bit.
class DriveErrors {
 public:
  DriveErrors(const DriveConfig& config, std::uint64_t seed);

  /// At rest at `start_W`; nothing is on its way.
  void reset(const algo::Pose2& start_W);
  /// What acts in this tick when `command` is given in it.
  algo::Twist2 act(const algo::Twist2& command);
  /// `sound` odometry as the drifting one reports it.
  algo::Odometry report(const algo::Odometry& sound);

 private:
  DriveConfig config_{};
  double distance_scale_ = 1;  // of this run
  double angle_scale_ = 1;
  Random noise_;
  std::vector<algo::Twist2> under_way_{};  // a ring: commands that do not act yet
  std::size_t next_ = 0;
  algo::Pose2 sound_W_{};     // the last pose it was given
  algo::Pose2 reported_W_{};  // and what was made of it
};

/// `path_W` as the odometry of a base with these errors would have reported it, from the same first
/// pose on. Delay, limits and what the base makes of commands say nothing here.
std::vector<algo::Pose2> reported_path(std::span<const algo::Pose2> path_W,
                                       const DriveConfig& config,
                                       std::uint64_t seed);

}  // namespace sim
