// server/experiment/barn_file.hpp: the worlds of the BARN and DynaBARN benchmarks as scenarios.
//
// Perille, Truong, Xiao, Stone: Benchmarking Metric Ground Navigation, SSRR 2020; Nair et al.:
// DynaBARN, SSRR 2022. The score is that of The BARN Challenge.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/pipeline/controllers.hpp"
#include "sim/scenario.hpp"

namespace server::barn {

struct World {
  std::uint64_t id = 0;
  algo::Pose2 start{};
  algo::Vec2 goal{0, 0};
  double goal_radius = 1;     // [m]
  double optimal_length = 0;  // [m] of the published path; used only for the score
  std::string difficulty{};   // such as "easy"; empty: the file does not say
  std::vector<algo::Obstacle> obstacles{};
};

/// `Flat`: the benchmark's scanner, which takes all beams at one instant. `Lms200`: the default
/// model, which fires its beams one by one while things move.
enum class Scanner : std::uint8_t { Flat, Lms200 };

/// Conditions of a run: limits and faults of the base and its scanner.
struct Conditions {
  bool stress = false;
  Scanner scanner = Scanner::Flat;
  sim::PhysicsKind physics = sim::PhysicsKind::Bullet;
  /// Replaces the benchmark's Jackal; brings its own scanners and limits.
  std::optional<sim::RobotModel> robot{};
  std::string controller{};  // empty: `strip`, or `strip_moving` if obstacles move
  /// In place of the benchmark's, as in RunOverrides.
  nlohmann::json parameters = nlohmann::json::object();
  double phase = 0;  // [s] into the obstacles' paths at the start of a run
  std::shared_ptr<const algo::ControllerCatalogue> controllers{};  // as in RunSpec
};

/// Throws DocumentError naming the field, or std::runtime_error if the file cannot be read.
std::vector<World> read_worlds(const std::string& file);
std::vector<World> worlds_from_json(const nlohmann::json& document);

/// Those of `worlds` with these numbers, in their order. Throws std::runtime_error naming a number
/// that none has.
std::vector<World> worlds_numbered(std::vector<World> worlds,
                                   const std::vector<std::uint64_t>& numbers);

sim::Scenario scenario_of(const World& world, const Conditions& conditions);

}  // namespace server::barn
