// tests/algo/full_strip/strip_route_test.cpp: when a route gives a goal up.
#include "algo/full_strip/strip_route.hpp"

#include "tests/algo/full_strip/walls.hpp"
#include <gtest/gtest.h>

namespace {

using algo::Vec2;

/// A room around the goal, seen from all sides.
struct ShutRoom {
  algo::LocalMap map{};
  algo::BuildingMemory memory{};
  algo::StripRoute route{};
  double now = 0;
  int doubts_old = 0;  // times that the old was doubted

  ShutRoom() {
    for (const double y : {-2.0, 2.0}) walls::wall(map, {3, y}, {7, y});
    for (const double x : {3.0, 7.0}) walls::wall(map, {x, -2}, {x, 2.02});
  }
  /// Ticks for `seconds`.
  void ask(double seconds) {
    algo::RouteSettings settings;
    settings.strip.rest_distance = 0.75;
    settings.half_width = 0.35;
    settings.round = true;
    settings.max_v = 0.5;
    settings.plan_period = 0.25;
    constexpr double kTick = 0.05;  // [s]
    const auto ticks = static_cast<int>(seconds / kTick);
    for (int k = 0; k < ticks; ++k, now += kTick) {
      route.update(settings, {map, memory}, {0, 0}, now);
      doubts_old += route.doubts_old() ? 1 : 0;
    }
  }
};

TEST(StripRoute, DoubtsWhatIsOldOnceBeforeItSaysThatThereIsNoWay) {
  ShutRoom room;
  room.route.set_goal({5, 0}, room.now);
  room.ask(30);
  EXPECT_TRUE(room.route.no_way());
  EXPECT_EQ(room.doubts_old, 1);
  room.ask(30);
  EXPECT_EQ(room.doubts_old, 1) << "the same goal";
  room.route.set_goal({5.5, 0}, room.now);
  room.ask(30);
  EXPECT_TRUE(room.route.no_way());
  EXPECT_EQ(room.doubts_old, 2);
}

}  // namespace
