// server/lab/soak/operator_drive.hpp: one drive of an operator who tries to hit something.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "algo/request.hpp"
#include "server/lab/soak/contact_witness.hpp"
#include "sim/random.hpp"
#include "sim/scenario.hpp"

namespace server::soak {

/// The modes that the operator uses. Changing: guarded, wall and elastic, at random.
enum class Hand : std::uint8_t { Guarded, Changing, Raw };
inline constexpr std::array kHands{Hand::Guarded, Hand::Changing, Hand::Raw};
/// "guarded", "changing", "raw"
std::string_view name(Hand hand);

/// Full stick, reversals, spins, and partial deflections, a new one every 0.3 to 2.5 s. The same
/// seed gives the same deflections for every hand.
class AdversarialStick {
 public:
  AdversarialStick(std::uint64_t seed, Hand hand);
  algo::Joystick at(double stamp);

 private:
  double axis();

  sim::Random random_;
  Hand hand_;
  algo::Joystick stick_{};
  double until_ = 0;  // [s] run clock
};

struct Drive {
  double seconds = 0;
  double ahead = 0;         // [m] driven ahead, by the true pose
  double back = 0;          // [m]
  double turned = 0;        // [rad]
  double fastest_back = 0;  // [m/s]
  std::array<int, kTouches> touches{};
  int overturned = 0;               // 1: somebody turned the robot over, which ended the drive
  std::vector<std::string> seen{};  // a text for each contact that must not happen
  int touched(Touch touch) const { return touches.at(static_cast<std::size_t>(touch)); }
};

/// Drives `scenario`, which has no goal, for `seconds`, with a word of the stick every 0.1 s. Ends
/// earlier if the robot is turned over: a simulated person is as strong as a lorry.
/// Throws std::invalid_argument with a sentence if there can be no such world.
Drive drive_adversarially(const sim::Scenario& scenario,
                          std::uint64_t seed,
                          double seconds,
                          Hand hand);

}  // namespace server::soak
