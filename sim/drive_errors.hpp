// sim/drive_errors.hpp: errors between a command and the base's motion, and between the motion and
// the odometry.
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

/// The defect of the configuration as part of a sentence, or nothing.
std::optional<std::string> defect(const DriveConfig& config);

/// Delay and slip of commands, and drift of the odometry. Without errors both pass unchanged, bit
/// for bit.
class DriveErrors {
 public:
  DriveErrors(const DriveConfig& config, std::uint64_t seed);

  /// At rest at `start_W`, without pending commands.
  void reset(const algo::Pose2& start_W);
  /// Takes the `command` given in this tick and returns the twist that acts in it.
  algo::Twist2 act(const algo::Twist2& command);
  /// Adds the drift to the odometry `sound`, which has no errors.
  algo::Odometry report(const algo::Odometry& sound);

 private:
  DriveConfig config_{};
  double distance_scale_ = 1;  // of this run
  double angle_scale_ = 1;
  Random noise_;
  std::vector<algo::Twist2> under_way_{};  // a ring: commands that do not act yet
  std::size_t next_ = 0;
  algo::Pose2 sound_W_{};     // the last sound pose
  algo::Pose2 reported_W_{};  // and the pose reported for it
};

/// `path_W` as the odometry of a base with these errors would report it, from the same first pose
/// on. Delay, limits and command errors have no effect here.
std::vector<algo::Pose2> reported_path(std::span<const algo::Pose2> path_W,
                                       const DriveConfig& config,
                                       std::uint64_t seed);

}  // namespace sim
