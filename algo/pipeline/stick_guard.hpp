// algo/pipeline/stick_guard.hpp: limits a driver's stick to safe motions.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "algo/full_strip/local_map.hpp"
#include "algo/full_strip/motion.hpp"
#include "algo/full_strip/scan_points.hpp"
#include "algo/pipeline/mover_watch.hpp"
#include "algo/pipeline/rear_watch.hpp"
#include "algo/pipeline/shove_watch.hpp"
#include "algo/types.hpp"

namespace algo {

struct Resource;

/// Allows the motion nearest to the stick from which the robot can still stop kMargin short of all
/// known obstacles: surfaces in recent scans, fixed to W by the odometry, and the newest sonar and
/// infrared returns where no scanner looks. It checks the true hull along the arc while the command
/// acts and while the robot brakes, and includes commands that do not act yet. What was seen moving
/// is predicted along that arc: the robot moves no closer to it than kMargin, but may stand, turn
/// or drive away while it comes. The rear half of the hull never moves into unseen space. Where no
/// sensor looks back at that time, it backs at kBlindSpeed at most. After a shove, it forgets all
/// that lies elsewhere now.
class StickGuard {
 public:
  static constexpr double kMargin = 0.05;     // [m] three times the scanner's error
  static constexpr double kBlindSpeed = 0.1;  // [m/s]

  StickGuard();
  void reset(const Pose2& start_W);
  /// Takes the sensor data of every tick. Maps less often while nobody holds the stick.
  void sense(const Resource& in);
  /// The admissible twist nearest to `wanted`, which passes unchanged if it is admissible: see
  /// nearest_twist(). Zero if no motion is. Call after sense(), while somebody holds the stick.
  /// `delay` [s]: the command may act for so much longer, because the driver's answer comes late.
  Twist2 limit(const Resource& in, const Twist2& wanted, double delay = 0);
  /// True if the robot may move by `command` in this tick. As limit(), after sense().
  bool admits(const Resource& in, const Twist2& command) const;

 private:
  /// The base's assumed answer: within its limits, or faster than they say.
  enum class Answer : std::uint8_t { Ramped, AtOnce };
  void look(const Resource& in, const LaserScan& scan, MoverWatch* movers, ShoveWatch* shove);
  void look_around(const Resource& in);
  void forget_surroundings(const Pose2& here_W);
  void prepare(const Resource& in);
  double room(const Pose2& pose_W) const;
  bool approaches(const Pose2& from_W, const Pose2& to_W, double after, double step) const;
  bool safe(const Resource& in, const Twist2& command, Answer answer) const;

  HullCheck hull_{};
  LocalMap map_{LocalMap::Distances::None};  // it needs near obstacles only
  const Tracker nothing_moves_{};            // this map holds the hits on moving obstacles too
  MoverWatch ahead_{};                       // of the scanner ahead,
  MoverWatch beside_{};                      // and of the first other one
  ShoveWatch shove_{};                       // in the scans of the scanner ahead
  ScanPoints points_{};
  RearWatch rear_{};
  bool placed_ = false;             // the start pose is entered into the map
  double next_look_ = 0;            // [s] run clock, while nobody holds the stick
  double next_look_beside_ = 0;     // the same for the other scanners
  std::optional<double> mapped_{};  // stamp of the newest scan ahead in the map

  // Of this tick, while somebody holds the stick.
  bool may_back_ = false;  // into unseen space
  double delay_ = 0;       // [s] of the driver's answer
  MotionLimits limits_{};
  std::vector<Vec2> beside_W_{};  // returns from where no scanner looks
  std::vector<Track> movers_{};   // at the tick's time
};

}  // namespace algo
