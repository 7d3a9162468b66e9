// tests/sim/obstacle_set_test.cpp: distances from discs and rectangles to every kind of obstacle.
#include "sim/obstacle_set.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "algo/units.hpp"

namespace sim {
namespace {

using namespace algo::units;

algo::Obstacle at(double x, double y, double heading, decltype(algo::Obstacle::shape) shape) {
  algo::Obstacle obstacle;
  obstacle.id = 1;
  obstacle.pose_W = {x, y, heading};
  obstacle.shape = std::move(shape);
  return obstacle;
}

const Hull kRectangle{std::hypot(0.3, 0.2), 0.3, 0.2};

double clearance(const algo::Obstacle& obstacle, const algo::Pose2& pose, const Hull& hull) {
  ObstacleSet set;
  set.add(obstacle);
  return set.clearance(hull, pose);
}

TEST(ObstacleSet, ARectangleTouchesWithItsSidesAndItsCorners) {
  const algo::Obstacle post = at(1, 0, 0, algo::Cylinder{0.1});
  EXPECT_NEAR(clearance(post, {0, 0, 0}, kRectangle), 1 - 0.1 - 0.3, 1e-12);
  EXPECT_NEAR(clearance(post, {0, 0, 90_deg}, kRectangle), 1 - 0.1 - 0.2, 1e-12);
  EXPECT_NEAR(clearance(post, {0, -0.5, 0}, kRectangle), std::hypot(0.7, 0.3) - 0.1, 1e-12);
  EXPECT_LT(clearance(post, {0.65, 0, 0}, kRectangle), 0);

  const algo::Obstacle box = at(1, 0, 45_deg, algo::Box{0.4, 0.4});
  EXPECT_NEAR(clearance(box, {0, 0, 0}, kRectangle), 1 - 0.2 * std::sqrt(2) - 0.3, 1e-12);
  EXPECT_LT(clearance(box, {0.5, 0, 0}, kRectangle), 0);
  EXPECT_LT(clearance(box, {1, 0, 0}, kRectangle), 0);  // one inside the other
}

TEST(ObstacleSet, AgreesWithPointsSampledAlongTheOutline) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  std::uniform_real_distribution<double> angle(-3.1, 3.1);
  for (int k = 0; k < 300; ++k) {
    const algo::Obstacle obstacle =
        at(place(random),
           place(random),
           angle(random),
           k % 2 == 0 ? decltype(algo::Obstacle::shape)(algo::Box{0.5, 0.2})
                      : decltype(algo::Obstacle::shape)(algo::Cylinder{0.2}));
    const algo::Pose2 pose{place(random), place(random), angle(random)};
    double least = 1e9;
    for (double s = -1; s <= 1; s += 0.01) {
      for (const algo::Vec2& p : {algo::Vec2(0.3 * s, 0.2),
                                  algo::Vec2(0.3 * s, -0.2),
                                  algo::Vec2(0.3, 0.2 * s),
                                  algo::Vec2(-0.3, 0.2 * s)}) {
        least = std::min(least, algo::signed_distance(obstacle, algo::to_parent(pose, p)));
      }
    }
    const double found = clearance(obstacle, pose, kRectangle);
    if (least > 0 && found > 0) {
      EXPECT_NEAR(found, least, 0.005);
    }
    if (least < -0.005) {
      EXPECT_LT(found, 0);
    }
    if (found < 0) {
      EXPECT_LT(least, 0.31);
    }
  }
}

TEST(ObstacleSet, TheGroundIsTheTopOfARampOrTheBottomOfATrench) {
  for (const double slope : {-20_deg, -10_deg, 5_deg, 10_deg, 20_deg}) {
    const double tan = std::tan(slope);
    // From x = 1 to 3, down from a height if the slope falls.
    const double low = tan < 0 ? -2 * tan : 0;
    algo::Obstacle ramp = at(2, 0, 0, algo::Ramp{2, 2, low});
    ramp.height = low + 2 * tan;
    ObstacleSet set;
    set.add(ramp);
    EXPECT_NEAR(set.ground_at({1.5, 0}), low + tan / 2, 1e-12);
  }
  ObstacleSet narrow;  // from 0.99 to 1.01
  narrow.add(at(1, 0, 0, algo::Trench{0.02, 2, 0.1}));
  EXPECT_NEAR(narrow.ground_at({1, 0}), -0.1, 1e-12);
  EXPECT_EQ(narrow.ground_at({1.02, 0}), 0);
}

TEST(ObstacleSet, ADiscIsItsRadiusNearer) {
  const algo::Obstacle post = at(1, 0, 0, algo::Cylinder{0.1});
  EXPECT_NEAR(clearance(post, {0, 0, 1}, {.radius = 0.35}), 1 - 0.1 - 0.35, 1e-12);
  EXPECT_TRUE(std::isinf(ObstacleSet().clearance({.radius = 0.35}, {0, 0, 0})));
}

}  // namespace
}  // namespace sim
