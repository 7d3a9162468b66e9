#include "server/lab/reproduce/arm_course.hpp"

#include <algorithm>
#include <stdexcept>

#include "algo/arm/arm_inverse.hpp"
#include "sim/random.hpp"

namespace server::reproduce {
namespace {

constexpr std::uint64_t kArmPurpose = 0xA43;
constexpr double kBesideBase = 0.65;  // [m] from the base's path to the nearest surface of a solid
constexpr double kOutwards = 0.6;     // [m] their centres lie up to this much farther
constexpr double kFastest = 0.3;      // [m/s]
constexpr double kFree = 0.3;         // [m] of the arm at start and goal
constexpr double kDuration = 9;       // [s] of a drive, about

bool leaves_ends_free(const ArmCarried& carried, const algo::Solid& solid) {
  const auto room = [&](const algo::BodyJoints& q, double time) {
    const std::array one{solid.after(time)};
    return clearance(carried.body, body_frames(carried.body, q), one).smallest();
  };
  return room(carried.path.front(), 0) > kFree && room(carried.path.back(), kDuration) > kFree;
}

}  // namespace

ArmCarried carried_arm(double reach) {
  ArmCarried carried;
  algo::Pose3 hand = algo::Pose3::Identity();
  hand.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;  // the tool points to the right
  hand.translation() = algo::Vec3(0, -reach, 0);
  const auto q = best_arm_solution(carried.body.arm, hand, algo::ArmJoints::Constant(0.3));
  if (!q) throw std::invalid_argument("The arm does not reach so far.");
  carried.path.assign(ArmCarried::kConfigurations, algo::body_joints({}, q->q));
  for (std::size_t i = 0; i < carried.path.size(); ++i) {
    carried.path[i][0] =
        ArmCarried::kWay * static_cast<double>(i) / static_cast<double>(carried.path.size() - 1);
  }
  carried.hand_y = body_frames(carried.body, carried.path.front()).hand().y();
  return carried;
}

algo::Solid post_at(const algo::Vec2& centre_W, const algo::Vec2& velocity_W) {
  algo::Solid post;
  post.centre_W = centre_W;
  post.velocity_W = velocity_W;
  post.rounding = kPostRadius;
  post.bottom = 0;
  post.top = kPostTop;
  return post;
}

std::vector<ArmCourse> arm_courses(const ArmCarried& carried) {
  const double y = carried.hand_y;
  return {
      {"a post stands", {post_at({2, y + 0.1})}},
      {"three stand", {post_at({1, y + 0.1}), post_at({2, y - 0.05}), post_at({3, y + 0.2})}},
      {"a post comes towards the arm", {post_at({4, y + 0.1}, {-0.3, 0})}},
      {"a post is overtaken", {post_at({1, y + 0.1}, {0.3, 0})}},
      {"a post crosses from the right", {post_at({2, y - 1.2}, {0, 0.3})}},
      {"a post leaves to the right", {post_at({1.5, y + 0.25}, {0, -0.3})}},
      {"three move",
       {post_at({3, y + 0.1}, {-0.3, 0}),
        post_at({2, y - 1.0}, {0, 0.2}),
        post_at({3, y - 0.6}, {-0.1, 0.1})}},
  };
}

std::string_view words(ArmTrialKind kind) {
  switch (kind) {
    case ArmTrialKind::Standing:
      return "standing";
    case ArmTrialKind::Along:
      return "moving along the way";
    case ArmTrialKind::Anywhere:
      return "moving anywhere but into the base";
  }
  return "";
}

std::vector<algo::Solid> random_solids(const ArmCarried& carried,
                                       ArmTrialKind kind,
                                       std::uint64_t seed) {
  sim::Random random(seed, kArmPurpose + static_cast<std::uint64_t>(kind));
  std::vector<algo::Solid> solids;
  const int count = 1 + static_cast<int>(3 * random.uniform());
  for (int k = 0; k < count; ++k) {
    algo::Solid solid = post_at({random.uniform(0.8, 3.2), 0});
    solid.rounding = random.uniform(0.05, 0.20);
    solid.centre_W.y() = -kBesideBase - solid.rounding - kOutwards * random.uniform();
    if (random.uniform() < 0.5) solid.top = random.uniform(0.9, 1.4);
    if (random.uniform() < 0.2) {
      solid.bottom = 1.0;  // a beam at the arm's height
      solid.top = 1.3;
    }
    if (kind == ArmTrialKind::Along) solid.velocity_W = {random.uniform(-kFastest, kFastest), 0};
    if (kind == ArmTrialKind::Anywhere) {
      const algo::Vec2 way = algo::direction(random.uniform(0, 2 * std::numbers::pi));
      solid.velocity_W = random.uniform(0, kFastest) * algo::Vec2(way.x(), -std::abs(way.y()));
    }
    if (leaves_ends_free(carried, solid)) solids.push_back(solid);
  }
  return solids;
}

}  // namespace server::reproduce
