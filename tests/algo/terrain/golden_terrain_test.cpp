// tests/algo/terrain/golden_terrain_test.cpp: golden vectors of section G, Eq. 11-27.
#include <cmath>

#include "tests/algo/golden.hpp"
#include <gtest/gtest.h>

#include "algo/terrain/laser_line.hpp"
#include "algo/terrain/tilt_prediction.hpp"
#include "algo/terrain/turnover.hpp"
#include "algo/units.hpp"

namespace {

using algo::Attitude;
using algo::Stance;
using algo::Vec2;
using algo::Vec3;
using algo::units::kRadiansPerDegree;
using golden::close;
using golden::Json;

const Json& robhaz_document() {
  static const Json loaded = golden::load("G_robhaz.json");
  return loaded;
}
const Json& terrain_vectors(const char* name) {
  const Json& list = robhaz_document().at(name);
  EXPECT_FALSE(list.empty()) << name;
  return list;
}
double allowed() {
  return golden::tolerance(robhaz_document());
}

void expect_close(const Vec3& actual, const Json& expected) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_TRUE(close(actual[k], expected.at(static_cast<std::size_t>(k)), allowed())) << k;
  }
}

TEST(TerrainGolden, Triangulation) {
  for (const Json& vector : terrain_vectors("triangulation")) {
    const algo::LineCamera camera{
        .height = vector.at("l_rc"),
        .pitch = vector.at("theta_rc_deg").get<double>() * kRadiansPerDegree,
        .baseline = vector.at("b"),
        .angle = vector.at("theta_lp_deg").get<double>() * kRadiansPerDegree,
        .focal = vector.at("f")};
    const auto p_C = algo::triangulated(camera, vector.at("u"), vector.at("v"));
    ASSERT_TRUE(p_C);
    expect_close(*p_C, vector.at("P_c"));
    expect_close(algo::to_robot(camera, *p_C), vector.at("P_r"));
  }
}

TEST(TerrainGolden, Roll) {
  for (const Json& vector : terrain_vectors("roll")) {
    const double roll = algo::roll_change(vector.at("zL"), vector.at("zR"), vector.at("D_track"));
    EXPECT_TRUE(close(roll, vector.at("droll"), allowed()));
  }
}

/// The literal reading of Eq. 16 has the other sign.
TEST(TerrainGolden, PitchInBothReadings) {
  for (const Json& vector : terrain_vectors("pitch")) {
    const auto point = [](const Json& p) { return Vec2(p.at(0), p.at(1)); };
    const Vec2 older = point(vector.at("older"));
    const Vec2 newer = point(vector.at("newer"));
    const double expected = vector.at("dpitch_nose_down_positive");
    EXPECT_TRUE(close(algo::pitch_change(older, newer), expected, allowed()));
    const double literal = algo::pitch_change(older, newer, algo::TiltLaw::Literal);
    EXPECT_TRUE(close(literal, -expected, allowed()));
  }
}

TEST(TerrainGolden, Turnover) {
  for (const Json& vector : terrain_vectors("turnover")) {
    const Attitude attitude{vector.at("roll_deg").get<double>() * kRadiansPerDegree,
                            vector.at("pitch_deg").get<double>() * kRadiansPerDegree};
    const Stance stance{.mass_height = vector.at("h"), .width = vector.at("W_r")};
    const Json& out = vector.at("out");
    const auto k = algo::gravity_shares(attitude);
    EXPECT_TRUE(close(k.y, out.at("kY"), allowed()));
    EXPECT_TRUE(close(k.z, out.at("kZ"), allowed()));
    const auto sideways = algo::sideways_range(attitude, stance);
    EXPECT_TRUE(close(sideways.min, out.at("vw_lb"), allowed()));
    EXPECT_TRUE(close(sideways.max, out.at("vw_ub"), allowed()));
    const double then = vector.at("v").get<double>() + vector.at("dv").get<double>();
    const auto turn = algo::turn_range(sideways, then, vector.at("v_max"), vector.at("w_max"));
    EXPECT_TRUE(close(turn.min, out.at("w_lb"), allowed()));
    EXPECT_TRUE(close(turn.max, out.at("w_ub"), allowed()));
    EXPECT_EQ(turn.must_turn, sideways.min > 0 || sideways.max < 0);
  }
}

TEST(TerrainGolden, SpeedChange) {
  for (const Json& vector : terrain_vectors("delta_v")) {
    const double change = algo::speed_change(vector.at("v"), vector.at("a"), vector.at("D_tp"));
    EXPECT_TRUE(close(change, vector.at("dv"), allowed()));
  }
}

}  // namespace
