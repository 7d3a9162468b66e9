// server/lab/reproduce/conditions.cpp: paper.json `common` as a scenario of the simulator.
#include "server/lab/reproduce/conditions.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "algo/filter/filter.hpp"
#include "algo/strip/strip_law.hpp"
namespace server::reproduce {
namespace {

/// Every beam from the pose at the tick; uniform noise on returns only, none on the others. Ranges
/// come in whole millimetres, as from the device: the one thing the prototype had not.
sim::LaserConfig paper_scanner(const PaperConditions& common, bool noise) {
  sim::LaserConfig laser = sim::LaserConfig::ideal(0.5);
  laser.range_max = common.range_max;
  laser.noise = noise ? common.noise : 0;
  laser.noise_shape = sim::NoiseShape::Uniform;
  return laser;
}

double period_of(const PaperConditions& common, double v_max) {
  constexpr double kSame = 1e-9;  // [m/s]
  const bool slow = common.slow && std::abs(common.slow->v_max - v_max) < kSame;
  return slow ? common.slow->period : common.period;
}

sim::Scenario scenario_of(const PaperFile& file,
                          const Layout& layout,
                          const Conditions& conditions) {
  const PaperConditions& common = file.common;
  sim::Scenario scenario;
  scenario.name = layout.name;
  scenario.title = layout.source;
  scenario.vehicle = conditions.base ? sim::Vehicle::Bullet : sim::Vehicle::Kinematic;
  if (!conditions.fast_period) scenario.period = period_of(common, layout.v_max);
  if (!conditions.scanner) scenario.lasers = {paper_scanner(common, conditions.noise)};
  scenario.start = common.start;
  const algo::Vec2 way = layout.goal_W - common.start.position();
  if (common.start_faces_goal) scenario.start.heading = std::atan2(way.y(), way.x());
  scenario.goal = algo::SetGoal{layout.goal_W, std::nullopt};
  scenario.obstacles = layout.obstacles;
  scenario.filter = common.filter;
  scenario.parameters = {{&algo::kContractionGain, layout.contraction_gain},
                         {&algo::kRepulsionGain, layout.repulsion_gain},
                         {&algo::kSafetyDistance, common.safety_distance},
                         {&algo::kStripStep, common.strip_step},
                         {&algo::kMaxSpeed, layout.v_max},
                         {&algo::kMaxTurnRate, common.max_turn_rate},
                         {&algo::kHeadingGain, common.heading_gain},
                         {&algo::kGoalReach, common.arrival_radius},
                         {&algo::kFilterHalfWidth, static_cast<double>(common.filter_half_width)}};
  scenario.time_limit = std::max(1e-3, common.time_limit_factor * way.norm() / layout.v_max);
  return scenario;
}

}  // namespace

RunSpec make_run(const PaperFile& file,
                 const Layout& layout,
                 std::string_view reading,
                 const Conditions& conditions,
                 std::uint64_t seed) {
  RunOverrides overrides;
  overrides.controller = std::string(reading);
  overrides.seed = seed;
  return make_spec(scenario_of(file, layout, conditions), overrides);
}

void check_layouts(const PaperFile& file) {
  for (std::size_t i = 0; i < file.layouts.size(); ++i) {
    try {
      for (const Conditions& conditions : {kPaper, kFullSimulator}) {
        make_robot(make_run(file, file.layouts[i], readings().front(), conditions, 1));
      }
    } catch (const std::exception& e) {
      throw std::runtime_error(
          fmt::format("scenarios/{} ({}): {}", i, file.layouts[i].name, e.what()));
    }
  }
}

}  // namespace server::reproduce
