// tests/algo/laser_scan_test.cpp: packed beams of a scan, all at once and one by one.
#include "algo/laser_scan.hpp"

#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace algo {
namespace {

TEST(LaserScan, AllBeamsAtOnceAreTheSameAsOneByOne) {
  std::mt19937_64 random(3);
  const std::vector<double> odd = {0,
                                   -0.0,
                                   -1,
                                   0.0005,
                                   0.0015,
                                   1e-300,
                                   65.5185,
                                   65.519,
                                   65.5195,
                                   70,
                                   1e300,
                                   std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::quiet_NaN()};
  for (const std::size_t beams : {0U, 1U, 7U, 8U, 9U, 181U, 361U, 401U}) {
    LaserScan scan;
    scan.range_max = 8.191;
    scan.resize(beams);
    for (std::size_t i = 0; i < beams; ++i) {
      const std::uint64_t kind = random() % 40;
      if (kind == 0) {
        scan.set_free(i);
      } else if (kind == 1) {
        scan.set_invalid(i, static_cast<BeamCode>(random() % 16));
      } else if (kind < 8) {
        scan.set_ok(i, odd[random() % odd.size()]);
      } else {
        scan.set_ok(i, 8.2 * static_cast<double>(random() >> 11U) * 0x1p-53);
      }
    }
    std::vector<std::uint16_t> all(beams);
    pack_beams(scan, all);
    for (std::size_t i = 0; i < beams; ++i) EXPECT_EQ(all[i], pack_beam(scan, i)) << i;
  }
}

}  // namespace
}  // namespace algo
