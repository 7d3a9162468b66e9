// algo/robot.hpp: the one port to a robot: a simulated world, a recorded log, or hardware.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "algo/health.hpp"
#include "algo/observation.hpp"
#include "algo/recycled.hpp"
#include "algo/request.hpp"
#include "algo/types.hpp"

namespace algo {

/// What a robot sensed and was told in one of its last periods.
struct Moment {
  double stamp = 0;  // [s] run clock
  Halt halt = Halt::None;
  Pose2 pose_W{};  // by odometry
  Twist2 twist{};  // by odometry
  Command command{};
};

/// The link to the robot is lost. what() is a sentence for a person; `last` are its last moments,
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
  bool drives = false;                  // commands move it; a recorded log does not
  std::vector<ChannelInfo> channels{};  // of its further sensors
};

/// How a robot stands on ground that is not level.
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
  std::optional<Tilt> tilt{};  // where the ground is not level
  bool operator==(const GroundTruth&) const = default;
};

/// Where an obstacle stands that moves by itself; for display, as the truth.
struct Moved {
  std::uint32_t id = 0;
  Pose2 pose_W{};
  bool operator==(const Moved&) const = default;
};

/// Motors that have to be switched on, and the devices behind them. All calls from any thread.
class Arming {
 public:
  virtual ~Arming() = default;
  /// Switches the motors on, or says why not, as a sentence.
  virtual std::optional<std::string> arm() = 0;
  /// From now on nothing moves the robot until it is armed again: it brakes as hard as it can, and
  /// its motors go off once the wheels stand. `why` is the sentence for people.
  virtual void disarm(const std::string& why) = 0;
  /// Which arming this is: another number each time the motors were switched on, 0 while they are
  /// off.
  virtual std::uint32_t epoch() const = 0;
  virtual HealthReport health() const = 0;
};

/// Obstacles that can be added, moved and removed. Belongs to the thread of the robot.
class Editing {
 public:
  virtual ~Editing() = default;
  /// Carries out AddObstacle, MoveObstacle or RemoveObstacle; leaves other requests alone. Returns
  /// why it was refused, as a sentence.
  virtual std::optional<std::string> edit(const Request& request) = 0;
};

class Robot {
 public:
  virtual ~Robot() = default;
  virtual const RobotSpec& spec() const = 0;

  /// Arms the robot and reports the first observation, robot at rest.
  virtual void reset(Observation& observation) = 0;

  /// Writes `command`, advances one period and reads the newest data into `observation`. Simulated
  /// and recorded time advances at once; a robot of real devices waits for its own next deadline
  /// (absolute, so that no period is lost). Returns false, with the observation untouched, when
  /// recorded data has come to its end. Throws RobotError when the link is lost.
  virtual bool step(const Command& command, Observation& observation) = 0;
  /// [s] of the run clock that the next step() takes.
  virtual double next_period() const { return spec().period; }

  /// Zero velocity now; allowed in every state.
  virtual void stop() noexcept = 0;

  // What some robots can do besides; null from those that cannot.

  /// A robot that is armed is made of real devices and keeps its own time.
  virtual Arming* arming() { return nullptr; }
  virtual Editing* editing() { return nullptr; }
  virtual std::optional<GroundTruth> ground_truth() const { return std::nullopt; }
  /// Overwrites `moved`, whose buffers stay.
  virtual void find_moved(Recycled<Moved>& moved) const { moved.clear(); }
};

}  // namespace algo
