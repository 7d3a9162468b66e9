// algo/pipeline/controllers.hpp: the catalogue of controllers: the variants of the elastic strip,
// and the baselines.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algo/controller.hpp"
#include "algo/parameters.hpp"

namespace algo {

struct ControllerInfo {
  std::string_view name{};   // "modified", as in REST, command line, scenario files
  std::string_view label{};  // for people
  std::string_view help{};
  bool by_sonar = false;  // can drive a robot with a sonar ring and no laser
  bool keeps_jerk =
      false;             // its commands keep to the robot's jerk, but for hard ones, which it tells
  bool outside = false;  // it runs outside the program, and its answers are inputs of the run
  ParameterList parameters{};
  std::function<std::unique_ptr<Controller>()> make{};
  /// Why it cannot run with these values, as a sentence; nothing if it can. The function may be
  /// empty.
  std::function<std::optional<std::string>(const Parameters&)> refusal{};
};

/// The controllers that a run may choose from. A value: code that makes a pipeline may add to it.
class ControllerCatalogue {
 public:
  ControllerCatalogue() = default;
  explicit ControllerCatalogue(std::vector<ControllerInfo> entries)
      : entries_(std::move(entries)) {}

  const std::vector<ControllerInfo>& entries() const { return entries_; }
  /// Null if no controller has that name.
  const ControllerInfo* find(std::string_view name) const;
  /// Throws std::invalid_argument that lists the known names.
  const ControllerInfo& at(std::string_view name) const;

 private:
  std::vector<ControllerInfo> entries_{};
};

const ControllerCatalogue& builtin_controllers();

}  // namespace algo
