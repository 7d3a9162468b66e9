// tests/server/run/laser_json_test.cpp: a scanner comes back from its text as it was.
#include "server/run/laser_json.hpp"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algo/units.hpp"

namespace server {
namespace {

using nlohmann::json;

sim::LaserConfig read_laser(const json& document) {
  return laser_from_json({document, "lasers/0"});
}

/// Exactly, to the last bit.
void expect_same_laser(const sim::LaserConfig& a, const sim::LaserConfig& b) {
  EXPECT_EQ(a.mount_R, b.mount_R);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.field_of_view, b.field_of_view);
  EXPECT_EQ(a.angle_increment, b.angle_increment);
  EXPECT_EQ(a.turns, b.turns);
  EXPECT_EQ(a.rolling, b.rolling);
  EXPECT_EQ(a.mirror_period, b.mirror_period);
  EXPECT_EQ(a.unit, b.unit);
  EXPECT_EQ(a.range_max, b.range_max);
  EXPECT_EQ(a.bias, b.bias);
  EXPECT_EQ(a.noise, b.noise);
  EXPECT_EQ(a.noise_shape, b.noise_shape);
  EXPECT_EQ(a.mixed_pixels, b.mixed_pixels);
  EXPECT_EQ(a.reflectivity, b.reflectivity);
  EXPECT_EQ(a.dropout, b.dropout);
  EXPECT_EQ(a.salt, b.salt);
  EXPECT_EQ(a.pepper, b.pepper);
}

TEST(LaserJson, AScannerOfAnyFieldAndAnyNumberOfBeamsComesBackFromItsText) {
  for (double field = 1; field <= 360; field += 0.75) {
    for (std::uint32_t beams = 2; beams <= 4096; beams = beams * 9 / 8 + 1) {
      const sim::LaserConfig laser =
          read_laser({{"field_of_view_deg", field}, {"beams", beams}, {"range_max", 25}});
      const sim::LaserConfig again = read_laser(json::parse(to_json(laser).dump()));
      expect_same_laser(laser, again);
      if (HasFailure()) FAIL() << beams << " beams over " << field << " degrees";
    }
  }
}

/// Steps of 0.25, 0.5 and 1 degree are those of an LMS200, whose field or mirror is another.
TEST(LaserJson, AWideScannerWithTheStepsOfAnLms200StaysWide) {
  for (const auto& [field, beams] : {std::pair{270.0, 1081U},
                                     {270.0, 541U},
                                     {270.0, 271U},
                                     {360.0, 361U},
                                     {360.0, 721U},
                                     {240.0, 241U},
                                     {90.0, 181U},
                                     {180.0, 721U},
                                     {100.0, 101U},
                                     {180.0, 361U},
                                     {100.0, 401U},
                                     {33.3, 7U},
                                     {359.99999999, 4096U}}) {
    SCOPED_TRACE(testing::Message() << beams << " beams over " << field << " degrees");
    const sim::LaserConfig laser = read_laser({{"field_of_view_deg", field}, {"beams", beams}});
    const json written = to_json(laser);
    EXPECT_EQ(written["field_of_view_deg"], field);
    EXPECT_EQ(written["beams"], beams);
    EXPECT_FALSE(written.contains("resolution_deg"));
    expect_same_laser(laser, read_laser(written));
  }
}

TEST(LaserJson, AnLms200IsWrittenByItsResolution) {
  for (const double resolution : {0.25, 0.5, 1.0}) {
    for (const bool ideal : {false, true}) {
      const sim::LaserConfig laser =
          read_laser({{"resolution_deg", resolution},
                      {"ideal", ideal},
                      {"mount", {{"x", 0.3}, {"y", -0.1}, {"heading", 3}}}});
      const json written = to_json(laser);
      EXPECT_EQ(written["resolution_deg"], resolution);
      EXPECT_FALSE(written.contains("beams") || written.contains("field_of_view_deg"));
      expect_same_laser(laser, read_laser(written));
    }
  }
  EXPECT_EQ(read_laser({{"resolution_deg", 0.5}}).turns, 2U);
}

}  // namespace
}  // namespace server
