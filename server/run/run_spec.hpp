// server/run/run_spec.hpp: everything that decides how a run goes, and the robot and pipeline from
// it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/pipeline/pipeline.hpp"
#include "algo/robot.hpp"
#include "server/run/robot_library.hpp"
#include "sim/scenario.hpp"

namespace server {

struct Hardware;

/// Same spec, same run, bit for bit. Controller, filter and physics are the scenario's own.
struct RunSpec {
  sim::Scenario scenario{};
  algo::Parameters parameters{};
  std::uint64_t seed = 1;
  /// Real devices to run on, instead of a world; they outlive the run.
  std::shared_ptr<const Hardware> hardware{};
};

/// "simulation", "replay" or "hardware".
const char* source_of(const RunSpec& spec);
/// "bullet", "kinematic", "log" or "hardware".
const char* physics_of(const RunSpec& spec);

/// What a caller may put in place of the scenario's own choices; read from JSON or flags.
struct RunOverrides {
  std::optional<std::string> controller{};
  std::optional<std::string> filter{};
  std::optional<sim::PhysicsKind> physics{};
  /// As for choose_robot(); null: as the scenario has it.
  nlohmann::json robot{};
  std::optional<std::uint64_t> seed{};
  nlohmann::json parameters = nlohmann::json::object();
};
/// Reads the optional fields controller, filter, physics, robot, seed, parameters. Throws
/// DocumentError.
RunOverrides overrides_from_json(const nlohmann::json& body);

/// Times real time: 0 (as fast as it goes) or 0.01 to 1000. Throws DocumentError.
double pace_from_json(const nlohmann::json& body, const char* key, double fallback);

/// Throws DocumentError naming the field that is unknown or out of limits.
RunSpec make_spec(sim::Scenario scenario,
                  const RunOverrides& overrides,
                  const RobotLibrary& robots = RobotLibrary());

/// Builds the simulated world, with all its robots, or opens the log. Throws std::exception with a
/// sentence.
std::unique_ptr<algo::Robot> make_robot(const RunSpec& spec);
algo::PipelineConfig pipeline_config(const RunSpec& spec);

/// The scenario's goal as the request that starts the run; empty without one.
std::vector<algo::Request> first_requests(const RunSpec& spec);

/// [s] after which a headless run gives up: the scenario's, or 5 x straight line / v_max. 0, none,
/// for a log, which has its own end.
double time_limit(const RunSpec& spec);

/// The run row's document: the scenario as run, and the robot's spec, from which replay rebuilds
/// the pipeline without a world; `others` are the scenario's other robots as obstacles at their
/// starts, where there are any.
nlohmann::json run_document(const RunSpec& spec, const algo::RobotSpec& robot);
nlohmann::json to_json(const algo::RobotSpec& robot);
algo::RobotSpec robot_spec_from_json(const nlohmann::json& value);

}  // namespace server
