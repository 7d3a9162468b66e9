// algo/parameters.cpp: values by parameter, and their limits.
#include "algo/parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace algo {
namespace {

std::string number(double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

}  // namespace

void Parameters::set(const ParameterInfo& parameter, double value) {
  const auto at = std::ranges::find(settings_, &parameter, &Setting::parameter);
  if (at != settings_.end()) {
    at->value = value;
  } else {
    settings_.push_back({&parameter, value});
  }
}

bool Parameters::all_finite() const {
  return std::ranges::all_of(settings_, [](const Setting& s) { return std::isfinite(s.value); });
}

bool Parameters::operator==(const Parameters& other) const {
  const auto agrees = [](const Parameters& with) {
    return [&with](const Setting& s) { return with[*s.parameter] == s.value; };
  };
  return std::ranges::all_of(settings_, agrees(other)) &&
         std::ranges::all_of(other.settings_, agrees(*this));
}

std::string with_unit(double value, std::string_view unit) {
  return unit.empty() ? number(value) : number(value) + " " + std::string(unit);
}

std::optional<std::string> limit_refusal(const ParameterInfo& parameter, double value) {
  const std::string name(parameter.key());
  if (!std::isfinite(value)) return name + " must be a finite number";
  if (value < parameter.min || value > parameter.max) {
    return name + " must be from " + number(parameter.min) + " to " +
           with_unit(parameter.max, parameter.unit) + ", not " + number(value);
  }
  if (parameter.step == 1 && value != std::floor(value)) {
    return name + " must be a whole number, not " + number(value);
  }
  return std::nullopt;
}

}  // namespace algo
