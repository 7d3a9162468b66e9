// algo/parameters.hpp: every tunable number with its name, unit and limits, in one table that the
// page's sliders, REST, Foxglove parameters and `--set` all read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace algo {

enum class Parameter : std::uint8_t {
  ContractionGain,  // K_c
  RepulsionGain,    // K_r
  SafetyDistance,   // d_safe
  StripStep,        // S
  MaxSpeed,         // v_max
  MaxTurnRate,      // w_max
  HeadingGain,
  GoalReach,
  FilterHalfWidth,  // N
  ScanTimeout,
  JoystickTimeout,
  NearestGoal,
};
constexpr std::size_t kParameterCount = 12;

struct ParameterInfo {
  Parameter id{};
  std::string_view name{};   // "k_r": REST, --set, Foxglove
  std::string_view label{};  // "Repulsion K_r": for people
  std::string_view unit{};   // "m", "m/s", "" for a bare number
  double min = 0;
  double max = 0;
  double step = 0;  // a slider's step; whole numbers only where it is 1
  double initial = 0;
  std::string_view help{};
};

/// The table, in the order of Parameter.
std::span<const ParameterInfo> parameter_table();
const ParameterInfo& info(Parameter parameter);
std::optional<Parameter> find_parameter(std::string_view name);

class Parameters {
 public:
  Parameters();  // every one at its initial value
  double operator[](Parameter p) const { return values_[static_cast<std::size_t>(p)]; }
  /// Sets without a check; use refusal() first for values from outside.
  void set(Parameter p, double value) { values_[static_cast<std::size_t>(p)] = value; }
  bool operator==(const Parameters&) const = default;

 private:
  std::array<double, kParameterCount> values_{};
};

/// Why `value` cannot be given to `parameter` while the others are as in `now`, as a sentence;
/// nothing when it can. Refuses what is out of limits, not finite, and S >= K_r d_safe, with which
/// the strip can be pushed into an obstacle (equations.md D, consequence 2).
std::optional<std::string> refusal(const Parameters& now, Parameter parameter, double value);

/// The same for a whole set, such as a scenario's.
std::optional<std::string> refusal(const Parameters& all);

}  // namespace algo
