// tests/algo/pipeline/rear_watch_test.cpp: which sensors look back, and for how long.
#include "algo/pipeline/rear_watch.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "algo/units.hpp"

namespace {

using namespace algo::units;
using algo::Beam;
using algo::Observation;
using algo::RearWatch;

/// A scanner of `field` [rad] about `heading`, all beams free.
void add_scan(Observation& seen, double heading, double field) {
  algo::LaserScan& scan = seen.scans.append();
  scan = {};
  scan.mount_R.heading = heading;
  scan.stamp = seen.stamp;
  scan.angle_min = -field / 2;
  scan.angle_increment = 1_deg;
  scan.range_max = 8;
  scan.resize(static_cast<std::size_t>(field / 1_deg) + 1);
  for (std::size_t i = 0; i < scan.size(); ++i) scan.set_free(i);
}

void add_sonars(Observation& seen, double from, double to, double step) {
  for (double at = from; at < to + 1e-9; at += step) {
    seen.sonar.push_back({{0, 0, algo::wrap_angle(at)}, seen.stamp, 5, 5, Beam::Free});
  }
}

bool looks(const Observation& seen, double later = 0) {
  RearWatch watch;
  watch.take(seen);
  return watch.looks(seen.stamp + later);
}

TEST(RearWatch, AForwardScannerDoesNotLookBack) {
  Observation seen;
  EXPECT_FALSE(looks(seen));
  add_scan(seen, 0, 180_deg);
  EXPECT_FALSE(looks(seen));
}

TEST(RearWatch, ARearScannerAndAFullTurnScannerLookBack) {
  for (const auto& [heading, field] :
       {std::array{180_deg, 180_deg}, {-170_deg, 180_deg}, {180_deg, 100_deg}, {0.0, 359_deg}}) {
    Observation seen;
    seen.stamp = 3;
    add_scan(seen, heading, field);
    EXPECT_TRUE(looks(seen)) << heading;
    EXPECT_TRUE(looks(seen, RearWatch::kMemory - 0.01));
    EXPECT_FALSE(looks(seen, RearWatch::kMemory + 0.01)) << "it has fallen silent";
  }
}

TEST(RearWatch, AWideScannerIsNotAFullTurn) {
  Observation seen;
  add_scan(seen, 0, 270_deg);
  EXPECT_FALSE(looks(seen));
}

TEST(RearWatch, ADazzledSectorIsUnseen) {
  Observation seen;
  add_scan(seen, 180_deg, 180_deg);
  algo::LaserScan& scan = seen.scans[0];
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (std::abs(scan.angle(i)) < 16_deg) scan.set_invalid(i, algo::BeamCode::Dazzled);
  }
  EXPECT_FALSE(looks(seen));
}

TEST(RearWatch, AFullSonarRingLooksBackAndItsFrontHalfDoesNot) {
  Observation ring;
  add_sonars(ring, 0, 330_deg, 30_deg);
  EXPECT_TRUE(looks(ring));
  Observation ahead;
  add_sonars(ahead, -90_deg, 90_deg, 20_deg);
  EXPECT_FALSE(looks(ahead));
  Observation pioneer;  // its rear array
  add_sonars(pioneer, 90_deg, 90_deg, 20_deg);
  add_sonars(pioneer, 130_deg, 230_deg, 20_deg);
  EXPECT_TRUE(looks(pioneer));
}

}  // namespace
