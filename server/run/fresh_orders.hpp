// server/run/fresh_orders.hpp: keeps a real robot from carrying out orders given before it was
// armed and Stop was released.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "algo/intent.hpp"

namespace server {

/// Decides which orders a robot accepts and which it drops. While the robot is disarmed or stopped
/// it refuses goals and the stick, and drops those it had: neither arming nor a release sets it in
/// motion. A stick that was held meanwhile has to be let go first. Control thread.
class FreshOrders {
 public:
  static constexpr double kLetGo = 0.5;  // [s] without a held stick: it has been let go

  /// `epoch` as in algo::Arming. True when earlier orders are void.
  bool notice(std::uint32_t epoch);
  /// Why `request` is refused at `now` [s] of the run clock, as a sentence.
  std::optional<std::string> refusal(const algo::Request& request, double now);
  /// `request` was accepted. True when it voids earlier orders.
  bool accept(const algo::Request& request);

  /// The pipeline has seen all accepted requests; `intent` is their result.
  void follow(const algo::Intent& intent) { asked_ = intent; }
  /// The sum of all accepted requests, except obstacle edits.
  const algo::Intent& asked() const { return asked_; }

  bool goal() const {
    return asked_.goal || asked_.hand_goal || asked_.carry_goal || asked_.joint_goal;
  }
  bool stick() const { return asked_.stick != algo::Joystick{}; }  // the stick is not at rest

 private:
  algo::Intent asked_{};
  std::uint32_t epoch_ = 0;
  double held_at_ = -std::numeric_limits<double>::infinity();  // [s] of the last refused stick
};

}  // namespace server
