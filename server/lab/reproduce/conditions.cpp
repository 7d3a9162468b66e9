// server/lab/reproduce/conditions.cpp: applies the papers' conditions to a scenario.
#include "server/lab/reproduce/conditions.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "algo/driving.hpp"
#include "algo/filter/filter.hpp"
#include "algo/strip/strip_law.hpp"

namespace server::reproduce {
namespace {

/// All beams start from the pose at the tick. Uniform noise on returns only. Ranges are in whole
/// millimetres, as from the device; only this differs from the prototype.
sim::LaserConfig paper_scanner(const PaperConditions& paper, bool noise) {
  sim::LaserConfig laser = sim::LaserConfig::ideal(0.5);
  laser.range_max = paper.range_max;
  laser.noise = noise ? paper.noise : 0;
  laser.noise_shape = sim::NoiseShape::Uniform;
  return laser;
}

double period_of(const PaperConditions& paper, double v_max) {
  constexpr double kSame = 1e-9;  // [m/s]
  const bool slow = paper.slow && std::abs(paper.slow->v_max - v_max) < kSame;
  return slow ? paper.slow->period : paper.period;
}

sim::Scenario under(const PaperConditions& paper,
                    sim::Scenario scenario,
                    const Conditions& conditions) {
  const double v_max = scenario.parameters[algo::kMaxSpeed];
  scenario.physics = conditions.base ? sim::PhysicsKind::Bullet : sim::PhysicsKind::Kinematic;
  if (!conditions.fast_period) scenario.period = period_of(paper, v_max);
  if (!conditions.scanner) scenario.robot.sensors.lasers = {paper_scanner(paper, conditions.noise)};
  scenario.filter = paper.filter;
  algo::Parameters& parameters = scenario.parameters;
  parameters.set(algo::kSafetyDistance, paper.safety_distance);
  parameters.set(algo::kStripStep, paper.strip_step);
  parameters.set(algo::kMaxTurnRate, paper.max_turn_rate);
  parameters.set(algo::kHeadingGain, paper.heading_gain);
  parameters.set(algo::kGoalReach, paper.arrival_radius);
  parameters.set(algo::kFilterHalfWidth, paper.filter_half_width);
  const double way = (scenario.goal->position_W - scenario.start.position()).norm();
  scenario.time_limit = std::max(1e-3, paper.time_limit_factor * way / v_max);
  return scenario;
}

}  // namespace

RunSpec make_run(const PaperConditions& paper,
                 const sim::Scenario& scenario,
                 std::string_view reading,
                 const Conditions& conditions,
                 std::uint64_t seed) {
  RunOverrides overrides;
  overrides.controller = std::string(reading);
  overrides.seed = seed;
  return make_spec(under(paper, scenario, conditions), overrides);
}

void check_scenarios(const StudyFile& file) {
  for (std::size_t i = 0; i < file.scenarios.size(); ++i) {
    try {
      for (const Conditions& conditions : {kPaper, kFullSimulator}) {
        make_robot(make_run(file.conditions, file.scenarios[i], readings().front(), conditions, 1));
      }
    } catch (const std::exception& e) {
      throw std::runtime_error(
          fmt::format("scenarios/{} ({}): {}", i, file.scenarios[i].name, e.what()));
    }
  }
}

}  // namespace server::reproduce
