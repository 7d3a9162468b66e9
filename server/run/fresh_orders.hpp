// server/run/fresh_orders.hpp: a real robot goes nowhere that was asked for before it was armed and
// released.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "algo/intent.hpp"

namespace server {

/// Which orders a robot may be given, and which end. Goals and the stick are refused while it is
/// disarmed or stopped, and end when it is: neither arming nor a release sets it in motion. A stick
/// that was held meanwhile has to be let go first. Control thread.
class FreshOrders {
 public:
  static constexpr double kLetGo = 0.5;  // [s] without a stick that is held

  /// `epoch` as of algo::Arming. True when what was ordered before is void.
  bool notice(std::uint32_t epoch);
  /// Why `request` is refused at `now` [s] of the run clock, as a sentence.
  std::optional<std::string> refusal(const algo::Request& request, double now);
  /// `request` was accepted. True when it makes void what was ordered before.
  bool accept(const algo::Request& request);

  /// The pipeline has seen all that was accepted, and this is what it makes of it.
  void follow(const algo::Intent& intent) { asked_ = intent; }
  /// What was accepted adds up to, but for obstacle edits.
  const algo::Intent& asked() const { return asked_; }

  bool goal() const { return asked_.goal.has_value(); }
  bool stick() const { return asked_.stick != algo::Joystick{}; }  // it is not at rest

 private:
  algo::Intent asked_{};
  std::uint32_t epoch_ = 0;
  double held_at_ = -std::numeric_limits<double>::infinity();  // [s] a stick in vain
};

}  // namespace server
