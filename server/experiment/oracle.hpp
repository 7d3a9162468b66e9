// server/experiment/oracle.hpp: whether a contact with something that moves could have been
// avoided.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/robot.hpp"
#include "sim/scenario.hpp"

namespace server::experiment {

/// The robot at one tick, as it truly was.
struct Moment {
  double stamp = 0;  // [s] run clock
  algo::Pose2 pose_W{};
  algo::Twist2 twist{};
};

enum class Contact : std::uint8_t {
  None,         // nothing was touched
  Avoidable,    // some motion begun in time would have stayed clear
  Unavoidable,  // none of those tried would
  Jumped,       // the obstacle came out of nowhere: its path began anew
};

/// With hindsight: from 3 s before the contact, the last moment of `trail`, rolls out standing
/// still, driving back and 20 arcs, among obstacles that move as they truly did, until a second
/// after it. The motions obey the vehicle's accelerations and begin at once, without the command's
/// delay.
Contact judge_contact(const sim::Scenario& scenario,
                      const algo::RobotSpec& spec,
                      const std::vector<Moment>& trail);

}  // namespace server::experiment
