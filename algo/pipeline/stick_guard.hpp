// algo/pipeline/stick_guard.hpp: how much of a driver's stick is let through.
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

/// Lets a driver have the motion nearest to the stick after which the robot can still come to rest
/// kMargin from all that it knows: surfaces in the scans of late, fixed to W by the odometry, and
/// the newest sonar and infrared returns from where no scanner looks. The true hull counts, along
/// the arc it will go on while the command acts and while it brakes, and commands that do not act
/// yet count too. No part of the hull that looks back moves into what nobody has seen, unless the
/// driver insists: straight back for kInsist. Where no sensor looks back at the time, it backs at
/// kBlindSpeed at most.
class StickGuard {
 public:
  static constexpr double kMargin = 0.05;     // [m] three times what the scanner may be off
  static constexpr double kBlindSpeed = 0.1;  // [m/s]
  static constexpr double kInsist = 2.0;      // [s]

  StickGuard();
  void reset(const Pose2& start_W);
  /// Takes what was sensed; every tick. While nobody holds the stick it looks now and then only.
  void sense(const Resource& in);
  /// What is let through of `wanted`; at rest when nothing can be.
  Twist2 limit(const Resource& in, const Twist2& wanted);

 private:
  /// How a base may answer: within its limits, or faster than they say.
  enum class Answer : std::uint8_t { Ramped, AtOnce };
  void look(const Resource& in, const LaserScan& scan);
  void watch_insistence(const Resource& in);
  double room(const Pose2& pose_W) const;
  bool safe(const Resource& in, const Twist2& command) const;
  bool safe(const Resource& in, const Twist2& command, Answer answer) const;

  HullCheck hull_{};
  LocalMap map_{LocalMap::Distances::None};  // it only asks who is very near
  const Tracker nothing_moves_{};            // this map holds moving obstacles like all others
  ScanPoints points_{};
  RearWatch rear_{};
  bool placed_ = false;                          // the place of the start is entered into the map
  double next_look_ = 0;                         // [s] run clock, while nobody holds the stick
  std::optional<double> straight_back_since_{};  // [s] run clock
  bool insists_ = false;
  bool may_back_ = false;         // into what no scanner has seen, in this tick
  MotionLimits limits_{};         // of this tick's robot
  std::vector<Vec2> beside_W_{};  // returns from where no scanner looks, of this tick
};

}  // namespace algo
