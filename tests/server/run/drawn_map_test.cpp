// tests/server/run/drawn_map_test.cpp: the room on a map, measured, written and read again.
#include "server/run/drawn_map.hpp"

#include <gtest/gtest.h>

namespace server {
namespace {

using algo::DrawnSpace;

/// Free cells of 40 x 3 m with a wall along x = 12.
algo::OccupancyMap hall_with_a_wall(double cell) {
  algo::OccupancyMap map(cell);
  for (double x = -4 + cell / 2; x < 36; x += cell) {
    for (double y = cell / 2; y < 3; y += cell) {
      if (x > 12 && x < 12 + cell) {
        map.mark_wall({x, y});
      } else {
        map.mark_free({x, y});
      }
    }
  }
  return map;
}

TEST(DrawnMap, TellsTheRoomToTheNearestWall) {
  const DrawnSpace space = drawn_space(hall_with_a_wall(0.05));
  // Wall cells are centred at x = 12.025; of the cell from 12.4 to 12.6 m the farthest centre is
  // at 12.575.
  EXPECT_NEAR(space.clearance(62, 5), 55, 1);
  EXPECT_NEAR(space.clearance(57, 5), 60, 1);  // from the left: 11.425
  EXPECT_NEAR(space.clearance(60, 5), 15, 1);
  EXPECT_EQ(space.clearance(100, 5), DrawnSpace::kMost);
  EXPECT_EQ(space.clearance(-10, 5), DrawnSpace::kMost);
  EXPECT_EQ(space.clearance(100, 20), DrawnSpace::kUnknown);
  EXPECT_EQ(space.clearance(-2000, 5), DrawnSpace::kUnknown);
}

TEST(DrawnMap, FillsTheCellsOfACoarseMap) {
  const DrawnSpace space = drawn_space(hall_with_a_wall(0.4));
  EXPECT_LT(space.clearance(60, 5), 10);
  EXPECT_LT(space.clearance(61, 5), 10);
  EXPECT_GT(space.clearance(63, 5), 20);
}

TEST(DrawnMap, IsReadAsItWasWritten) {
  const DrawnSpace space = drawn_space(hall_with_a_wall(0.05));
  EXPECT_EQ(drawn_space_from_json(to_json(space)), space);
  EXPECT_EQ(drawn_space_from_json(to_json(DrawnSpace())), DrawnSpace());
  nlohmann::json bad = to_json(space);
  bad["rows"] = 1;
  EXPECT_THROW(drawn_space_from_json(bad), std::exception);
}

}  // namespace
}  // namespace server
