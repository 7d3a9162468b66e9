// tests/server/serve/path_trail_test.cpp: a path of any length in bounded memory.
#include "server/serve/path_trail.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace server {
namespace {

TEST(PathTrail, KeepsAPoseEveryTwoCentimetres) {
  PathTrail trail;
  for (int i = 0; i <= 100; ++i) trail.add({i * 0.006, 0, 0});
  EXPECT_EQ(trail.poses_W().size(), 26u);  // 0, then the first beyond 2 cm: 2.4 cm apart
  EXPECT_EQ(trail.changes(), 26u);
}

TEST(PathTrail, IsBoundedAndKeepsItsShape) {
  PathTrail trail;
  for (int i = 0; i < 100'000; ++i) trail.add({i * 0.025, 0, 0});
  EXPECT_LE(trail.poses_W().size(), PathTrail::kMost);
  EXPECT_GE(trail.poses_W().size(), PathTrail::kMost / 2);
  EXPECT_EQ(trail.poses_W().front().x, 0);
  EXPECT_GT(trail.poses_W().back().x, 2490);
  EXPECT_LT(trail.message(0).size(), std::size_t{400} << 10);
}

/// Appending a pose writes the text of one pose, not of the whole path.
TEST(PathTrail, WritesEachPoseOnce) {
  PathTrail trail;
  trail.add({1, 2, 0});
  trail.add({3, 4, 3.141592653589793});
  const auto message = nlohmann::json::parse(trail.message(1.5));
  EXPECT_EQ(message["timestamp"], (nlohmann::json{{"sec", 1}, {"nsec", 500000000}}));
  EXPECT_EQ(message["frame_id"], "map");
  ASSERT_EQ(message["poses"].size(), 2u);
  EXPECT_EQ(message["poses"][1]["position"]["y"], 4.0);
  EXPECT_NEAR(message["poses"][1]["orientation"]["z"].get<double>(), 1, 1e-12);
  trail.clear();
  EXPECT_EQ(nlohmann::json::parse(trail.message(0))["poses"].size(), 0u);
}

}  // namespace
}  // namespace server
