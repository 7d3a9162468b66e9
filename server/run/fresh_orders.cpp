// server/run/fresh_orders.cpp: which orders are refused and which are dropped.
#include "server/run/fresh_orders.hpp"

#include <utility>
#include <variant>

namespace server {
namespace {

bool is_goal(const algo::Request& request) {
  const auto* list = std::get_if<algo::SetGoals>(&request);
  return std::holds_alternative<algo::SetGoal>(request) ||
         std::holds_alternative<algo::AddGoal>(request) ||
         std::holds_alternative<algo::SetHandGoal>(request) ||
         std::holds_alternative<algo::SetJoints>(request) ||
         std::holds_alternative<algo::Carry>(request) || (list != nullptr && !list->goals.empty());
}

}  // namespace

bool FreshOrders::notice(std::uint32_t epoch) {
  return std::exchange(epoch_, epoch) != epoch && (goal() || stick());
}

std::optional<std::string> FreshOrders::refusal(const algo::Request& request, double now) {
  const auto* stick = std::get_if<algo::Joystick>(&request);
  const bool pushed = stick != nullptr && !stick->centred();
  if (stick != nullptr && !pushed) held_at_ = -std::numeric_limits<double>::infinity();
  if (!pushed && !is_goal(request)) return std::nullopt;
  const char* why = nullptr;
  if (asked_.stop) {
    why = "This robot is stopped. Release Stop first, then send it off.";
  } else if (epoch_ == 0) {
    why = "The motors are off. Arm the robot first, then send it off.";
  } else if (pushed && now - held_at_ < kLetGo) {
    why = "The stick was held before the robot was armed or released. Let go of it first.";
  }
  if (why == nullptr) return std::nullopt;
  if (pushed) held_at_ = now;
  return why;
}

bool FreshOrders::accept(const algo::Request& request) {
  if (algo::is_edit(request)) return false;
  asked_.apply(request);
  const auto* stop = std::get_if<algo::Stop>(&request);
  return stop != nullptr && stop->engaged && (goal() || stick());
}

}  // namespace server
