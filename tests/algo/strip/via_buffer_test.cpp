// tests/algo/strip/via_buffer_test.cpp: the via list beyond its golden vectors.
#include "algo/strip/via_buffer.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace {

using algo::IsSortRule;
using algo::Vec2;
using algo::Via;
using algo::ViaBuffer;

TEST(ViaBuffer, AGoalAtTheOriginIsLegal) {
  ViaBuffer buffer;
  buffer.reset({3, 3}, {0, 0});
  EXPECT_EQ(buffer.get_position(1), (Via{{0, 0}, true}));
  EXPECT_EQ(buffer.get_position(2), std::nullopt);
  EXPECT_TRUE(buffer.insert({1.5, 1.5}));
  EXPECT_EQ(buffer.get_position(2), (Via{{0, 0}, true}));
}

TEST(ViaBuffer, TheCorrectedRuleAcceptsAViaStraightAhead) {
  ViaBuffer buffer;
  buffer.reset({0, 0}, {5, 0});
  EXPECT_FALSE(buffer.insert({2, 0}, IsSortRule::Literal));
  EXPECT_EQ(buffer.last(), 2U);
  EXPECT_TRUE(buffer.insert({2, 0}));
  EXPECT_EQ(buffer.last(), 3U);
  // A newer via replaces it: three live points.
  EXPECT_TRUE(buffer.insert({1, 1}));
  EXPECT_EQ(buffer.last(), 3U);
  EXPECT_EQ(buffer.get_position(1), (Via{{1, 1}, false}));
}

TEST(ViaBuffer, FliesByViasAndReachesTheGoalClosely) {
  ViaBuffer buffer;
  buffer.reset({0, 0}, {3, 0});
  buffer.insert({1.5, 0.5});
  EXPECT_FALSE(buffer.advance({0.5, 0.2}));
  EXPECT_TRUE(buffer.advance({1.0, 0.3}));  // within 0.6 of the via
  EXPECT_EQ(buffer.cursor(), 1U);
  EXPECT_FALSE(buffer.advance({2.8, 0}));  // 0.2 from the goal
  EXPECT_TRUE(buffer.advance({2.95, 0}));
  EXPECT_EQ(buffer.cursor(), 2U);
  EXPECT_FALSE(buffer.insert({9, 9}));  // arrived: nothing left to drive to
}

TEST(ViaBuffer, IsBounded) {
  ViaBuffer buffer;
  buffer.reset({0, 0}, {1000, 0});
  std::size_t inserted = 0;
  for (int k = 1; k < 200; ++k) {
    if (!buffer.insert({k, 0})) break;
    ++inserted;
    ASSERT_TRUE(buffer.advance({k, 0}));
  }
  EXPECT_EQ(inserted, ViaBuffer::kCapacity - 2);
  EXPECT_LE(buffer.last(), ViaBuffer::kCapacity);
  EXPECT_THROW(buffer.assign(std::vector<Via>(65), 0), std::invalid_argument);
  EXPECT_THROW(buffer.assign(std::vector<Via>(3), 3), std::invalid_argument);
}

TEST(ViaBuffer, EmptyOrNotFiniteIsRefused) {
  ViaBuffer buffer;
  EXPECT_FALSE(buffer.insert({1, 1}));
  EXPECT_FALSE(buffer.sort_position({1, 1}, {2, 2}));
  EXPECT_FALSE(buffer.advance({0, 0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(algo::is_sort({nan, 5}, {0, 0}, IsSortRule::Corrected));
}

}  // namespace
