// algo/explain.cpp: words for a tick.
#include "algo/explain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace algo {
namespace {

constexpr double kNoticeable = 0.005;  // [m] a smaller force is not worth a sentence

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), pattern, args...);
  return text.data();
}

const Nearest* nearest_of(const Telemetry& t) {
  const auto& left = t.scene.left;
  const auto& right = t.scene.right;
  if (left && (!right || left->distance <= right->distance)) return &*left;
  return right ? &*right : nullptr;
}

std::string surroundings(const Telemetry& t) {
  const Nearest* nearest = nearest_of(t);
  if (nearest == nullptr) return "Nothing is seen within range.";
  return format("The nearest return is %.2f m from the robot's centre.", nearest->distance);
}

Explanation explain_hold(const Telemetry& t) {
  switch (t.hold) {
    case Hold::Halted:
      return explain(t.observation.halt);
    case Hold::Stopped:
      return {"Stopped", "Stop is engaged. The robot stays here until it is released."};
    case Hold::Bumper:
      return {"Touching something", "The bumper is pressed. Back away by hand, or reset."};
    case Hold::StaleScan: {
      if (t.scene.scan.size() == 0 && !t.scene.echoes.empty()) {
        return {"Waiting for the sonar",
                "No new reading comes, or the controller cannot do without a laser."};
      }
      const double age = t.observation.stamp - t.scene.scan.stamp;
      if (t.scene.scan.size() == 0) {
        return {"Waiting for the laser", "No scan has come yet. The robot waits."};
      }
      return {"Waiting for the laser", format("Scan is %.1f s old. The robot waits.", age)};
    }
    case Hold::Dazzled:
      return {"Waiting for the laser", "It is blinded or dazzled: beams ahead tell nothing."};
    case Hold::NotFinite:
      return {"Holding still", "A sensor or the controller gave a value that is not a number."};
    case Hold::LinkLost:
      return {"Holding still", "The link to the robot is lost."};
    case Hold::None:
      break;
  }
  return {};
}

Explanation explain_drive(const Telemetry& t, double to_goal) {
  const ControlOutput& out = t.output;
  const double left = out.external_left_W.norm();
  const double right = out.external_right_W.norm();
  const bool by_left = left >= right;
  const char* side = by_left ? "left" : "right";
  const auto& nearest = by_left ? t.scene.left : t.scene.right;
  const double force = by_left ? left : right;

  if (force < kNoticeable || !nearest) {
    return {"Driving to the goal", format("%.2f m to go. ", to_goal) + surroundings(t)};
  }
  std::string why = format(
      "External force %.2f m from the nearest %s return at %.2f m", force, side, nearest->distance);
  if (out.side == Side::None) {
    return {format("Keeping clear of the %s obstacle", side), why + "."};
  }
  const char* passed_on = out.side == Side::Left ? "left" : "right";
  why += format("; side chosen %.1f s ago.", t.observation.stamp - out.side_since);
  return {format("Passing the obstacle on its %s", passed_on), why};
}

/// [degrees] between the way to the pass point and the way to the goal.
double off_goal(const Telemetry& t) {
  const Vec2 p = t.observation.odometry.pose.position();
  const Vec2 way = t.output.pass_W - p;
  const Vec2 to_goal = t.goal->position_W - p;
  const double turn = std::atan2(way.y(), way.x()) - std::atan2(to_goal.y(), to_goal.x());
  return std::abs(wrap_angle(turn)) * 180 / std::numbers::pi;
}

double length(const Recycled<Vec2>& path) {
  double sum = 0;
  for (std::size_t k = 1; k < path.size(); ++k) sum += (path[k] - path[k - 1]).norm();
  return sum;
}

Explanation explain_window(const ControlOutput& out) {
  const auto all = static_cast<int>(out.candidates.size());
  const auto allowed = static_cast<int>(std::ranges::count_if(out.candidates, &Candidate::allowed));
  return {"Choosing among the speeds in reach",
          format("%d of %d motions can be stopped in time; the best is %.2f m/s, %.2f rad/s.",
                 allowed,
                 all,
                 out.twist.v,
                 out.twist.omega)};
}

double length(const Recycled<Node>& strip) {
  double sum = 0;
  for (std::size_t k = 1; k < strip.size(); ++k) {
    sum += (strip[k].position_W - strip[k - 1].position_W).norm();
  }
  return sum;
}

Explanation explain_full_strip(const Telemetry& t, double to_goal) {
  const ControlOutput& out = t.output;
  const auto tracks = static_cast<int>(out.tracks.size());
  switch (out.manner) {
    case Manner::Turning:
      return {"Turning towards the strip", "It leads away at too wide an angle to drive into."};
    case Manner::Maneuvering:
      return {"Manoeuvring", "The place is too narrow to turn in; it moves to and fro."};
    case Manner::GivingWay:
      return {"Giving way", format("%d things move; waiting costs less than driving on.", tracks)};
    case Manner::Cornered:
      return {"Making room",
              format("%d things move and every motion comes too close to one.", tracks)};
    case Manner::Escaping:
      return {"Making room", "Something stands closer than the strip may pass."};
    case Manner::BackingOff:
      return {"Backing off", "There was no way on for too long; a new strip is laid."};
    case Manner::NoWay:
      return {"No way known",
              format("The map shows no way to the goal, %.2f m away. It is asked again four times "
                     "a second.",
                     to_goal)};
    case Manner::GoalTaken:
      return {
          "The goal is taken",
          format("Something stands on it, %.2f m away, or too close to it. It is looked at again "
                 "four times a second.",
                 to_goal)};
    case Manner::Blocked:
      return {"Standing still", "No motion could be braked in time. " + surroundings(t)};
    default:
      return {"Following the strip",
              format("%.2f m along it to the goal, at %.2f m/s. ", length(out.strip), out.twist.v) +
                  surroundings(t)};
  }
}

/// A controller without a strip says what it is about itself.
Explanation explain_manner(const Telemetry& t, double to_goal) {
  const ControlOutput& out = t.output;
  const Vec2 p = t.observation.odometry.pose.position();
  switch (out.manner) {
    case Manner::TakingScan:
      return {"Standing still to take a scan",
              "Something is in the lane to the goal; its edges are looked for at rest."};
    case Manner::ToEdge:
      return {
          "Driving past an edge",
          format("The point beside the obstacle's edge is %.2f m away.", (out.pass_W - p).norm())};
    case Manner::Pushed:
      return {"Driving where pull and pushes lead",
              format("That is %.0f degrees off the goal. ", off_goal(t)) + surroundings(t)};
    case Manner::Planned:
      return {"Following its plan",
              format("The path over the grid is %.2f m long.", length(out.plan_W))};
    case Manner::NoPlan:
      return {"Looking for a way",
              "No path over the grid reaches the goal; this one ends nearest to it."};
    case Manner::Valley: {
      const auto free = std::ranges::count_if(out.histogram,
                                              [&](float h) { return h < out.histogram_threshold; });
      return {"Steering through a free valley",
              format("%d of %d sectors are free; the way is %.0f degrees off the goal.",
                     static_cast<int>(free),
                     static_cast<int>(out.histogram.size()),
                     off_goal(t))};
    }
    case Manner::Walled:
      return {"Turning on the spot", "No sector of the histogram is free."};
    case Manner::Window:
      return explain_window(out);
    case Manner::NoWindow:
      return {"Braking", "No motion in reach could be stopped in time."};
    case Manner::None:
    case Manner::ToGoal:
      break;
    default:
      return explain_full_strip(t, to_goal);
  }
  return {"Driving straight to the goal", format("%.2f m to go. ", to_goal) + surroundings(t)};
}

Explanation explain_stuck(const Telemetry& t, double to_goal) {
  const std::string advice = format("%.2f m to go. Move an obstacle or the goal.", to_goal);
  if (t.output.manner != Manner::None) {
    return {"Stuck", explain_manner(t, to_goal).why + " " + advice};
  }
  return {"Stuck",
          format("The pull to the goal and the push of %.2f m from obstacles cancel; ",
                 t.output.elastic_W.norm()) +
              advice};
}

}  // namespace

Explanation explain(Halt halt) {
  switch (halt) {
    case Halt::Disarmed:
      return {"The motors are off",
              "Nobody has armed this robot. It moves only once somebody does."};
    case Halt::BaseLost:
      return {"Waiting for the base", "The motor controller is silent. The wheels are held still."};
    case Halt::ScannerLost:
      return {"Waiting for the laser", "The scanner is silent. The wheels are held still."};
    case Halt::BadLine:
      return {"Holding still",
              "More of what the scanner sends comes damaged than whole: look at its cable."};
    case Halt::ScannerFault:
      return {"Holding still", "The scanner reports a fault of its own, or is blinded."};
    case Halt::StopButton:
      return {"Stop button pressed",
              "The stop button on the robot is pressed. Release it, then arm again."};
    case Halt::BaseFault:
      return {"Holding still", "The motor controller reports a fault."};
    case Halt::OverCurrent:
      return {"Holding still", "A motor took more current than it may: is a wheel blocked?"};
    case Halt::BatteryLow:
      return {"Battery low", "The battery is below its limit. Charge it."};
    case Halt::MotorsOff:
      return {"Waiting for the motors", "The robot is armed, but its motors are not on yet."};
    case Halt::LateTick:
      return {"Holding still", "The control loop came too late; the wheels were stopped."};
    case Halt::None:
      break;
  }
  return {"Holding still", "The robot holds its wheels still."};
}

Explanation explain(const Telemetry& t) {
  if (t.hold != Hold::None) return explain_hold(t);
  if (t.behaviour == BehaviourId::Manual) {
    return {"Driven by hand",
            format("%.2f m/s ahead, %.2f rad/s. ", t.command.base.v, t.command.base.omega) +
                surroundings(t)};
  }
  if (!t.goal) return {"Waiting for a goal", surroundings(t)};
  const double to_goal = (t.goal->position_W - t.observation.odometry.pose.position()).norm();
  const Vec2& goal = t.goal->position_W;
  switch (t.mission) {
    case Mission::Arrived:
      return {"Arrived",
              format("%.2f m from the goal at (%.2f, %.2f).", to_goal, goal.x(), goal.y())};
    case Mission::Stuck:
      return explain_stuck(t, to_goal);
    default:
      return t.output.manner == Manner::None ? explain_drive(t, to_goal)
                                             : explain_manner(t, to_goal);
  }
}

}  // namespace algo
