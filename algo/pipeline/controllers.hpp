// algo/pipeline/controllers.hpp: the catalogue of controllers: the readings of the elastic strip,
// and their baselines.
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
  std::string_view name{};   // "modified": REST, command line, scenario files
  std::string_view label{};  // for people
  std::string_view help{};
  bool by_sonar = false;  // drives a robot that has a sonar ring and no laser
  ParameterList parameters{};
  std::function<std::unique_ptr<Controller>()> make{};
  /// Why it cannot run with these values, as a sentence; nothing when it can. May be empty.
  std::function<std::optional<std::string>(const Parameters&)> refusal{};
};

/// The controllers that a run may choose from. A value: the maker of a pipeline may add to it.
class ControllerCatalogue {
 public:
  ControllerCatalogue() = default;
  explicit ControllerCatalogue(std::vector<ControllerInfo> entries)
      : entries_(std::move(entries)) {}

  const std::vector<ControllerInfo>& entries() const { return entries_; }
  /// Null when none is called so.
  const ControllerInfo* find(std::string_view name) const;
  /// Throws std::invalid_argument naming the known ones.
  const ControllerInfo& at(std::string_view name) const;

 private:
  std::vector<ControllerInfo> entries_{};
};

const ControllerCatalogue& builtin_controllers();

}  // namespace algo
