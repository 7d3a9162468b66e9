// algo/explain.cpp: composes the words of a tick.
#include "algo/explain.hpp"

#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <numbers>
#include <string_view>

#include "algo/gate.hpp"

namespace algo {
namespace {

const Nearest* nearest_of(const Telemetry& t) {
  const auto& left = t.scene.left;
  const auto& right = t.scene.right;
  if (left && (!right || left->distance <= right->distance)) return &*left;
  return right ? &*right : nullptr;
}

void explain_stale(const Telemetry& t, Explanation& words) {
  if (t.scene.scan.size() == 0 && !t.scene.echoes.empty()) {
    words.what = "Waiting for the sonar";
    words.why = "No new reading comes, or the controller cannot do without a laser.";
    return;
  }
  words.what = "Waiting for the laser";
  if (t.scene.scan.size() == 0) {
    words.why = "No scan has come yet. The robot waits.";
  } else {
    say(words.why,
        "Scan is %.1f s old. The robot waits.",
        t.observation.stamp - t.scene.scan.stamp);
  }
}

void explain_hold(const Telemetry& t, Explanation& words) {
  if (t.hold == holds::kHalted) {
    words.what = info(t.observation.halt).what;
    words.why = info(t.observation.halt).why;
  } else if (t.hold == holds::kStaleScan) {
    explain_stale(t, words);
  } else {
    words.what = t.hold.what;
    words.why = t.hold.why;
  }
}

void explain_arrived(const Telemetry& t, const Vec2& goal, Explanation& words) {
  words.what = "Arrived";
  say(words.why, "%.2f m from the goal at (%.2f, %.2f).", to_goal(t), goal.x(), goal.y());
}

/// Appends why the robot is limited, if it is.
void say_limit(const Telemetry& t, std::string& text) {
  if (!t.limit) return;
  text += ' ';
  text += t.limit.why;
}

}  // namespace

Explanation explain(Halt halt) {
  return {std::string(info(halt).what), std::string(info(halt).why)};
}

void say(std::string& text, const char* pattern, ...) {
  std::array<char, 200> piece{};
  std::va_list numbers;
  va_start(numbers, pattern);
  std::vsnprintf(piece.data(), piece.size(), pattern, numbers);
  va_end(numbers);
  text += piece.data();
}

void say_surroundings(const Telemetry& t, std::string& text) {
  if (const Nearest* nearest = nearest_of(t)) {
    say(text, "The nearest return is %.2f m from the robot's centre.", nearest->distance);
  } else {
    text += "Nothing is seen within range.";
  }
}

void say_driving(const Telemetry& t, Explanation& words) {
  words.what = "Driving to the goal";
  say(words.why, "%.2f m to go. ", to_goal(t));
  say_surroundings(t, words.why);
}

double to_goal(const Telemetry& t) {
  if (!t.goal) return 0;
  return (t.goal->position_W - t.observation.odometry.pose.position()).norm();
}

double off_goal(const Telemetry& t) {
  if (!t.goal || !t.output.pass_W) return 0;
  const Vec2 p = t.observation.odometry.pose.position();
  const Vec2 way = *t.output.pass_W - p;
  const Vec2 direct = t.goal->position_W - p;
  const double turn = std::atan2(way.y(), way.x()) - std::atan2(direct.y(), direct.x());
  return std::abs(wrap_angle(turn)) * 180 / std::numbers::pi;
}

void explain(const Telemetry& t, const Controller& controller, Explanation& words) {
  words.what.clear();
  words.why.clear();
  if (t.hold) {
    explain_hold(t, words);
  } else if (t.behaviour == behaviours::kManual) {
    words.what = "Driven by hand";
    say(words.why, "%.2f m/s ahead, %.2f rad/s. ", t.command.base.v, t.command.base.omega);
    say_surroundings(t, words.why);
    say_limit(t, words.why);
  } else if (!t.goal) {
    words.what = "Waiting for a goal";
    say_surroundings(t, words.why);
  } else if (t.mission == Mission::Arrived) {
    explain_arrived(t, t.goal->position_W, words);
  } else if (t.behaviour == behaviours::kGround) {
    words.what = "Surveying the ground ahead";
    words.why = t.limit.why;
  } else {
    controller.explain(t, words);
    say_limit(t, words.why);
    if (t.mission != Mission::Stuck) return;
    words.what = "Stuck";
    say(words.why, " %.2f m to go. Move an obstacle or the goal.", to_goal(t));
  }
}

}  // namespace algo
