// algo/parameters.cpp: the table of tunable numbers and what is refused.
#include "algo/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace algo {
namespace {

constexpr std::array<ParameterInfo, kParameterCount> kTable{{
    {Parameter::ContractionGain,
     "k_c",
     "Contraction K_c",
     "",
     0.0,
     1.0,
     0.05,
     0.8,
     "How strongly the strip pulls a via point onto the straight line. It moves the robot only "
     "with the controller that keeps its via point, which needs it below 1."},
    {Parameter::RepulsionGain,
     "k_r",
     "Repulsion K_r",
     "",
     0.05,
     1.0,
     0.05,
     0.6,
     "How strongly obstacles push the strip away. Larger keeps more distance."},
    {Parameter::SafetyDistance,
     "safety_distance",
     "Safety distance",
     "m",
     0.1,
     3.0,
     0.05,
     1.0,
     "Obstacles nearer to the robot's centre than this plus its radius push linearly."},
    {Parameter::StripStep,
     "strip_step",
     "Strip step S",
     "m",
     0.05,
     0.6,
     0.01,
     0.2,
     "How far ahead the strip's end is set towards the goal. Must stay below K_r times the safety "
     "distance, or the goal's pull can win over an obstacle's push."},
    {Parameter::MaxSpeed,
     "v_max",
     "Top speed",
     "m/s",
     0.01,
     2.0,
     0.01,
     0.3,
     "Fastest the robot may drive."},
    {Parameter::MaxTurnRate,
     "w_max",
     "Top turn rate",
     "rad/s",
     0.1,
     3.0,
     0.1,
     1.0,
     "Fastest the robot may turn."},
    {Parameter::HeadingGain,
     "heading_gain",
     "Heading gain",
     "1/s",
     0.5,
     5.0,
     0.1,
     2.0,
     "Turn rate per radian of heading error."},
    {Parameter::GoalReach,
     "goal_reach",
     "Goal reach",
     "m",
     0.02,
     1.0,
     0.01,
     0.1,
     "The goal counts as reached within this distance."},
    {Parameter::FilterHalfWidth,
     "filter_half_width",
     "Filter half width N",
     "",
     0.0,
     10.0,
     1.0,
     1.0,
     "The scan filter looks at N beams on either side; 0 switches it off."},
    {Parameter::ScanTimeout,
     "scan_timeout",
     "Scan timeout",
     "s",
     0.05,
     2.0,
     0.05,
     0.2,
     "The robot is held when its newest scan is older than this."},
    {Parameter::JoystickTimeout,
     "joystick_timeout",
     "Joystick timeout",
     "s",
     0.1,
     2.0,
     0.1,
     0.5,
     "The robot stops when the stick has been silent for this long."},
    {Parameter::NearestGoal,
     "nearest_goal",
     "Goal taken: go near",
     "",
     0.0,
     1.0,
     1.0,
     1.0,
     "What the full strip does when something stands on its goal: 1 drives to the nearest free "
     "place, 0 stops where it finds out."},
}};

/// "0.6" rather than "0.600000".
std::string number(double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string with_unit(double value, std::string_view unit) {
  return unit.empty() ? number(value) : number(value) + " " + std::string(unit);
}

std::optional<std::string> limit_refusal(const ParameterInfo& about, double value) {
  const std::string name(about.name);
  if (!std::isfinite(value)) return name + " must be a finite number";
  if (value < about.min || value > about.max) {
    return name + " must be from " + number(about.min) + " to " + with_unit(about.max, about.unit) +
           ", not " + number(value);
  }
  if (about.step == 1 && value != std::floor(value)) {
    return name + " must be a whole number, not " + number(value);
  }
  return std::nullopt;
}

/// equations.md D, consequence 2: head-on the strip balances at a body clearance of
/// d_safe - S / K_r, which must be above 0.
std::optional<std::string> balance_refusal(const Parameters& all) {
  const double step = all[Parameter::StripStep];
  const double gain = all[Parameter::RepulsionGain];
  const double safe = all[Parameter::SafetyDistance];
  if (step < gain * safe) return std::nullopt;
  return "strip_step " + with_unit(step, "m") +
         " must be below k_r x safety_distance = " + number(gain) + " x " + with_unit(safe, "m") +
         " = " + with_unit(gain * safe, "m") + ", or the robot could be pulled into an obstacle";
}

}  // namespace

std::span<const ParameterInfo> parameter_table() {
  return kTable;
}

const ParameterInfo& info(Parameter parameter) {
  return kTable[static_cast<std::size_t>(parameter)];
}

std::optional<Parameter> find_parameter(std::string_view name) {
  const auto* const found = std::ranges::find(kTable, name, &ParameterInfo::name);
  if (found == kTable.end()) return std::nullopt;
  return found->id;
}

Parameters::Parameters() {
  std::ranges::transform(kTable, values_.begin(), &ParameterInfo::initial);
}

std::optional<std::string> refusal(const Parameters& now, Parameter parameter, double value) {
  if (auto reason = limit_refusal(info(parameter), value)) return reason;
  Parameters then = now;
  then.set(parameter, value);
  const bool in_balance = parameter == Parameter::StripStep ||
                          parameter == Parameter::RepulsionGain ||
                          parameter == Parameter::SafetyDistance;
  return in_balance ? balance_refusal(then) : std::nullopt;
}

std::optional<std::string> refusal(const Parameters& all) {
  for (const ParameterInfo& about : kTable) {
    if (auto reason = limit_refusal(about, all[about.id])) return reason;
  }
  return balance_refusal(all);
}

}  // namespace algo
