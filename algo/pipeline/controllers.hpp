// algo/pipeline/controllers.hpp: the table of all controllers.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "algo/controller.hpp"
#include "algo/parameters.hpp"

namespace algo {

struct ControllerInfo {
  std::string_view name{};   // "modified": REST, command line, scenario files
  std::string_view label{};  // for people
  std::string_view help{};
  bool by_sonar = false;  // drives a robot that has a sonar ring and no laser
};

std::span<const ControllerInfo> controller_table();

/// Why the controller `name` cannot run with `parameters`, as a sentence; nothing when it can.
std::optional<std::string> refusal(std::string_view name, const Parameters& parameters);

/// Throws std::invalid_argument naming the known ones.
std::unique_ptr<Controller> make_controller(std::string_view name);

}  // namespace algo
