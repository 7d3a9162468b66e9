// algo/robot.hpp: the one port to a robot: a simulated world, a recorded log, or hardware.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "algo/observation.hpp"
#include "algo/recycled.hpp"
#include "algo/request.hpp"
#include "algo/types.hpp"

namespace algo {

/// The link to the robot is lost, or its data ended. what() is a sentence for a person.
class RobotError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The recorded data has come to its end: not a fault.
class EndOfLog : public RobotError {
 public:
  using RobotError::RobotError;
};

struct RobotSpec {
  std::string name{};
  double radius = 0;                    // [m] of the hull's circle about R
  double half_length = 0;               // [m] of a rectangular hull along R's x; 0: the disc is it
  double half_width = 0;                // [m] of a rectangular hull along R's y
  double half_track = 0;                // [m] centre to wheel
  double period = 0;                    // [s] of one tick
  double max_v = 0;                     // [m/s]
  double max_omega = 0;                 // [rad/s]
  double max_acceleration = 0;          // [m/s2]
  double max_angular_acceleration = 0;  // [rad/s2]
  double command_delay = 0;             // [s] from a command's tick until it acts
  bool has_laser = true;                // looking ahead; without one the sonar ring stands in
  bool editable = false;                // obstacles can be added, moved, removed
  bool paceable = false;                // has pause, single step and speed
  bool drives = false;                  // commands move it; a recorded log does not
};

/// The simulator's truth, for display and metrics only; controllers never see it.
struct GroundTruth {
  Pose2 pose{};
  double obstacle_distance = 0;  // [m] from the robot's centre to the nearest surface
  double clearance = 0;          // [m] from the hull's outline to it, negative inside
  bool collided = false;
  bool operator==(const GroundTruth&) const = default;
};

/// Where an obstacle stands that moves by itself; for display, as the truth.
struct Moved {
  std::uint32_t id = 0;
  Pose2 pose_W{};
  bool operator==(const Moved&) const = default;
};

/// How fast time runs; only a robot whose spec says `paceable` heeds it.
struct Pace {
  bool paused = false;
  double speed = 1;                // times real time; 0 = as fast as it goes
  std::uint32_t single_steps = 0;  // periods to run while paused
};

class Robot {
 public:
  virtual ~Robot() = default;
  virtual const RobotSpec& spec() const = 0;

  /// Arms the robot and reports the first observation, robot at rest.
  virtual void reset(Observation& observation) = 0;

  /// Writes `command`, waits for the robot's own next deadline (absolute, so that no period is
  /// lost), then reads the newest data into `observation`. Returns false, with the observation
  /// untouched and no period gone by, when paused: the caller serves its requests and calls again.
  /// Throws RobotError when the link is lost.
  virtual bool step(const Command& command, Observation& observation) = 0;

  /// Zero velocity now; allowed in every state.
  virtual void stop() noexcept = 0;

  /// Carries out an obstacle edit; other requests are none of its business. Returns why it was
  /// refused, as a sentence.
  virtual std::optional<std::string> edit(const Request& request) = 0;

  virtual std::optional<GroundTruth> ground_truth() const { return std::nullopt; }
  /// Overwrites `moved`, whose buffers stay.
  virtual void find_moved(Recycled<Moved>& moved) const { moved.clear(); }

  /// May be called from any thread.
  virtual void set_pace(const Pace& /*pace*/) {}
  /// Periods whose time went by unused because step() came too late for them.
  virtual std::uint64_t missed_periods() const { return 0; }
};

}  // namespace algo
