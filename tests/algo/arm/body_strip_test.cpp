// tests/algo/arm/body_strip_test.cpp: the strip of arm and base: its forces, what it clears, and
// that it comes back.
#include "algo/arm/body_strip.hpp"

#include <random>

#include "tests/algo/allocations.hpp"
#include "tests/algo/arm/carried_arm.hpp"
#include <gtest/gtest.h>

namespace {

using algo::BodyJoints;
using algo::BodyStrip;
using algo::MobileArm;
using algo::Solid;

constexpr int kToRest = 6000;  // sweeps

/// The least over all configurations and those between them, by which the body would move.
double strip_clearance(const MobileArm& body,
                       std::span<const BodyJoints> strip,
                       std::span<const Solid> solids) {
  constexpr int kBetween = 10;
  double least = 1e9;
  for (std::size_t i = 0; i + 1 < strip.size(); ++i) {
    for (int k = 0; k <= kBetween; ++k) {
      const BodyJoints q = strip[i] + (strip[i + 1] - strip[i]) * k / kBetween;
      least = std::min(least, clearance(body, body_frames(body, q), solids).smallest());
    }
  }
  return least;
}

TEST(MobileArm, AForceMovesWhatItsJacobianSays) {
  const MobileArm body;
  std::mt19937 random{11};
  std::uniform_real_distribution<double> unit{-1, 1};
  constexpr double kStep = 1e-6;
  for (int n = 0; n < 50; ++n) {
    BodyJoints q;
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = 1.5 * unit(random);
    const auto frames = body_frames(body, q);
    for (std::size_t k = 0; k < algo::kBodyLinks; ++k) {
      const auto which = static_cast<algo::BodyLink>(k);
      const auto link = link_axis(body, frames, which);
      const double along = (unit(random) + 1) / 2;
      const algo::Vec3 p = link.from_W + along * (link.to_W - link.from_W);
      const algo::Vec3 force(unit(random), unit(random), unit(random));
      BodyJoints generalized = BodyJoints::Zero();
      add_force(frames, link.joints, p, force, generalized);
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        const auto moved = [&](double step) -> algo::Vec3 {
          BodyJoints other = q;
          other[i] += step;
          const auto there = link_axis(body, body_frames(body, other), which);
          return there.from_W + along * (there.to_W - there.from_W);
        };
        const algo::Vec3 way = (moved(kStep) - moved(-kStep)) / (2 * kStep);
        EXPECT_NEAR(generalized[i], force.dot(way), 1e-8) << name(which) << " " << i;
      }
    }
  }
}

TEST(MobileArm, TheBaseIsAnUprightCylinder) {
  const MobileArm body;
  const auto frames = body_frames(body, BodyJoints::Zero());
  const auto base = link_axis(body, frames, algo::BodyLink::Base);
  Solid table;
  table.half = {2, 2};
  table.bottom = 0.70;
  table.top = 0.74;
  EXPECT_NEAR(nearest(base, table).distance, 0.70 - body.base_height, 1e-12);
  Solid post;
  post.centre_W = {1, 0};
  post.rounding = 0.1;
  EXPECT_NEAR(nearest(base, post).distance, 1 - 0.1 - body.base_radius, 1e-12);
}

TEST(MobileArm, AnArmThatHangsThroughItsBaseTouchesItself) {
  const MobileArm body;
  EXPECT_LT(self_clearance(body, body_frames(body, BodyJoints::Zero())), 0);
  EXPECT_GT(self_clearance(body, body_frames(body, carried_arm::stretched_aside(0.70))), 0);
}

TEST(BodyStrip, TheArmYieldsToAPostAndTheBaseStays) {
  const MobileArm body;
  // The post stands before the hand, the wrist or the forearm.
  for (const double inside : {0.0, 0.1, 0.2}) {
    for (const double stretched : {0.65, 0.729}) {
      const auto nominal = carried_arm::straight_path(stretched);
      const std::array post{carried_arm::post_before_arm(stretched, inside)};
      BodyStrip strip(body);
      strip.lay(nominal);
      ASSERT_LT(strip_clearance(body, strip.configurations(), post), 0);
      strip.relax(post, kToRest);
      EXPECT_GT(strip_clearance(body, strip.configurations(), post), 0.2)
          << inside << " of " << stretched;
      for (std::size_t i = 0; i < nominal.size(); ++i) {
        // Where the post comes near the base itself, the base yields as well.
        EXPECT_LT((strip.configurations()[i] - nominal[i]).head<2>().norm(),
                  inside == 0 ? 0.01 : 0.05);
        EXPECT_GT(self_clearance(body, strip.frames()[i]), 0);
      }
    }
  }
}

TEST(BodyStrip, ThePrintedForcesLetThePostThroughBetweenConfigurations) {
  const MobileArm body;
  const std::array post{carried_arm::post_before_arm(0.70, 0.05)};
  BodyStrip strip(body, algo::printed_gains());
  strip.lay(carried_arm::straight_path(0.70));
  strip.relax(post, kToRest);
  EXPECT_LT(strip_clearance(body, strip.configurations(), post), -0.1);
}

TEST(BodyStrip, ReturnsWhenThePostIsGone) {
  const auto nominal = carried_arm::straight_path(0.65);
  const std::array post{carried_arm::post_before_arm(0.65, 0.1)};
  BodyStrip strip{MobileArm{}};
  strip.lay(nominal);
  strip.relax(post, kToRest);
  strip.relax({}, kToRest);
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    EXPECT_LT((strip.configurations()[i] - nominal[i]).cwiseAbs().maxCoeff(), 0.01);
  }
}

TEST(BodyStrip, WhereTheBaseStandsTheArmKeepsToItsWayAndYieldsToWhatMoves) {
  const MobileArm body;
  const BodyJoints from = carried_arm::stretched_aside(0.70);
  const BodyJoints to = carried_arm::stretched_aside(0.60);
  std::vector<BodyJoints> way;
  for (int i = 0; i <= 4; ++i) way.push_back(from + (to - from) * i / 4.0);
  Solid post = carried_arm::post_before_arm(0.70, 0);
  post.centre_W.x() = 0.34;  // 0.20 m from the arm
  BodyStrip strip(body);
  strip.lay(way);
  ASSERT_TRUE(strip.stands());
  // The base stands a little off its place, which is no way to drive.
  BodyJoints now = from;
  now[0] += 0.004;
  strip.follow(now, 0.1);
  strip.relax(std::array{post}, 100);
  for (std::size_t i = 1; i < way.size(); ++i) {
    EXPECT_LT((strip.configurations()[i] - way[i]).cwiseAbs().maxCoeff(), 1e-3) << i;
  }
  post.velocity_W = {-0.01, 0};
  strip.relax(std::array{post}, 100);
  EXPECT_GT((strip.configurations()[2] - way[2]).cwiseAbs().maxCoeff(), 0.05);
}

TEST(BodyStrip, KeepsItsEndsAndTheJointsLimits) {
  const MobileArm body;
  const auto nominal = carried_arm::straight_path(0.70);
  const std::array post{carried_arm::post_before_arm(0.70, 0.3)};
  BodyStrip strip(body);
  strip.lay(nominal);
  for (int n = 0; n < 50; ++n) {
    strip.relax(post, 20);
    EXPECT_EQ(strip.configurations().front(), nominal.front());
    EXPECT_EQ(strip.configurations().back(), nominal.back());
    for (const BodyJoints& q : strip.configurations()) {
      EXPECT_GE(limit_margin(body.arm, algo::arm_of(q)), 0);
      EXPECT_TRUE(q.allFinite());
    }
  }
}

TEST(BodyStrip, ASweepAllocatesNothing) {
  const std::array post{carried_arm::post_before_arm(0.70, 0.1)};
  BodyStrip strip{MobileArm{}};
  strip.lay(carried_arm::straight_path(0.70));
  const auto before = allocations::count();
  strip.relax(post, 20);
  EXPECT_EQ(allocations::count(), before);
}

TEST(BodyStrip, NeedsAStartAndAGoal) {
  BodyStrip strip{MobileArm{}};
  const std::array one{BodyJoints{BodyJoints::Zero()}};
  EXPECT_THROW(strip.lay(one), std::invalid_argument);
}

}  // namespace
