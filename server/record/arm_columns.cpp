// server/record/arm_columns.cpp: the table of the arm's columns.
#include "server/record/arm_columns.hpp"

#include <array>
#include <cmath>

#include "server/record/csv_cells.hpp"

namespace server {
namespace {

using T = algo::Telemetry;
using Out = std::string;

template <std::size_t Joint>
void put_position(Out& out, const T& t) {
  if (t.observation.joints) put_number(out, t.observation.joints->position[Joint]);
}
template <std::size_t Joint>
void put_rate(Out& out, const T& t) {
  if (t.observation.joints) put_number(out, t.observation.joints->rate[Joint]);
}
template <std::size_t Joint>
void put_joint_goal(Out& out, const T& t) {
  if (t.arm.joint_goal) put_number(out, t.arm.joint_goal->position[Joint]);
}
template <algo::BodyLink Link>
void put_clearance(Out& out, const T& t) {
  if (t.arm.present) put_float(out, t.arm.clearance[static_cast<std::size_t>(Link)]);
}
template <int Axis>
void put_hand(Out& out, const T& t) {
  if (t.arm.hand_goal) put_number(out, t.arm.hand_goal->position_W[Axis]);
}
template <auto Part>
void put_attitude(Out& out, const T& t) {
  if (t.arm.hand_goal) put_number(out, t.arm.hand_goal->attitude_W.*Part);
}

using algo::BodyLink;
using algo::Quaternion;
constexpr auto kArmColumns = std::to_array<FrameColumn>({
    {"joint[0]", "rad", put_position<0>},
    {"joint[1]", "rad", put_position<1>},
    {"joint[2]", "rad", put_position<2>},
    {"joint[3]", "rad", put_position<3>},
    {"joint[4]", "rad", put_position<4>},
    {"joint[5]", "rad", put_position<5>},
    {"joint[6]", "rad", put_position<6>},
    {"joint_moves[0]", "rad/s", put_rate<0>},
    {"joint_moves[1]", "rad/s", put_rate<1>},
    {"joint_moves[2]", "rad/s", put_rate<2>},
    {"joint_moves[3]", "rad/s", put_rate<3>},
    {"joint_moves[4]", "rad/s", put_rate<4>},
    {"joint_moves[5]", "rad/s", put_rate<5>},
    {"joint_moves[6]", "rad/s", put_rate<6>},
    {"joint_goal[0]", "rad", put_joint_goal<0>},
    {"joint_goal[1]", "rad", put_joint_goal<1>},
    {"joint_goal[2]", "rad", put_joint_goal<2>},
    {"joint_goal[3]", "rad", put_joint_goal<3>},
    {"joint_goal[4]", "rad", put_joint_goal<4>},
    {"joint_goal[5]", "rad", put_joint_goal<5>},
    {"joint_goal[6]", "rad", put_joint_goal<6>},
    {"arm.state",
     "",
     [](Out& o, const T& t) {
       if (t.arm.present) put_text(o, algo::name(t.arm.state));
     }},
    {"hand_goal.x", "m", put_hand<0>},
    {"hand_goal.y", "m", put_hand<1>},
    {"hand_goal.z", "m", put_hand<2>},
    {"hand_goal.qw", "", put_attitude<&Quaternion::w>},
    {"hand_goal.qx", "", put_attitude<&Quaternion::x>},
    {"hand_goal.qy", "", put_attitude<&Quaternion::y>},
    {"hand_goal.qz", "", put_attitude<&Quaternion::z>},
    {"clearance.base", "m", put_clearance<BodyLink::Base>},
    {"clearance.mast", "m", put_clearance<BodyLink::Mast>},
    {"clearance.upper_arm", "m", put_clearance<BodyLink::UpperArm>},
    {"clearance.forearm", "m", put_clearance<BodyLink::Forearm>},
    {"clearance.hand", "m", put_clearance<BodyLink::Hand>},
    {"clearance.own",
     "m",
     [](Out& o, const T& t) {
       if (t.arm.present) put_float(o, t.arm.own_clearance);
     }},
    {"plan",
     "",
     [](Out& o, const T& t) {
       if (t.arm.present) o += std::to_string(t.arm.plan);
     }},
    {"truth.touched",
     "",
     [](Out& o, const T& t) {
       if (t.ground_truth && t.ground_truth->touched) put_text(o, name(*t.ground_truth->touched));
     }},
});

}  // namespace

std::span<const FrameColumn> arm_columns() {
  return kArmColumns;
}

}  // namespace server
