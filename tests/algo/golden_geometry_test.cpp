// tests/algo/golden_geometry_test.cpp: golden vectors of section C: beams and nearest returns.
#include <string>
#include <vector>

#include "tests/algo/golden.hpp"
#include <gtest/gtest.h>

#include "algo/geometry.hpp"
#include "algo/perceive.hpp"
#include "algo/units.hpp"

namespace {

using golden::Json;
using namespace algo::units;

constexpr double kAvoidanceRange = 1350_mm;

const Json& geometry_vectors() {
  static const Json loaded = golden::load("C_geometry.json");
  return loaded;
}
double geometry_tolerance() {
  return golden::tolerance(geometry_vectors());
}

TEST(GeometryGolden, Vectors) {
  ASSERT_FALSE(geometry_vectors().at("vectors").empty());
  for (const Json& vector : geometry_vectors().at("vectors")) {
    const double bearing = (vector.at("beam").get<double>() * 0.5 - 90) * kRadiansPerDegree;
    const double range = vector.at("range").get<double>() * golden::kMm;
    const algo::Pose2 mount = golden::pose_mm(vector.at("sensor_offset"));
    const algo::Pose2 pose = golden::pose_mm(vector.at("pose"));
    EXPECT_TRUE(golden::close_mm(algo::beam_point_W(pose, mount, bearing, range),
                                 vector.at("obstacle"),
                                 geometry_tolerance()));
    EXPECT_TRUE(golden::close(algo::beam_point_R(mount, bearing, range).norm() / golden::kMm,
                              vector.at("range_from_centre"),
                              geometry_tolerance()));
  }
}

algo::LaserScan golden_scan() {
  const Json& about = geometry_vectors().at("scan");
  algo::LaserScan scan;
  scan.range_max = 8000_mm;
  scan.angle_min = -90_deg;
  scan.angle_increment = about.at("res_deg").get<double>() * kRadiansPerDegree;
  scan.resize(about.at("ranges").size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double range = about.at("ranges").at(i).get<double>() * golden::kMm;
    if (range < scan.range_max) {
      scan.set_ok(i, range);
    } else {
      scan.set_free(i);
    }
  }
  return scan;
}

TEST(GeometryGolden, ObstacleCheckLiteral) {
  const Json& expected = geometry_vectors().at("obstacle_check_literal_1350");
  const auto found = algo::obstacle_check_literal(golden_scan().ranges, kAvoidanceRange);
  ASSERT_EQ(found.has_value(), expected.at("found").get<bool>());
  if (!found) return;
  EXPECT_EQ(found->beam, expected.at("beam").get<std::size_t>());
  EXPECT_EQ(found->angle_degrees, expected.at("angle_int").get<int>());
  EXPECT_TRUE(
      golden::close(found->distance / golden::kMm, expected.at("distance"), geometry_tolerance()));
}

TEST(GeometryGolden, ObstacleCheckNearest) {
  const Json& expected = geometry_vectors().at("nearest_1350");
  const algo::LaserScan scan = golden_scan();
  const auto found = algo::obstacle_check(scan, kAvoidanceRange);
  ASSERT_EQ(found.has_value(), !expected.is_null());
  if (!found) return;
  EXPECT_EQ(found->beam, expected.at("beam").get<std::size_t>());
  EXPECT_TRUE(golden::close(scan.angle(found->beam) / kRadiansPerDegree + 90,
                            expected.at("angle_deg"),
                            geometry_tolerance()));
  EXPECT_TRUE(
      golden::close(found->distance / golden::kMm, expected.at("distance"), geometry_tolerance()));
}

TEST(GeometryGolden, Split) {
  const Json& expected = geometry_vectors().at("split");
  algo::Scene scene;
  scene.scan = golden_scan();
  algo::perceive({}, scene);
  for (const std::string side : {"left", "right"}) {
    const auto& found = side == "left" ? scene.left : scene.right;
    const Json& beam = expected.at(side);
    ASSERT_EQ(found.has_value(), !beam.is_null()) << side;
    if (!found) continue;
    EXPECT_EQ(found->beam, beam.get<std::uint32_t>()) << side;
    EXPECT_TRUE(golden::close(
        found->distance / golden::kMm, expected.at("d_" + side), geometry_tolerance()))
        << side;
  }
}

}  // namespace
