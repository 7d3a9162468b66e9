// server/run/run_spec.hpp: everything that determines a run, and the robot and pipeline built from
// it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/pipeline/pipeline.hpp"
#include "algo/robot.hpp"
#include "server/run/robot_library.hpp"
#include "sim/scenario.hpp"

namespace server {

struct Hardware;
struct KnownMap;

/// The same spec gives the same run, bit for bit. The scenario names controller, filter and
/// physics.
struct RunSpec {
  sim::Scenario scenario{};
  algo::Parameters parameters{};
  std::uint64_t seed = 1;
  /// Where the robot begins this run instead of at the scenario's start.
  std::optional<algo::Pose2> begin_W{};
  /// The controllers that the run may choose from; null: the built-in ones.
  std::shared_ptr<const algo::ControllerCatalogue> controllers{};
  /// The scenario's map, read; null: none.
  std::shared_ptr<const KnownMap> map{};
  /// Real devices to run on instead of a world. They outlive the run.
  std::shared_ptr<const Hardware> hardware{};
};

/// "simulation", "replay" or "hardware".
const char* source_of(const RunSpec& spec);
/// "bullet", "kinematic", "log" or "hardware".
const char* physics_of(const RunSpec& spec);

/// Choices that replace the scenario's own, read from JSON or flags.
struct RunOverrides {
  std::optional<std::string> controller{};
  std::optional<std::string> filter{};
  std::optional<sim::PhysicsKind> physics{};
  /// As for choose_robot(); null keeps the scenario's robot.
  nlohmann::json robot{};
  std::optional<std::uint64_t> seed{};
  nlohmann::json parameters = nlohmann::json::object();
  // Of a robot with an arm: the hand's goal in place of all others, and where its joints begin.
  std::optional<algo::SetHandGoal> hand_goal{};
  std::optional<algo::JointValues> joints{};
  /// As in RunSpec. Comes from the program's own command line, never from a document.
  std::shared_ptr<const algo::ControllerCatalogue> controllers{};
  std::shared_ptr<const KnownMap> map{};  // likewise; in place of the scenario's
  bool lost = false;                      // likewise; as in the scenario
};
/// Reads the optional fields controller, filter, physics, robot, seed, parameters. Throws
/// DocumentError.
RunOverrides overrides_from_json(const nlohmann::json& body);

/// A multiple of real time: 0 (as fast as possible) or 0.01 to 1000. Throws DocumentError.
double pace_from_json(const nlohmann::json& body, const char* key, double fallback);

/// Throws DocumentError naming an unknown field or one out of limits.
RunSpec make_spec(sim::Scenario scenario,
                  const RunOverrides& overrides,
                  const RobotLibrary& robots = RobotLibrary());

/// Builds the simulated world with all its robots, or opens the log. Throws std::exception with a
/// sentence for people.
std::unique_ptr<algo::Robot> make_robot(const RunSpec& spec);
algo::PipelineConfig pipeline_config(const RunSpec& spec);
const algo::ControllerCatalogue& controllers_of(const RunSpec& spec);
/// True if a controller outside the program drives the run.
bool drives_from_outside(const RunSpec& spec);

/// The scenario's waypoints and goal, in order.
std::vector<algo::SetGoal> way_of(const sim::Scenario& scenario);
/// The goals of a live robot. A loop without waypoints goes back to the start.
algo::SetGoals route_of(const sim::Scenario& scenario);
/// The scenario's goals as the requests that start the run; empty without one. A loop is driven
/// once: a run needs an end.
std::vector<algo::Request> first_requests(const RunSpec& spec);

/// [s] after which a headless run gives up: the scenario's limit, or 5 x straight line / v_max. A
/// log ends by itself and gets 0, no limit.
double time_limit(const RunSpec& spec);

/// The document in the run's database row: the scenario as run, and the robot's spec, from which
/// replay rebuilds the pipeline without a world. `others`, if any, are the scenario's other robots
/// as obstacles at their starts. `map`: the room on the map that it drives by. `answers`: the
/// frames hold the answers of a controller outside the program.
nlohmann::json run_document(const RunSpec& spec, const algo::RobotSpec& robot);
nlohmann::json to_json(const algo::RobotSpec& robot);
algo::RobotSpec robot_spec_from_json(const nlohmann::json& value);

}  // namespace server
