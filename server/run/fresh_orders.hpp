// server/run/fresh_orders.hpp: a real robot goes nowhere that was asked for before it was armed and
// released.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "algo/request.hpp"

namespace server {

/// Which orders a robot may be given, and which end. Goals and the stick are refused while it is
/// disarmed or stopped, and end when it is: neither arming nor a release sets it in motion. A stick
/// that was held meanwhile has to be let go first. Control thread.
class FreshOrders {
 public:
  static constexpr double kLetGo = 0.5;  // [s] without a stick that is held

  /// `arming` as of algo::Robot. True when what was ordered before is void.
  bool notice(std::uint32_t arming);
  /// Why `request` is refused at `now` [s] of the run clock, as a sentence.
  std::optional<std::string> refusal(const algo::Request& request, double now);
  /// `request` was accepted. True when it makes void what was ordered before.
  bool accept(const algo::Request& request);

  bool goal() const { return goal_; }    // one was accepted and is not void
  bool stick() const { return stick_; }  // the last that was accepted was not at rest

 private:
  std::uint32_t arming_ = 0;
  bool stopped_ = false;
  bool goal_ = false;
  bool stick_ = false;
  double held_at_ = -std::numeric_limits<double>::infinity();  // [s] a stick in vain
};

}  // namespace server
