// server/lab/soak/slope_world.cpp: a profile of facets, laid out as ramps.
#include "server/lab/soak/slope_world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "algo/units.hpp"
#include "server/run/robot_library.hpp"
#include "sim/random.hpp"
#include "sim/robot_model.hpp"

namespace server::soak {
namespace {

using namespace algo::units;

constexpr std::uint64_t kSlopePurpose = 0x510E;
constexpr double kFold = 2_deg;      // at most, between two facets
constexpr double kSlopeWidth = 100;  // [m] across: more than a drive
constexpr double kPlateau = 6;       // [m] of the steepest facet
constexpr double kTopLength = 3;     // [m] of a level top
constexpr double kBeforeFoot = 2;    // [m] from the robot to the foot

/// Facets from the slope `from` to `to`, without either, in even folds.
void bend(std::vector<Facet>& facets, double from, double to, sim::Random& random) {
  const double folds = std::ceil(std::abs(to - from) / kFold - 1e-9);
  for (double k = 1; k < folds; ++k) {
    facets.push_back({random.uniform(0.5, 1.2), std::lerp(from, to, k / folds)});
  }
}

}  // namespace

std::vector<algo::Obstacle> ridge(const algo::Pose2& foot_W,
                                  std::span<const Facet> facets,
                                  double width) {
  std::vector<algo::Obstacle> out;
  double x = 0;
  double z = 0;
  for (const Facet& facet : facets) {
    const double end = std::max(0.0, z + facet.length * std::tan(facet.slope));
    algo::Obstacle& piece = out.emplace_back();
    piece.id = static_cast<std::uint32_t>(out.size());
    // A ramp rises along its x axis.
    const double turn = end < z ? std::numbers::pi : 0;
    piece.pose_W = algo::compose(foot_W, {x + facet.length / 2, 0, turn});
    piece.shape = algo::Ramp{facet.length, width, std::min(z, end)};
    piece.height = std::max(z, end);
    x += facet.length;
    z = end;
  }
  return out;
}

std::string_view name(SlopeKind kind) {
  switch (kind) {
    case SlopeKind::Slope:
      return "slope";
    case SlopeKind::Bank:
      return "bank";
    default:
      return "crest";
  }
}

SlopeWorld slope_world(std::uint64_t seed) {
  sim::Random random(seed, kSlopePurpose);
  SlopeWorld world;
  world.kind = static_cast<SlopeKind>(std::min(2.0, std::floor(3 * random.uniform())));
  world.steepest = random.uniform(3, 12) * kRadiansPerDegree;
  world.friction = random.uniform(0.5, 1);

  std::vector<Facet> facets;
  bend(facets, 0, world.steepest, random);
  const std::size_t plateau = facets.size();
  facets.push_back({kPlateau, world.steepest});
  const bool crest = world.kind == SlopeKind::Crest;
  bend(facets, world.steepest, crest ? -world.steepest : 0, random);
  if (!crest) {
    facets.push_back({kTopLength, 0});
    bend(facets, 0, -world.steepest, random);
  }
  // Down again to the floor, by the facets of the way up in reverse.
  double height = 0;
  for (const Facet& facet : facets) height += facet.length * std::tan(facet.slope);
  double foot = 0;
  for (std::size_t k = 0; k < plateau; ++k) foot += facets[k].length * std::tan(facets[k].slope);
  facets.push_back({(height - foot) / std::tan(world.steepest), -world.steepest});
  for (std::size_t k = plateau; k-- > 0;) facets.push_back({facets[k].length, -facets[k].slope});

  double before = 0;  // [m] from the foot to the plateau
  for (std::size_t k = 0; k < plateau; ++k) before += facets[k].length;
  double top = 0;  // [m] from the foot to where the way down begins
  for (const Facet& facet : facets) {
    if (facet.slope < 0) break;
    top += facet.length;
  }
  const double across = random.uniform() < 0.5 ? -std::numbers::pi / 2 : std::numbers::pi / 2;
  algo::Pose2 start{-kBeforeFoot, 0, random.uniform(-0.5, 0.5)};
  if (world.kind == SlopeKind::Bank) {
    start = {before + kPlateau / 2, 0, across + random.uniform(-0.3, 0.3)};
  }
  if (crest) start = {top, 0, random.uniform(-std::numbers::pi, std::numbers::pi)};
  const algo::Pose2 foot_W{0, 0, random.uniform(-std::numbers::pi, std::numbers::pi)};

  sim::Scenario& scenario = world.scenario;
  scenario.name = "slopes";
  scenario.robot = builtin_robot("robhaz_tall");
  scenario.obstacles = ridge(foot_W, facets, kSlopeWidth);
  scenario.start = algo::compose(foot_W, start);
  world.believed = sim::stance_of(scenario.robot);
  scenario.robot.mass_height *= random.uniform(0.9, 1.1);
  scenario.robot.friction = world.friction;
  world.margin = std::atan2(world.believed.width, 2 * scenario.robot.mass_height) - world.steepest;
  return world;
}

}  // namespace server::soak
