// server/lab/soak/hand_drive.cpp: the loop of world and pipeline.
#include "server/lab/soak/hand_drive.hpp"

namespace server::soak {
namespace {

algo::RobotSpec with_stance(algo::RobotSpec spec, const std::optional<algo::Stance>& stance) {
  spec.stance = stance;
  return spec;
}

}  // namespace

HandDrive::HandDrive(const sim::Scenario& scenario, std::uint64_t seed)
    : world_(scenario, seed),
      pipeline_({.controller = scenario.controller, .parameters = scenario.parameters},
                world_.spec()) {
  begin();
}

HandDrive::HandDrive(const sim::Scenario& scenario,
                     std::uint64_t seed,
                     const std::optional<algo::Stance>& believed)
    : world_(scenario, seed),
      pipeline_({.controller = scenario.controller, .parameters = scenario.parameters},
                with_stance(world_.spec(), believed)) {
  begin();
}

void HandDrive::begin() {
  world_.reset(t_.observation);
  pipeline_.reset(t_.observation.odometry.pose);
  truth_ = *world_.ground_truth();
}

void HandDrive::tick(algo::Joystick stick) {
  t_.requests.clear();
  if (t_.observation.stamp >= next_word_) {
    next_word_ = t_.observation.stamp + kWordEvery;
    if (pipeline_.refusal(stick)) stick.mode = algo::StickMode::Guarded;
    t_.requests.push_back(stick);
  }
  pipeline_.tick(t_);
  const algo::Command command = t_.command;
  world_.step(command, t_.observation);
  truth_ = *world_.ground_truth();
}

void HandDrive::hold(const algo::Joystick& stick, double seconds) {
  const double end = t_.observation.stamp + seconds;
  while (t_.observation.stamp < end) tick(stick);
}

}  // namespace server::soak
