// algo/pipeline/parameter_table.cpp: the union of all lists, and the refusals.
#include "algo/pipeline/parameter_table.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "algo/filter/filter.hpp"
#include "algo/gate.hpp"
#include "algo/pipeline/arm_behaviour.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/pipeline/reactive.hpp"
#include "algo/pipeline/turnover_guard.hpp"
#include "algo/strip/strip_law.hpp"
#include "algo/teleop/teleop_parameters.hpp"
#include "algo/terrain/ground_survey.hpp"

namespace algo {
namespace {

constexpr auto kCommon = std::to_array<const ParameterInfo*>(
    {&kFilterHalfWidth, &kScanTimeout, &kJoystickTimeout, &kStickSpeed});

std::vector<const ParameterInfo*> all_parameters() {
  std::vector<const ParameterInfo*> all;
  const auto add = [&all](ParameterList list) {
    for (const ParameterInfo* each : list) {
      if (std::ranges::find(all, each) == all.end()) all.push_back(each);
    }
  };
  for (const ControllerInfo& controller : builtin_controllers().entries()) {
    add(controller.parameters);
  }
  add(kCommon);
  add(kTeleopParameters);
  add(kTurnoverParameters);
  add(kGroundParameters);
  add(kArmParameters);
  return all;
}

bool in_balance(const ParameterInfo& parameter) {
  return &parameter == &kStripStep || &parameter == &kRepulsionGain ||
         &parameter == &kSafetyDistance;
}

}  // namespace

ParameterList parameter_table() {
  static const std::vector<const ParameterInfo*> table = all_parameters();
  return table;
}

ParameterList common_parameters() {
  return kCommon;
}

const ParameterInfo* find_parameter(std::string_view name) {
  for (const ParameterInfo* each : parameter_table()) {
    if (each->name == name || (!name.empty() && each->alias == name)) return each;
  }
  return nullptr;
}

std::optional<std::string> refusal(const Parameters& now,
                                   const ParameterInfo& parameter,
                                   double value) {
  if (auto reason = limit_refusal(parameter, value)) return reason;
  if (!in_balance(parameter)) return std::nullopt;
  Parameters then = now;
  then.set(parameter, value);
  return strip_refusal(then);
}

std::optional<std::string> refusal(const Parameters& all) {
  for (const Parameters::Setting& each : all.settings()) {
    if (auto reason = limit_refusal(*each.parameter, each.value)) return reason;
  }
  return strip_refusal(all);
}

}  // namespace algo
