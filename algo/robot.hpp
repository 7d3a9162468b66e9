// algo/robot.hpp: the one port to a robot: a simulated world, a recorded log, or hardware.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "algo/arm_spec.hpp"
#include "algo/ground_sense.hpp"
#include "algo/health.hpp"
#include "algo/observation.hpp"
#include "algo/recycled.hpp"
#include "algo/request.hpp"
#include "algo/types.hpp"

namespace algo {

/// The robot's state and command in one of its last periods.
struct Moment {
  double stamp = 0;  // [s] run clock
  Halt halt = Halt::None;
  Pose2 pose_W{};  // by odometry
  Twist2 twist{};  // by odometry
  Command command{};
};

/// The link to the robot is lost. what() is a sentence for a person. `last` holds its last moments,
/// oldest first, as far as the robot keeps them.
class RobotError : public std::runtime_error {
 public:
  explicit RobotError(const std::string& sentence, std::vector<Moment> moments = {})
      : std::runtime_error(sentence), last(std::move(moments)) {}
  std::vector<Moment> last;
};

struct RobotSpec {
  std::string name{};
  double radius = 0;                    // [m] of the hull's circle about R
  double half_length = 0;               // [m] of a rectangular hull along R's x; 0: a disc
  double half_width = 0;                // [m] of a rectangular hull along R's y
  double half_track = 0;                // [m] centre to wheel
  double period = 0;                    // [s] of one tick
  double max_v = 0;                     // [m/s]
  double max_omega = 0;                 // [rad/s]
  double max_acceleration = 0;          // [m/s2]
  double max_angular_acceleration = 0;  // [rad/s2]
  double max_jerk = 0;                  // [m/s3] of its commands, as the payload bears; 0: no limit
  double max_angular_jerk = 0;          // [rad/s3]
  double command_delay = 0;             // [s] from a command's tick until it acts
  bool has_laser = true;   // has a scanner that looks ahead; if not, the sonar ring replaces it
  bool has_ring = false;   // has the sonars that the laws for driving by hand read
  bool drives = false;     // commands move it; a recorded log does not
  bool raw_stick = false;  // its stick may be obeyed without a guard
  std::vector<ChannelInfo> channels{};  // of further sensors
  double axle = 0;                      // [m] x of the drive axle in R
  bool inclinometer = false;            // has one, and is held without its readings
  std::optional<Stance> stance{};       // if the robot may turn over: as if `inclinometer` were set
  std::optional<LineCamera> line{};
  std::optional<FloorSensors> floor{};
  std::optional<ClimbLimits> climbs{};  // if they were measured
  bool uneven = false;                  // it is known to drive where there are ramps or trenches
  std::optional<ArmSpec> arm{};         // if it has one
};

/// The robot's height and inclination on ground that is not level. R in W is turned by the heading
/// about z, then by the pitch about its y axis, then by the roll about its x axis.
struct Tilt {
  double z = 0;      // [m] of R above the level z = 0
  double roll = 0;   // [rad] left side up positive
  double pitch = 0;  // [rad] nose down positive
  bool operator==(const Tilt&) const = default;
};

/// The simulator's truth, for display and metrics only; controllers never see it.
struct GroundTruth {
  Pose2 pose{};
  double obstacle_distance = 0;  // [m] from the robot's centre to the nearest surface
  double clearance = 0;          // [m] from the hull's outline to it, negative inside
  bool collided = false;
  std::optional<Tilt> tilt{};         // if the ground is not level
  bool overturned = false;            // it lies on its side or its back
  bool fallen = false;                // it came down an edge higher than it can climb
  std::optional<BodyLink> touched{};  // the part of a robot with an arm that is in contact
  bool operator==(const GroundTruth&) const = default;
};

/// Pose of an obstacle that moves by itself; true, for display only.
struct Moved {
  std::uint32_t id = 0;
  Pose2 pose_W{};
  bool operator==(const Moved&) const = default;
};

/// Motors that must be switched on, and the devices behind them. Callable from any thread.
class Arming {
 public:
  virtual ~Arming() = default;
  /// Switches the motors on; if it cannot, returns the reason as a sentence.
  virtual std::optional<std::string> arm() = 0;
  /// Brakes as hard as the robot can and switches the motors off once the wheels stand. Nothing
  /// moves the robot until it is armed again. `why` is a sentence for people.
  virtual void disarm(const std::string& why) = 0;
  /// Identifies the current arming: a new number each time the motors are switched on, 0 while they
  /// are off.
  virtual std::uint32_t epoch() const = 0;
  virtual HealthReport health() const = 0;
};

/// Readings of sensors that no driver of ours reads: a process beside the robot publishes them.
/// Callable from any thread.
class Publishing {
 public:
  virtual ~Publishing() = default;
  /// Takes a reading of `age` [s], counted from its measurement to this call. Returns the reason
  /// for a refusal as a sentence, also if a newer reading has come already.
  virtual std::optional<std::string> publish_tilt(double roll, double pitch, double age) = 0;
  virtual std::optional<std::string> publish_line(std::span<const LinePixel> pixels,
                                                  double age) = 0;
};

/// Adds, moves and removes obstacles. Call from the robot's thread only.
class Editing {
 public:
  virtual ~Editing() = default;
  /// Carries out AddObstacle, MoveObstacle or RemoveObstacle and ignores other requests. Returns
  /// the reason for a refusal as a sentence.
  virtual std::optional<std::string> edit(const Request& request) = 0;
};

/// A robot that knows a map and looks for its place on it. Call from the robot's thread only.
class Locating {
 public:
  virtual ~Locating() = default;
  /// Looks for the robot's place about the pose of `at`, or everywhere.
  virtual void place(const SetInitialPose& at) = 0;
};

class Robot {
 public:
  virtual ~Robot() = default;
  virtual const RobotSpec& spec() const = 0;

  /// Arms the robot and reports the first observation, with the robot at rest.
  virtual void reset(Observation& observation) = 0;

  /// Writes `command`, advances one period and reads the newest data into `observation`. Simulated
  /// and recorded time advances at once. A robot of real devices waits for its next deadline, which
  /// is absolute, so that no period is lost. Returns false at the end of recorded data and leaves
  /// the observation unchanged. Throws RobotError when the link is lost.
  virtual bool step(const Command& command, Observation& observation) = 0;
  /// [s] Run-clock time that the next step() advances.
  virtual double next_period() const { return spec().period; }

  /// Commands zero velocity now; allowed in every state.
  virtual void stop() noexcept = 0;

  // Optional capabilities; null if the robot lacks them.

  /// A robot with Arming consists of real devices and keeps its own time.
  virtual Arming* arming() { return nullptr; }
  virtual Editing* editing() { return nullptr; }
  virtual std::optional<GroundTruth> ground_truth() const { return std::nullopt; }
  /// Lists the obstacles that move by themselves and are there. Overwrites `moved` but keeps its
  /// buffers.
  virtual void find_moved(Recycled<Moved>& moved) const { moved.clear(); }
  /// Null if the robot knows no map.
  virtual Locating* locating() { return nullptr; }
  /// Null if no sensor of the robot is published.
  virtual Publishing* publishing() { return nullptr; }
};

}  // namespace algo
