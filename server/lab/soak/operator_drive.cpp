// server/lab/soak/operator_drive.cpp: the stick, and the loop of world and pipeline.
#include "server/lab/soak/operator_drive.hpp"

#include <algorithm>
#include <cmath>

#include "server/lab/soak/hand_drive.hpp"

namespace server::soak {
namespace {

constexpr std::uint64_t kStickPurpose = 0x0BAD;

}  // namespace

std::string_view name(Hand hand) {
  switch (hand) {
    case Hand::Guarded:
      return "guarded";
    case Hand::Changing:
      return "changing";
    default:
      return "raw";
  }
}

AdversarialStick::AdversarialStick(std::uint64_t seed, Hand hand)
    : random_(seed, kStickPurpose), hand_(hand) {}

double AdversarialStick::axis() {
  const double kind = random_.uniform();
  if (kind < 0.2) return 0;
  if (kind < 0.6) return random_.uniform() < 0.5 ? -1 : 1;
  return random_.uniform(-1, 1);
}

algo::Joystick AdversarialStick::at(double stamp) {
  if (stamp < until_) return stick_;
  until_ = stamp + random_.uniform(0.3, 2.5);
  const double kind = random_.uniform();
  const double forward = axis();
  const double turn = axis();
  const double mode = random_.uniform();  // drawn for every hand, so that the rest is the same
  if (kind < 0.35) {
    stick_ = {1, kind < 0.15 ? 0 : turn};
  } else if (kind < 0.5) {
    stick_ = {stick_.forward > 0 ? -1.0 : 1.0, -stick_.turn};
  } else if (kind < 0.65) {
    stick_ = {0, turn < 0 ? -1.0 : 1.0};
  } else {
    stick_ = {forward, turn};
  }
  stick_.mode = algo::StickMode::Guarded;
  if (hand_ == Hand::Raw) stick_.mode = algo::StickMode::Raw;
  if (hand_ == Hand::Changing && mode < 0.4) stick_.mode = algo::StickMode::Wall;
  if (hand_ == Hand::Changing && mode >= 0.4 && mode < 0.8) stick_.mode = algo::StickMode::Elastic;
  return stick_;
}

Drive drive_adversarially(const sim::Scenario& scenario,
                          std::uint64_t seed,
                          double seconds,
                          Hand hand) {
  HandDrive robot(scenario, seed);
  ContactWitness witness(scenario, robot.spec());
  AdversarialStick stick(seed, hand);
  Drive drive;
  algo::Pose2 before_W = robot.truth().pose;
  witness.see(robot.observation(), robot.truth());
  while (robot.observation().stamp < seconds && !robot.overturned()) {
    robot.tick(stick.at(robot.observation().stamp));
    witness.see(robot.observation(), robot.truth());
    const algo::Pose2& now_W = robot.truth().pose;
    const double ahead = algo::to_child(before_W, now_W.position()).x();
    drive.ahead += std::max(0.0, ahead);
    drive.back += std::max(0.0, -ahead);
    drive.fastest_back = std::max(drive.fastest_back, -ahead / scenario.period);
    drive.turned += std::abs(algo::wrap_angle(now_W.heading - before_W.heading));
    before_W = now_W;
  }
  drive.seconds = robot.observation().stamp;
  drive.overturned = robot.overturned() ? 1 : 0;
  for (std::size_t k = 0; k < kTouches; ++k) {
    drive.touches.at(k) = witness.count(static_cast<Touch>(k));
  }
  drive.seen = witness.seen();
  return drive;
}

}  // namespace server::soak
