// server/cli/cli.cpp: what the subcommands share.
#include "server/cli/cli.hpp"

#include <cstdio>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "server/run/json_reader.hpp"
#include "server/run/paths.hpp"
#include "server/run/scenario_library.hpp"

namespace server {

void RunFlags::add_to(CLI::App& command) {
  command.add_option("--controller", overrides.controller, "Instead of the scenario's own");
  command.add_option("--filter", overrides.filter, "pseudomedian, median, lulu or none");
  command.add_option("--vehicle", overrides.vehicle, "bullet or kinematic");
  command.add_option("--seed", overrides.seed, "Seed of the sensor noise (default 1)");
  command.add_option("--set", settings, "A parameter, such as k_r=0.3; may be given again")
      ->type_name("NAME=VALUE");
}

RunOverrides RunFlags::resolved() const {
  RunOverrides out = overrides;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw DocumentError("--set " + setting, "must be NAME=VALUE, such as k_r=0.3");
    }
    const std::string text = setting.substr(equals + 1);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') {
      throw DocumentError("--set " + setting, fmt::format("'{}' is not a number", text));
    }
    out.parameters[setting.substr(0, equals)] = value;
  }
  return out;
}

sim::Scenario find_scenario(const std::string& name) {
  std::error_code error;
  const std::filesystem::path path(name);
  const bool looks_like_path = name.find('/') != std::string::npos || path.has_extension();
  if (looks_like_path || std::filesystem::is_regular_file(path, error)) {
    return ScenarioLibrary::from_file(path);
  }
  return ScenarioLibrary(state_folder() / "scenarios", state_folder() / "logs").load(name);
}

CLI::Validator file_to_write() {
  const auto check = [](const std::string& path) -> std::string {
    if (!std::filesystem::is_directory(path)) return {};
    return path + " is a folder: name the file to write";
  };
  return {check, ""};
}

ProgressLine::ProgressLine() : interactive_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::show(const std::string& text) {
  if (!interactive_) return;
  fmt::print(stderr, "\r\033[K{}", text);
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace server
