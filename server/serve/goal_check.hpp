// server/serve/goal_check.hpp: checks a goal before the robot sets off.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "algo/drawn_space.hpp"
#include "algo/obstacle.hpp"
#include "algo/request.hpp"
#include "algo/robot.hpp"
#include "algo/telemetry.hpp"

namespace server {

/// Checks if a robot of `spec` at `pose_W` can stand at `goal` among `obstacles`, and get there.
/// Returns a sentence that says why not, or nothing if it can. `obstacles` are the static ones.
/// Judges a disc as wide as the robot's narrower side on a grid. A goal reported as shut off really
/// is; one behind a gap just as wide as the robot may go unreported.
std::optional<std::string> goal_trouble(const algo::RobotSpec& spec,
                                        const algo::SetGoal& goal,
                                        const algo::Pose2& pose_W,
                                        std::span<const algo::Obstacle> obstacles);

/// The same check by the points of a scan: it reports a return on the goal, or one in front of it
/// that hides it. `seen` is the newest scan with its mount, taken at `pose_W`.
std::optional<std::string> goal_trouble(const algo::RobotSpec& spec,
                                        const algo::SetGoal& goal,
                                        const algo::Pose2& pose_W,
                                        const algo::LaserScan& seen);

/// A sentence if the map shows nothing where a robot looks for itself about `pose_M`.
std::optional<std::string> pose_trouble(const algo::DrawnSpace& map, const algo::Pose2& pose_M);

}  // namespace server
