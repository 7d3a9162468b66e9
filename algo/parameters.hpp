// algo/parameters.hpp: tunable numbers. Each is declared beside the component that reads it. The
// page's sliders, REST, Foxglove, `--set` and the documents offer the union of them.
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace algo {

/// One tunable number in static storage; its address is its identity.
struct ParameterInfo {
  std::string_view name{};   // "strip.k_r": component, then parameter
  std::string_view label{};  // "Repulsion K_r": for people
  std::string_view unit{};   // "m", "m/s", "" for a bare number
  double min = 0;
  double max = 0;
  double step = 0;  // of a slider; a step of 1 allows whole numbers only
  double initial = 0;
  std::string_view help{};
  std::string_view alias{};  // "k_r": the older name, without the component

  /// The spelling in documents; both names are accepted.
  constexpr std::string_view key() const { return alias.empty() ? name : alias; }
};

/// The parameters that one component reads.
using ParameterList = std::span<const ParameterInfo* const>;

/// Values of parameters. Each has its initial value until it is set.
class Parameters {
 public:
  struct Setting {
    const ParameterInfo* parameter = nullptr;
    double value = 0;
  };

  Parameters() = default;
  Parameters(std::initializer_list<Setting> settings) : settings_(settings) {}

  double operator[](const ParameterInfo& parameter) const {
    for (const Setting& setting : settings_) {
      if (setting.parameter == &parameter) return setting.value;
    }
    return parameter.initial;
  }
  /// Sets without a check; call refusal() first for values from outside.
  void set(const ParameterInfo& parameter, double value);
  /// The parameters that were set, in the order in which each was first set.
  std::span<const Setting> settings() const { return settings_; }
  bool all_finite() const;
  /// True if every parameter has the same value, set or initial.
  bool operator==(const Parameters& other) const;

 private:
  std::vector<Setting> settings_{};
};

/// Why `value` is outside the parameter's limits, as a sentence; nothing if it is inside.
std::optional<std::string> limit_refusal(const ParameterInfo& parameter, double value);

/// "0.6" rather than "0.600000", followed by the unit if there is one.
std::string with_unit(double value, std::string_view unit);

}  // namespace algo
