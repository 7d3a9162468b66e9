// algo/pipeline/driver_link.cpp: the limits of a slow link.
#include "algo/pipeline/driver_link.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace algo {
namespace {

constexpr double kUnansweredPath = 0.3;  // [m]
constexpr double kUnansweredTurn = 0.5;  // [rad]

}  // namespace

std::optional<std::string> link_refusal(const Joystick& stick) {
  if (!(stick.round_trip >= 0)) return "The round trip of a stick's link must be 0 s or more.";
  if (stick.centred() || stick.round_trip <= kMostRoundTrip) return std::nullopt;
  std::array<char, 96> text{};
  std::snprintf(text.data(),
                text.size(),
                "The link takes %.2f s to and fro; over %.1f s the robot obeys only Stop.",
                stick.round_trip,
                kMostRoundTrip);
  return text.data();
}

Twist2 capped_for_link(const Twist2& wanted, const Joystick& stick) {
  const double delay = driver_delay(stick);
  const double share = std::max({1.0,
                                 std::abs(wanted.v) * delay / kUnansweredPath,
                                 std::abs(wanted.omega) * delay / kUnansweredTurn});
  return {wanted.v / share, wanted.omega / share};
}

}  // namespace algo
