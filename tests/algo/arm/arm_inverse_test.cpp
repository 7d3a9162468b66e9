// tests/algo/arm/arm_inverse_test.cpp: the arm's inverse against its chain, at random poses.
#include "algo/arm/arm_inverse.hpp"

#include <limits>
#include <numbers>
#include <random>

#include "tests/algo/allocations.hpp"
#include <gtest/gtest.h>

#include "algo/arm/arm_chain.hpp"

namespace {

using algo::ArmBranch;
using algo::ArmGeometry;
using algo::ArmJoints;

class RandomArm {
 public:
  explicit RandomArm(double elbow_offset = 0) { geometry.elbow_offset = elbow_offset; }

  ArmJoints joints(double part = 1) {
    ArmJoints q;
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = part * geometry.limits[i] * unit_(random_);
    return q;
  }
  double angle() { return std::numbers::pi * unit_(random_); }

  ArmGeometry geometry;

 private:
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> unit_{-1, 1};
};

double apart(const algo::Pose3& a, const algo::Pose3& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

TEST(ArmInverse, EveryBranchBringsTheHandToThePose) {
  constexpr int kPoses = 100'000;
  for (const double offset : {0.0, 0.04}) {
    RandomArm arm(offset);
    double worst = 0;
    for (int n = 0; n < kPoses / 2; ++n) {
      const auto hand = arm_frames(arm.geometry, arm.joints()).hand();
      const double psi = arm.angle();
      for (std::uint8_t bits = 0; bits < ArmBranch::kCount; ++bits) {
        const auto q = arm_inverse(arm.geometry, hand, psi, {bits});
        ASSERT_TRUE(q);
        worst = std::max(worst, apart(arm_frames(arm.geometry, *q).hand(), hand));
      }
    }
    EXPECT_LT(worst, 1e-9);
  }
}

TEST(ArmInverse, FindsTheJointsOfAPoseAgain) {
  for (const double offset : {0.0, 0.04}) {
    RandomArm arm(offset);
    for (int n = 0; n < 2000; ++n) {
      const ArmJoints q = arm.joints();
      const auto frames = arm_frames(arm.geometry, q);
      const auto psi = arm_angle(arm.geometry, frames);
      ASSERT_TRUE(psi);
      const auto again = arm_inverse(arm.geometry, frames.hand(), *psi, branch_of(arm.geometry, q));
      ASSERT_TRUE(again);
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        EXPECT_NEAR(algo::wrap_angle((*again)[i] - q[i]), 0, 1e-7) << "joint " << i + 1;
      }
    }
  }
}

TEST(ArmInverse, KeepsTheArmAngle) {
  RandomArm arm;
  for (int n = 0; n < 1000; ++n) {
    const auto hand = arm_frames(arm.geometry, arm.joints()).hand();
    const double psi = arm.angle();
    const auto q = arm_inverse(arm.geometry, hand, psi, {});
    const auto held = arm_angle(arm.geometry, arm_frames(arm.geometry, q.value()));
    EXPECT_NEAR(algo::wrap_angle(held.value() - psi), 0, 1e-9);
  }
}

TEST(ArmInverse, AStretchedArmKeepsTheJointsThatAreFree) {
  const ArmGeometry geometry;
  ArmJoints q = ArmJoints::Zero();
  q[0] = 0.4;  // the arm hangs straight down: joint 1 turns with 3, 5 and 7
  const auto hand = arm_frames(geometry, q).hand();
  EXPECT_FALSE(arm_angle(geometry, arm_frames(geometry, q)));
  const auto again = arm_inverse(geometry, hand, 0, {}, q);
  ASSERT_TRUE(again);
  EXPECT_NEAR((*again)[0], q[0], 1e-12);
  EXPECT_LT(apart(arm_frames(geometry, *again).hand(), hand), 1e-9);
}

TEST(ArmInverse, RefusesInWords) {
  const ArmGeometry geometry;
  algo::Pose3 hand = algo::Pose3::Identity();
  hand.translation() = algo::Vec3(2, 0, 0);
  EXPECT_EQ(unreachable(geometry, hand),
            "The wrist would be 2.006 m from the shoulder, and the farthest it can be is 0.580 m.");
  hand.translation() = algo::Vec3(0, 0, 0.15);
  EXPECT_EQ(unreachable(geometry, hand),
            "The wrist would be 0.000 m from the shoulder, and the nearest it can be is 0.020 m.");
  hand.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(unreachable(geometry, hand), "The pose of the hand is no position and rotation.");
  EXPECT_FALSE(arm_inverse(geometry, hand, 0, {}));
  hand = arm_frames(geometry, ArmJoints::Constant(0.5)).hand();
  hand.linear() *= 2;
  EXPECT_EQ(unreachable(geometry, hand), "The pose of the hand is no position and rotation.");

  ArmGeometry offset;
  offset.shoulder_offset = 0.1;
  hand = arm_frames(offset, ArmJoints::Constant(0.5)).hand();
  EXPECT_EQ(unreachable(offset, hand),
            "The closed form knows no shoulder_offset: put the offset into the arm's mount.");
  EXPECT_FALSE(arm_inverse(offset, hand, 0, {}));
}

TEST(ArmInverse, ObjectsToGeometriesThatNoArmHas) {
  ArmGeometry geometry;
  EXPECT_EQ(objection(geometry), std::nullopt);
  geometry.forearm = 0;
  EXPECT_EQ(objection(geometry), "The arm's forearm must be a length above 0 m.");
  geometry = {};
  geometry.elbow_offset = std::numeric_limits<double>::infinity();
  EXPECT_EQ(objection(geometry), "The arm's elbow_offset must be a number.");
  geometry = {};
  geometry.limits[3] = 4;
  EXPECT_EQ(objection(geometry),
            "The limit of the arm's joint 4 must lie above 0 and at most at 180 degrees.");
}

TEST(ArmInverse, TheBestSolutionKeepsTheLimits) {
  RandomArm arm;
  int found = 0;
  for (int n = 0; n < 500; ++n) {
    const ArmJoints present = arm.joints(0.9);
    const auto hand = arm_frames(arm.geometry, arm.joints()).hand();
    const auto best = best_arm_solution(arm.geometry, hand, present);
    if (!best) continue;
    ++found;
    EXPECT_GE(best->margin, 0);
    EXPECT_DOUBLE_EQ(best->margin, limit_margin(arm.geometry, best->q));
    EXPECT_LT(apart(arm_frames(arm.geometry, best->q).hand(), hand), 1e-9);
    const auto held = best_arm_solution(arm.geometry, hand, present, best->branch);
    ASSERT_TRUE(held);
    EXPECT_EQ(held->branch, best->branch);
    EXPECT_LE(held->margin, best->margin);
  }
  EXPECT_GE(found, 495);
}

TEST(ArmChain, TheJacobianIsTheChainsDerivative) {
  RandomArm arm(0.04);
  arm.geometry.shoulder_offset = 0.05;
  constexpr double kStep = 1e-6;
  for (int n = 0; n < 200; ++n) {
    const ArmJoints q = arm.joints();
    const auto frames = arm_frames(arm.geometry, q);
    const auto jacobian = arm_jacobian(frames);
    const auto of_elbow = arm_point_jacobian(frames, 3, frames.elbow());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      ArmJoints before = q;
      ArmJoints after = q;
      before[i] -= kStep;
      after[i] += kStep;
      const auto a = arm_frames(arm.geometry, before);
      const auto b = arm_frames(arm.geometry, after);
      const algo::Vec3 way = (b.hand().translation() - a.hand().translation()) / (2 * kStep);
      EXPECT_LT((jacobian.block<3, 1>(0, i) - way).norm(), 1e-8);
      const Eigen::Matrix3d turn = (b.hand().linear() - a.hand().linear()) / (2 * kStep) *
                                   frames.hand().linear().transpose();
      const algo::Vec3 rate(turn(2, 1), turn(0, 2), turn(1, 0));
      EXPECT_LT((jacobian.block<3, 1>(3, i) - rate).norm(), 1e-8);
      EXPECT_LT((of_elbow.col(i) - (b.elbow() - a.elbow()) / (2 * kStep)).norm(), 1e-8);
    }
  }
}

TEST(ArmInverse, AllocatesNothing) {
  RandomArm arm;
  const auto hand = arm_frames(arm.geometry, arm.joints()).hand();
  const auto before = allocations::count();
  const auto best = best_arm_solution(arm.geometry, hand, ArmJoints::Zero());
  EXPECT_EQ(allocations::count(), before);
  EXPECT_TRUE(best);
}

}  // namespace
