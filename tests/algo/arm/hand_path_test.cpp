// tests/algo/arm/hand_path_test.cpp: the hand on its path, and base and arm beside things.
#include "algo/arm/hand_path.hpp"

#include <array>
#include <numbers>

#include "tests/algo/allocations.hpp"
#include <gtest/gtest.h>

#include "algo/arm/arm_inverse.hpp"
#include "algo/arm/hand_path_planner.hpp"

namespace {

using algo::BodyJoints;
using algo::FollowState;
using algo::HandPath;
using algo::Solid;
using algo::Vec3;

constexpr double kPathTick = 0.05;  // [s]

Solid low_post(double x, double y, const algo::Vec2& velocity_W = algo::Vec2::Zero()) {
  Solid post;
  post.centre_W = {x, y};
  post.rounding = 0.08;
  post.bottom = 0;
  post.top = 0.5;
  post.velocity_W = velocity_W;
  return post;
}

/// A hand that begins right of the shoulder and points that way.
struct HandCourse {
  HandCourse() {
    algo::Pose3 hand = algo::Pose3::Identity();
    hand.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()).toRotationMatrix();
    hand.translation() = Vec3(0.1, -0.5, -0.05);
    start = algo::body_joints({}, best_arm_solution(body.arm, hand, body.folded)->q);
    from_W = body_frames(body, start).hand();
  }
  std::vector<BodyJoints> plan(const std::vector<Vec3>& ways, bool base_stays = false) const {
    std::vector<Vec3> points_W;
    for (const Vec3& way : ways) points_W.push_back(from_W + way);
    return plan_hand_path(body, start, points_W, base_stays, solids).path;
  }
  /// [m] Least, of the configurations of `plan`, to the standing solids.
  double planned_room(const std::vector<BodyJoints>& plan) const {
    double room = 1e9;
    for (const BodyJoints& q : plan) {
      room = std::min(room, clearance(body, body_frames(body, q), solids).smallest());
    }
    return room;
  }

  algo::MobileArm body{};
  BodyJoints start = BodyJoints::Zero();
  Vec3 from_W = Vec3::Zero();
  std::vector<Solid> solids{};
};

/// What came of a path that a body follows as commanded.
struct Followed {
  bool arrived = false;
  bool waited = false;
  double aside = 0;       // [m] of the hand from a line along x
  double room = 1e9;      // [m]
  double own_room = 1e9;  // [m]
  BodyJoints end = BodyJoints::Zero();
};
Followed follow(const HandCourse& course, const std::vector<BodyJoints>& plan) {
  HandPath path(course.body, {});
  path.begin(plan);
  const algo::BodyFollower guard(course.body, {}, {}, {.margin = 0.04});
  Followed out{.end = course.start};
  std::vector<Solid> solids = course.solids;
  for (double time = 0; time < 80 && !out.arrived; time += kPathTick) {
    std::vector<Solid> seen = solids;
    keep_ahead_free(seen);
    algo::BodyCommand command = path.update(out.end, seen, kPathTick);
    out.arrived = command.state == FollowState::Arrived;
    command = guard.kept_clear(out.end, command, seen, true);
    out.waited = out.waited || command.state == FollowState::Waits;
    out.end = moved(out.end, command, kPathTick);
    for (Solid& solid : solids) solid = solid.after(kPathTick);
    const algo::BodyFrames frames = body_frames(course.body, out.end);
    out.aside = std::max(out.aside, (frames.hand() - course.from_W).tail<2>().norm());
    out.room = std::min(out.room, clearance(course.body, frames, solids).smallest());
    out.own_room = std::min(out.own_room, self_clearance(course.body, frames));
  }
  return out;
}

TEST(HandPath, LeadsTheHandAlongItsLineAndTheBaseBesideIt) {
  const HandCourse course;
  const auto plan = course.plan({{2, 0, 0}});
  ASSERT_FALSE(plan.empty());
  const Followed out = follow(course, plan);
  EXPECT_TRUE(out.arrived);
  EXPECT_LT(out.aside, 0.005);
  EXPECT_GT(out.end[0], 1.0) << "the base has come along";
  EXPECT_GT(out.own_room, 0.01);
  const Vec3 hand_W = body_frames(course.body, out.end).hand();
  EXPECT_LT((hand_W - course.from_W - Vec3(2, 0, 0)).norm(), 0.005);
}

TEST(HandPath, TheBaseGoesRoundAPostOnEitherSideAndTheHandStaysOnItsLine) {
  for (const double y : {0.38, -0.45}) {
    HandCourse course;
    course.solids = {low_post(1.2, y)};
    const auto plan = course.plan({{2, 0, 0}});
    ASSERT_FALSE(plan.empty()) << y;
    EXPECT_GT(course.planned_room(plan), 0.05) << y;
    const Followed out = follow(course, plan);
    EXPECT_TRUE(out.arrived) << y;
    EXPECT_LT(out.aside, 0.005) << y;
    EXPECT_GT(out.room, 0.04) << y;
    EXPECT_GT(out.own_room, 0.01) << y;
  }
}

TEST(HandPath, WaitsForAPersonWhoCrossesAndGoesOn) {
  HandCourse course;
  const auto plan = course.plan({{2, 0, 0}});
  course.solids = {low_post(1.5, 2.5, {0, -0.1})};
  const Followed out = follow(course, plan);
  EXPECT_TRUE(out.waited);
  EXPECT_TRUE(out.arrived);
  EXPECT_GT(out.room, 0.04);
}

TEST(HandPath, TheArmAloneGoesWhereTheBaseStays) {
  const HandCourse course;
  const auto plan = course.plan({{0.15, 0, 0}, {0.15, 0, 0.1}}, true);
  ASSERT_FALSE(plan.empty());
  const Followed out = follow(course, plan);
  EXPECT_TRUE(out.arrived);
  EXPECT_EQ(out.end.head<3>(), course.start.head<3>());
}

TEST(HandPath, SaysHowFarTheHandGets) {
  HandCourse course;
  course.solids = {low_post(1.2, -0.05)};
  course.solids.front().rounding = 0.3;
  const std::vector<Vec3> points_W{course.from_W + Vec3(2, 0, 0)};
  const auto none = plan_hand_path(course.body, course.start, points_W, false, course.solids);
  EXPECT_TRUE(none.path.empty());
  EXPECT_NE(none.why.find("m of its path the hand gets no farther"), std::string::npos) << none.why;
}

TEST(HandPath, ATickAllocatesNothing) {
  HandCourse course;
  course.solids = {low_post(1.2, 0.38)};
  const auto plan = course.plan({{2, 0, 0}});
  HandPath path(course.body, {});
  path.begin(plan);
  const std::size_t before = allocations::count();
  for (int k = 0; k < 100; ++k) path.update(course.start, course.solids, kPathTick);
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
