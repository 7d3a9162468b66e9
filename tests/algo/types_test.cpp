// tests/algo/types_test.cpp: the quick forms of floor and atan2.
#include "algo/types.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace {

TEST(WholeBelow, IsTheFloor) {
  for (const double x :
       {-2.0, -1.5, -1.0, -1e-12, -0.0, 0.0, 1e-12, 0.999999, 1.0, 2.5, 1e9, -1e9}) {
    EXPECT_EQ(algo::whole_below(x), static_cast<int>(std::floor(x))) << x;
  }
}

TEST(RoughBearing, IsNearTheBearingAllRound) {
  for (int i = -18000; i <= 18000; ++i) {
    const double bearing = i * std::numbers::pi / 18000;
    for (const double far : {1e-6, 1.0, 1e6}) {
      const algo::Vec2 p = far * algo::direction(bearing);
      const double off = algo::rough_bearing(p.y(), p.x()) - std::atan2(p.y(), p.x());
      ASSERT_LE(std::abs(off), algo::kRoughBearing) << bearing;
    }
  }
}

TEST(RoughBearing, IsExactAlongTheAxes) {
  EXPECT_EQ(algo::rough_bearing(0, 0), 0);
  EXPECT_EQ(algo::rough_bearing(0, 2), 0);
  EXPECT_EQ(algo::rough_bearing(0, -2), std::numbers::pi);
  EXPECT_NEAR(algo::rough_bearing(2, 0), std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(algo::rough_bearing(-2, 0), -std::numbers::pi / 2, 1e-15);
}

}  // namespace
