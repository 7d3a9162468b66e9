// server/experiment/oracle.hpp: whether a contact with a moving obstacle could have been avoided.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/robot.hpp"
#include "sim/scenario.hpp"

namespace server::experiment {

/// The true state of the robot at one tick.
struct Moment {
  double stamp = 0;  // [s] run clock
  algo::Pose2 pose_W{};
  algo::Twist2 twist{};
};

enum class Contact : std::uint8_t {
  None,         // nothing was touched
  Avoidable,    // a motion begun in time would have stayed clear
  Unavoidable,  // no motion tried would have stayed clear
  Jumped,       // the obstacle appeared suddenly: its path began again
};

/// Judges with hindsight. The contact is the last moment of `trail`. Rolls out standing still,
/// driving back and 20 arcs from 3 s before the contact to 1 s after it, among obstacles that move
/// as they truly did. The motions obey the vehicle's acceleration limits and begin at once, without
/// the command's delay.
Contact judge_contact(const sim::Scenario& scenario,
                      const algo::RobotSpec& spec,
                      const std::vector<Moment>& trail);

}  // namespace server::experiment
