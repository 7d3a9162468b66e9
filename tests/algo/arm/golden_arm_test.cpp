// tests/algo/arm/golden_arm_test.cpp: golden vectors of the arm: its chain, its angle, its inverse.
#include "tests/algo/golden.hpp"
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "algo/arm/arm_chain.hpp"
#include "algo/arm/arm_inverse.hpp"
#include "algo/units.hpp"

namespace {

using golden::Json;

algo::ArmGeometry arm_geometry_of(const Json& model) {
  algo::ArmGeometry geometry;
  geometry.upper_arm = model.at("d3");
  geometry.elbow_offset = model.at("a4");
  geometry.forearm = model.at("d5");
  geometry.hand = model.at("d7");
  for (std::size_t i = 0; i < algo::kArmJoints; ++i) {
    geometry.limits[static_cast<Eigen::Index>(i)] =
        model.at("limits_deg").at(i).get<double>() * algo::units::kRadiansPerDegree;
  }
  return geometry;
}

algo::ArmJoints joints_of(const Json& list) {
  const auto values = golden::numbers(list);
  if (values.size() != algo::kArmJoints) throw std::runtime_error("not seven joints");
  return algo::ArmJoints(values.data());
}

algo::Vec3 point_of(const Json& p) {
  const auto xyz = golden::numbers(p);
  return {xyz.at(0), xyz.at(1), xyz.at(2)};
}

algo::Pose3 pose3_of(const Json& rows) {
  algo::Pose3 pose = algo::Pose3::Identity();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      pose.matrix()(i, j) =
          rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j)).get<double>();
    }
  }
  return pose;
}

struct GoldenArm {
  Json document = golden::load("arm.json");
  double tolerance(const char* of) const {
    return document.at("conventions").at("tolerance").at(of);
  }
};

TEST(ArmGolden, ChainAndJacobian) {
  const GoldenArm golden;
  const double allowed = golden.tolerance("fk");
  for (const Json& model : golden.document.at("models")) {
    const auto geometry = arm_geometry_of(model);
    ASSERT_FALSE(model.at("fk").empty());
    for (const Json& v : model.at("fk")) {
      const auto frames = arm_frames(geometry, joints_of(v.at("q")));
      EXPECT_LE((frames.hand().matrix() - pose3_of(v.at("T")).matrix()).cwiseAbs().maxCoeff(),
                allowed);
      EXPECT_LE((frames.shoulder() - point_of(v.at("shoulder"))).norm(), allowed);
      EXPECT_LE((frames.elbow() - point_of(v.at("elbow"))).norm(), allowed);
      EXPECT_LE((frames.wrist() - point_of(v.at("wrist"))).norm(), allowed);
      const auto jacobian = arm_jacobian(frames);
      for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
        const auto row = joints_of(v.at("jacobian").at(static_cast<std::size_t>(i)));
        EXPECT_LE((jacobian.row(i).transpose() - row).cwiseAbs().maxCoeff(), allowed);
      }
    }
  }
}

TEST(ArmGolden, ArmAngle) {
  const GoldenArm golden;
  for (const Json& model : golden.document.at("models")) {
    const auto geometry = arm_geometry_of(model);
    for (const Json& v : model.at("fk")) {
      const auto psi = arm_angle(geometry, arm_frames(geometry, joints_of(v.at("q"))));
      ASSERT_EQ(psi.has_value(), v.contains("arm_angle")) << v.at("q");
      if (psi) {
        EXPECT_TRUE(golden::close_angle(*psi, v.at("arm_angle"), golden.tolerance("ik_joint")));
      }
    }
  }
}

TEST(ArmGolden, EachBranchOfTheInverse) {
  const GoldenArm golden;
  for (const Json& model : golden.document.at("models")) {
    const auto geometry = arm_geometry_of(model);
    ASSERT_FALSE(model.at("ik").empty());
    for (const Json& v : model.at("ik")) {
      const auto hand = pose3_of(v.at("T"));
      EXPECT_EQ(unreachable(geometry, hand), std::nullopt);
      for (const Json& solution : v.at("solutions")) {
        const algo::ArmBranch branch{solution.at("branch").get<std::uint8_t>()};
        const auto q = arm_inverse(geometry, hand, v.at("psi"), branch);
        ASSERT_TRUE(q);
        for (std::size_t i = 0; i < algo::kArmJoints; ++i) {
          EXPECT_TRUE(golden::close_angle((*q)[static_cast<Eigen::Index>(i)],
                                          solution.at("q").at(i),
                                          golden.tolerance("ik_joint")))
              << "joint " << i + 1 << " of branch " << int{branch.bits};
        }
        EXPECT_EQ(limit_margin(geometry, *q) >= 0, solution.at("in_limits").get<bool>());
      }
    }
  }
}

TEST(ArmGolden, UnreachablePoses) {
  const GoldenArm golden;
  for (const Json& model : golden.document.at("models")) {
    const auto geometry = arm_geometry_of(model);
    ASSERT_FALSE(model.at("unreachable").empty());
    for (const Json& v : model.at("unreachable")) {
      const auto hand = pose3_of(v.at("T"));
      const auto why = unreachable(geometry, hand);
      ASSERT_TRUE(why) << v;
      EXPECT_NE(why->find("m from the shoulder"), std::string::npos) << *why;
      EXPECT_FALSE(arm_inverse(geometry, hand, 1, {}));
    }
  }
}

TEST(ArmGolden, SingularConfigurationsLoseARank) {
  const GoldenArm golden;
  for (const Json& v : golden.document.at("singular_configurations")) {
    const algo::ArmGeometry geometry;
    const auto jacobian = arm_jacobian(arm_frames(geometry, joints_of(v.at("q"))));
    Eigen::FullPivLU<algo::ArmJacobian> factors(jacobian);
    factors.setThreshold(1e-9);
    EXPECT_EQ(factors.rank(), 5) << v.at("condition");
  }
}

}  // namespace
