// tests/algo/terrain/ground_class_test.cpp: the classifier beside its printed rules, the sensor's
// curve, and the values of the ground.
#include "algo/terrain/ground_class.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "algo/terrain/class_vote.hpp"
#include "algo/terrain/ground_value.hpp"
#include "algo/terrain/psd_curve.hpp"
#include "algo/units.hpp"

namespace {

using algo::classify;
using algo::classify_literal;
using algo::GroundClass;
using namespace algo::units;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

unsigned bit(GroundClass kind) {
  return 1U << static_cast<unsigned>(kind);
}

TEST(GroundClass, FlatRangesFollowTheGeometry) {
  const algo::FlatRanges flat =
      algo::flat_ranges({.height = 0.2 * std::sin(45_deg), .angle = 45_deg, .separation = 0.08});
  EXPECT_NEAR(flat.near, 0.20, 1e-12);
  EXPECT_NEAR(flat.far, 0.28, 1e-12);
}

TEST(GroundClass, UnknownWithoutBothReadings) {
  EXPECT_EQ(classify(kNaN, 0), GroundClass::Unknown);
  EXPECT_EQ(classify(0, kNaN), GroundClass::Unknown);
  const algo::FlatRanges flat{0.28, 0.20};
  EXPECT_EQ(algo::classify_ranges(0.28, 0.09, flat), GroundClass::Unknown);
  EXPECT_EQ(algo::classify_ranges(0.81, 0.20, flat), GroundClass::Unknown);
  EXPECT_EQ(algo::classify_ranges(0.28, 0.20, flat), GroundClass::Flat);
}

/// As printed, each step up is a slope up too, and each step down unless it falls away.
TEST(GroundClass, PrintedRulesOverlap) {
  EXPECT_EQ(classify(-0.0184, -0.0184), GroundClass::StepUp);
  EXPECT_EQ(classify_literal(-0.0184, -0.0184),
            bit(GroundClass::StepUp) | bit(GroundClass::SlopeUp));
  EXPECT_EQ(classify(0.0184, 0.0184), GroundClass::StepDown);
  EXPECT_EQ(classify_literal(0.0184, 0.0184),
            bit(GroundClass::StepDown) | bit(GroundClass::SlopeUp));
  EXPECT_EQ(classify(0.0081, 0.0049), GroundClass::Pending);
  EXPECT_EQ(classify_literal(0.0081, 0.0049), 0U);
}

/// Of a square of 15 cm, a fifth matches two printed rules or more, and 6 % none.
TEST(GroundClass, PrintedRulesAreNeitherDistinctNorComplete) {
  constexpr int kSteps = 600;
  constexpr double kHalf = 0.075;  // [m] of the plane
  int several = 0;
  int none = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int k = 0; k < kSteps; ++k) {
      const double a = kHalf * (2 * (i + 0.5) / kSteps - 1);
      const double b = kHalf * (2 * (k + 0.5) / kSteps - 1);
      const unsigned found = classify_literal(a, b);
      if (found == 0) ++none;
      if ((found & (found - 1)) != 0) ++several;
    }
  }
  EXPECT_NEAR(several / double{kSteps * kSteps}, 0.21, 0.01);
  EXPECT_NEAR(none / double{kSteps * kSteps}, 0.06, 0.01);
}

TEST(PsdCurve, InvertsWithinItsRange) {
  for (double distance = 0.10; distance <= 0.80; distance += 0.01) {
    EXPECT_NEAR(algo::psd_distance(algo::psd_voltage(distance)), distance, 1e-12);
  }
  EXPECT_NEAR(algo::psd_voltage(0.10), 2.38, 0.005);  // sensors.md 7
  EXPECT_NEAR(algo::psd_voltage(0.80), 0.39, 0.005);
}

TEST(PsdCurve, RefusesVoltagesOutsideIt) {
  EXPECT_TRUE(std::isnan(algo::psd_distance(0.34)));
  EXPECT_TRUE(std::isnan(algo::psd_distance(2.46)));
  EXPECT_TRUE(std::isnan(algo::psd_distance(kNaN)));
  EXPECT_FALSE(std::isnan(algo::psd_distance(0.36)));
}

TEST(PsdCurve, FoldsBackForNearSurfaces) {
  EXPECT_NEAR(algo::psd_distance(algo::psd_voltage(0.04)), 0.20, 1e-12);
  EXPECT_TRUE(std::isnan(algo::psd_distance(algo::psd_voltage(0.08))));
}

TEST(PsdCurve, ConvertsWithTwelveBits) {
  EXPECT_EQ(algo::psd_counts(-1), 0);
  EXPECT_EQ(algo::psd_counts(kNaN), 0);
  EXPECT_EQ(algo::psd_counts(1.25), 2048);
  EXPECT_EQ(algo::psd_counts(9), 4095);
  for (std::uint16_t counts = 600; counts < 4095; ++counts) {
    EXPECT_EQ(algo::psd_counts(algo::psd_voltage_of(counts)), counts);
  }
}

TEST(GroundValue, FollowsTheGeometry) {
  const double alpha = 45_deg;
  EXPECT_NEAR(algo::ground_height(0.1816, 0.20, alpha), 0.0130, 1e-4);
  EXPECT_NEAR(algo::trench_width(0.2184, 0.20, alpha), 0.0130, 1e-4);
  // Both beams on a surface at th: X1 - X2 = L cot(alpha + th).
  for (const double slope : {-20_deg, -10_deg, 0_deg, 10_deg, 20_deg}) {
    EXPECT_NEAR(
        algo::ground_slope(0.3 + 0.08 / std::tan(alpha + slope), 0.3, 0.08, alpha), slope, 1e-12);
  }
}

TEST(ClassVote, CountsATrenchBeforeTheMajority) {
  algo::ClassVote vote;
  for (int k = 0; k < 14; ++k) vote.add(GroundClass::Flat);
  for (int k = 0; k < 5; ++k) vote.add(GroundClass::Trench);
  EXPECT_EQ(vote.winner(), GroundClass::Flat);
  vote.add(GroundClass::Trench);
  EXPECT_EQ(vote.winner(), GroundClass::Trench);
  EXPECT_EQ(vote.trials(), algo::kGroundTrials);
}

}  // namespace
