// server/cli/cli.cpp: code shared by the subcommands.
#include "server/cli/cli.hpp"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "drivers/lms200_machine.hpp"
#include "server/run/arm_json.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/map_robot.hpp"
#include "server/run/paths.hpp"
#include "server/run/robot_json.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/scenario_library.hpp"

namespace server {

void RunFlags::add_to(Command command) {
  controllers.add_to(command,
                     "Controller in place of the scenario's: a name, or the command that starts "
                     "your own (docs/external-controllers.md)");
  command.add_option("--filter", overrides.filter, "pseudomedian, median, lulu or none");
  command.add_option("--physics,--vehicle", physics, "bullet or kinematic");
  add_robot_option(command, robot);
  command.add_option("--seed", overrides.seed, "Seed of the sensor noise (default 1)");
  add_set_option(command, settings);
}

void RunFlags::add_arm_to(Command command) {
  command
      .add_option("--hand-goal",
                  hand_goal,
                  "Goal of the hand [m] in place of the scenario's goals, for a robot with an arm; "
                  "without a quaternion the hand points up")
      .type_name("X,Y,Z[,QX,QY,QZ,QW]");
  command.add_option("--joints", joints, "Where the arm's seven joints begin [rad]")
      .type_name("J1,...,J7");
}

void RunFlags::add_map_to(Command command) {
  command
      .add_option("--map",
                  map,
                  "The map that the robot drives by: a YAML file of map_server, its picture beside "
                  "it (docs/maps.md)")
      .existing_file()
      .type_name("FILE");
  command.add_flag(
      "--lost",
      overrides.lost,
      "Where a simulated robot starts on its map is not known: it looks for its place");
}

RunOverrides RunFlags::resolved(const RobotLibrary& robots) const {
  RunOverrides out = overrides;
  if (out.seed) overrides_from_json({{"seed", *out.seed}});  // has the limit of every seed
  out.controllers = controllers.catalogue();
  out.controller = controllers.chosen();
  if (!physics.empty()) out.physics = physics_named(physics, "--physics");
  if (names_file(robot)) {
    out.robot = robot_document(robots.load_file_or_name(robot));
  } else if (!robot.empty()) {
    out.robot = robot;
  }
  if (!hand_goal.empty()) out.hand_goal = hand_goal_from_text(hand_goal, "--hand-goal");
  if (!joints.empty()) out.joints = joints_from_text(joints, "--joints");
  if (!map.empty()) out.map = known_map(map);
  out.parameters = parameters_set(settings);
  return out;
}

Option add_password_option(Command command, std::string& password) {
  return command
      .add_option("--password", password, "Password of its configuration, if it was changed")
      .check(
          [](const std::string& text) -> std::string {
            return drivers::lms200::good_password(text) ? "" : "A password has 8 characters.";
          },
          "8 CHARACTERS")
      .show_default();
}

Option add_set_option(Command command, std::vector<std::string>& settings) {
  return command.add_option("--set", settings, "A parameter, such as k_r=0.3; repeatable")
      .type_name("NAME=VALUE");
}

nlohmann::json parameters_set(const std::vector<std::string>& settings) {
  nlohmann::json parameters = nlohmann::json::object();
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
    parameters[setting.substr(0, equals)] = value;
  }
  return parameters;
}

RobotLibrary own_robots() {
  return RobotLibrary(state_folder() / "robots");
}

Option add_robot_option(Command command, std::string& robot) {
  return command
      .add_option(
          "--robot-model",
          robot,
          "Drive this robot: a file, or a name such as jackal; another than the scenario's brings "
          "its own sensors")
      .type_name("FILE|NAME")
      .check([](const std::string& text) {
        return text.empty() ? "must be a file or the name of a robot" : "";
      });
}

sim::Scenario find_scenario(const std::string& name) {
  if (names_file(name)) return ScenarioLibrary::from_file(name, own_robots());
  return ScenarioLibrary(state_folder() / "scenarios", state_folder() / "logs", own_robots())
      .load(name);
}

void warn_of_damage(const std::string& log, const std::string& damage) {
  if (damage.empty()) return;
  fmt::print(stderr, "tautline: warning: {} has lines that were left out: {}.\n", log, damage);
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
