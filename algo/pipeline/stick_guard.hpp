// algo/pipeline/stick_guard.hpp: limits a driver's stick to safe motions.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "algo/full_strip/local_map.hpp"
#include "algo/full_strip/motion.hpp"
#include "algo/full_strip/scan_points.hpp"
#include "algo/pipeline/rear_watch.hpp"
#include "algo/types.hpp"

namespace algo {

struct Resource;

/// Allows the motion nearest to the stick from which the robot can still stop kMargin short of all
/// known obstacles: surfaces in recent scans, fixed to W by the odometry, and the newest sonar and
/// infrared returns where no scanner looks. It checks the true hull along the arc while the command
/// acts and while the robot brakes, and includes commands that do not act yet. The rear half of the
/// hull never moves into unseen space, unless the driver insists: straight back for kInsist. Where
/// no sensor looks back at that time, it backs at kBlindSpeed at most.
class StickGuard {
 public:
  static constexpr double kMargin = 0.05;     // [m] three times the scanner's error
  static constexpr double kBlindSpeed = 0.1;  // [m/s]
  static constexpr double kInsist = 2.0;      // [s]

  StickGuard();
  void reset(const Pose2& start_W);
  /// Takes the sensor data of every tick. Maps less often while nobody holds the stick.
  void sense(const Resource& in);
  /// The allowed part of `wanted`; zero if no motion is allowed. `delay` [s]: the command may act
  /// for so much longer, because the driver's answer comes late.
  Twist2 limit(const Resource& in, const Twist2& wanted, double delay = 0);

 private:
  /// The base's assumed answer: within its limits, or faster than they say.
  enum class Answer : std::uint8_t { Ramped, AtOnce };
  void look(const Resource& in, const LaserScan& scan);
  void watch_insistence(const Resource& in);
  double room(const Pose2& pose_W) const;
  bool safe(const Resource& in, const Twist2& command) const;
  bool safe(const Resource& in, const Twist2& command, Answer answer) const;

  HullCheck hull_{};
  LocalMap map_{LocalMap::Distances::None};  // it needs near obstacles only
  const Tracker nothing_moves_{};            // this map holds moving obstacles too
  ScanPoints points_{};
  RearWatch rear_{};
  bool placed_ = false;                          // the start pose is entered into the map
  double next_look_ = 0;                         // [s] run clock, while nobody holds the stick
  double next_look_beside_ = 0;                  // the same for the other scanners
  std::optional<double> mapped_{};               // stamp of the newest scan ahead in the map
  std::optional<double> straight_back_since_{};  // [s] run clock
  bool insists_ = false;
  bool may_back_ = false;         // into unseen space, in this tick
  double delay_ = 0;              // [s] of this tick's driver
  MotionLimits limits_{};         // of this tick's robot
  std::vector<Vec2> beside_W_{};  // this tick's returns from where no scanner looks
};

}  // namespace algo
