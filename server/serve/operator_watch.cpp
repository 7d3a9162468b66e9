// server/serve/operator_watch.cpp: keeps signs of life and judges how old they may be.
#include "server/serve/operator_watch.hpp"

#include <algorithm>
#include <cmath>

namespace server {

void OperatorWatch::page_sign(std::uint64_t page, Time now) {
  pages_[page] = now;
  sign(now);
}

void OperatorWatch::sign(Time now) {
  const Clock::rep then = now.time_since_epoch().count();
  newest_.store(std::max(newest_.load(std::memory_order_relaxed), then), std::memory_order_relaxed);
}

void OperatorWatch::script_sign(Time now) {
  script_ = now;
  sign(now);
}

Watchers OperatorWatch::watchers(Time now) const {
  const auto fresh = [now](Time seen) { return now - seen <= kPatience; };
  Watchers out;
  for (const auto& [page, seen] : pages_) out.pages += fresh(seen) ? 1U : 0U;
  out.scripts = script_ && fresh(*script_);
  return out;
}

const char* OperatorWatch::why_disarm(std::uint32_t arming, bool moves, Time now) {
  if (arming != arming_ || moves) rests_since_ = now;
  arming_ = arming;
  if (arming == 0 || !needed_.load(std::memory_order_relaxed)) return nullptr;
  const Time seen{Clock::duration(newest_.load(std::memory_order_relaxed))};
  // Compared, not subtracted: before the first sign, `seen` is the smallest time point.
  if (moves && seen < now - kPatience) return kGone;
  if (std::max(seen, rests_since_) < now - kRestPatience) return kLeft;
  return nullptr;
}

bool on_its_way(const algo::Telemetry& t) {
  constexpr double kAtRest = 0.01;  // [m/s], [rad/s] below what odometry resolves
  const algo::Twist2& twist = t.observation.odometry.twist;
  const bool turning = std::abs(twist.v) > kAtRest || std::abs(twist.omega) > kAtRest;
  const bool under_way = t.goal && t.mission != algo::Mission::Arrived;
  return turning || under_way || t.command.base != algo::Twist2{};
}

}  // namespace server
