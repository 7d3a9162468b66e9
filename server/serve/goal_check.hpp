// server/serve/goal_check.hpp: what is known to be wrong with a goal before the robot sets off.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "algo/obstacle.hpp"
#include "algo/request.hpp"
#include "algo/robot.hpp"
#include "algo/telemetry.hpp"

namespace server {

/// Whether a robot of `spec` at `pose_W` can stand at `goal` among `obstacles`, and get there: a
/// sentence that says why not, nothing when it can. `obstacles` are those that stay where they are.
/// Judged for a disc as wide as the robot's narrower side, on a grid: a
/// goal said to be shut off is; of one behind a gap as wide as the robot nothing may be said.
std::optional<std::string> goal_trouble(const algo::RobotSpec& spec,
                                        const algo::SetGoal& goal,
                                        const algo::Pose2& pose_W,
                                        std::span<const algo::Obstacle> obstacles);

/// The same as far as the points of a scan tell: whether something was seen on the goal, or stands
/// before it so that nothing is known of it. `seen` is the newest scan with its mount, taken at
/// `pose_W`.
std::optional<std::string> goal_trouble(const algo::RobotSpec& spec,
                                        const algo::SetGoal& goal,
                                        const algo::Pose2& pose_W,
                                        const algo::LaserScan& seen);

}  // namespace server
