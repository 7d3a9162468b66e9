#include "server/lab/reproduce/reach_world.hpp"

#include <numbers>

#include "sim/random.hpp"

namespace server::reproduce {
namespace {

using algo::Vec2;
using algo::Vec3;

constexpr std::uint64_t kReachPurpose = 0x4EAC;
constexpr double kPi = std::numbers::pi;

struct Heights {
  double bottom = 0;  // [m]
  double top = 0;     // [m]
};

algo::Solid block(const Vec2& centre_W, double length, double width, Heights z, double turned) {
  algo::Solid solid;
  solid.centre_W = centre_W;
  solid.axis_W = algo::direction(turned);
  solid.half = {length / 2, width / 2};
  solid.bottom = z.bottom;
  solid.top = z.top;
  return solid;
}

algo::Solid column(const Vec2& centre_W, double radius, Heights z) {
  algo::Solid solid;
  solid.centre_W = centre_W;
  solid.rounding = radius;
  solid.bottom = z.bottom;
  solid.top = z.top;
  return solid;
}

/// Pointing `down` from upwards [rad], to the side `aside` [rad].
algo::Pose3 hand_at(const Vec2& at, double z, double aside, double down) {
  algo::Pose3 hand = algo::Pose3::Identity();
  hand.linear() = (Eigen::AngleAxisd(aside, Vec3::UnitZ()) * Eigen::AngleAxisd(down, Vec3::UnitY()))
                      .toRotationMatrix();
  hand.translation() = Vec3(at.x(), at.y(), z);
  return hand;
}

double any_angle(sim::Random& random) {
  return random.uniform(0, 2 * kPi);
}
/// Within a quarter of a radian of the horizontal.
double about_level(sim::Random& random) {
  return kPi / 2 + random.uniform(-0.25, 0.25);
}

/// Where the scene stands, and which way it is turned.
struct ReachSite {
  Vec2 at = Vec2::Zero();
  double turned = 0;  // [rad]

  Vec2 along() const { return algo::direction(turned); }
  Vec2 across() const { return algo::direction(turned + kPi / 2); }
};

/// The goal lies over the far half of a table top, on which posts stand.
void lay_table(const ReachSite& site, sim::Random& random, ReachWorld& world) {
  constexpr Heights kTop{0.70, 0.74};
  constexpr double kPostTop = 1.1;
  world.solids.push_back(block(site.at, 1.2, 0.7, kTop, site.turned));
  for (int k = 0; k < 3; ++k) {
    const Vec2 post = site.at + random.uniform(0.2, 0.4) * algo::direction(any_angle(random));
    world.solids.push_back(column(post, 0.05, {kTop.top, kPostTop}));
  }
  const double z = kTop.top + random.uniform(0.12, 0.32);
  const double down = kPi * random.uniform(0.55, 1.0);
  world.hand_W = hand_at(site.at + 0.25 * site.across(), z, any_angle(random), down);
}

/// The goal lies between two boards, before a wall; the hand points at the wall.
void lay_shelf(const ReachSite& site, sim::Random& random, ReachWorld& world) {
  constexpr double kBoard = 0.02;
  for (const double z : {0.5, 0.9, 1.3}) {
    world.solids.push_back(block(site.at, 0.4, 1.0, {z - kBoard, z}, site.turned));
  }
  const Vec2 wall = site.at + 0.2 * site.along();
  world.solids.push_back(block(wall, kBoard, 1.0, {0, 1.5}, site.turned));
  const Vec2 goal = site.at - 0.05 * site.along() + random.uniform(-0.2, 0.2) * site.across();
  world.hand_W = hand_at(goal, 1.1, site.turned, kPi / 2);
}

/// The goal lies among four posts.
void lay_posts(const ReachSite& site, sim::Random& random, ReachWorld& world) {
  constexpr Heights kTall{0, 1.6};
  for (int k = 0; k < 4; ++k) {
    const Vec2 post = site.at + random.uniform(0.25, 0.55) * algo::direction(any_angle(random));
    world.solids.push_back(column(post, random.uniform(0.04, 0.10), kTall));
  }
  const double z = random.uniform(0.7, 1.1);
  world.hand_W = hand_at(site.at, z, any_angle(random), about_level(random));
}

/// The goal lies under and behind a beam, between two posts.
void lay_beam(const ReachSite& site, sim::Random& random, ReachWorld& world) {
  constexpr double kAway = 0.25;     // [m] from the goal
  constexpr double kPostAway = 0.4;  // [m]
  constexpr double kPostTurned = 2;  // [rad] from the beam
  const Vec2 beam = site.at + kAway * site.along();
  world.solids.push_back(block(beam, 0.1, 1.6, {1.0, 1.1}, site.turned));
  for (const double turned : {kPostTurned, -kPostTurned}) {
    const Vec2 post = site.at + kPostAway * algo::direction(site.turned + turned);
    world.solids.push_back(column(post, 0.06, {0, 1.4}));
  }
  const double z = random.uniform(0.75, 0.95);
  world.hand_W = hand_at(site.at, z, any_angle(random), about_level(random));
}

}  // namespace

std::string_view words(ReachScene scene) {
  switch (scene) {
    case ReachScene::Table:
      return "a table with posts on it";
    case ReachScene::Shelf:
      return "a shelf";
    case ReachScene::Posts:
      return "among posts";
    case ReachScene::Beam:
      return "under a beam";
  }
  return "";
}

ReachWorld random_world(ReachScene scene, std::uint64_t seed) {
  sim::Random random(seed, kReachPurpose + static_cast<std::uint64_t>(scene));
  ReachWorld world;
  ReachSite site;
  site.at.x() = random.uniform(3, 4);
  site.at.y() = random.uniform(-1, 1);
  site.turned = any_angle(random);
  switch (scene) {
    case ReachScene::Table:
      lay_table(site, random, world);
      break;
    case ReachScene::Shelf:
      lay_shelf(site, random, world);
      break;
    case ReachScene::Posts:
      lay_posts(site, random, world);
      break;
    case ReachScene::Beam:
      lay_beam(site, random, world);
      break;
  }
  for (int k = 0; k < 2; ++k) {
    const double x = random.uniform(1, 2);
    const double y = random.uniform(-1, 1);
    world.solids.push_back(column({x, y}, random.uniform(0.1, 0.2), {0, 1.2}));
  }
  return world;
}

}  // namespace server::reproduce
