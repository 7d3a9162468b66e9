// server/serve/scene_json.hpp: a tick as the published foxglove.* JSON messages, for any viewer.
//
// Made from the same Telemetry. Called on the io thread, only while a client subscribes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "algo/obstacle.hpp"
#include "algo/telemetry.hpp"

namespace server {

/// [m] Range of a beam without a reading: beyond the range of every scanner, since JSON has no
/// infinity.
constexpr double kNoReading = 100.0;

std::string laser_scan_json(const algo::Telemetry& t);
std::string transforms_json(const algo::Telemetry& t);
std::string odometry_json(const algo::Telemetry& t);
/// Replaces all obstacles of a viewer.
std::string obstacles_json(double stamp, std::span<const algo::Obstacle> obstacles);
/// The goal's pose; the robot's own while it has no goal (the message cannot say "none").
std::string goal_json(const algo::Telemetry& t);
/// {"sec","nsec"} of the run clock.
std::string time_text(double stamp);
enum class LogLevel { Info = 2, Warning = 3, Error = 4 };
std::string log_json(double stamp, LogLevel level, const std::string& message);

}  // namespace server
