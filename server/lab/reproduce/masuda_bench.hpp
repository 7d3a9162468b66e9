// server/lab/reproduce/masuda_bench.hpp: the experiments of Masuda et al. 2008: four simulated
// sensors before a step, a slope or a trench, at rest or carried over it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "algo/filter/causal_median.hpp"
#include "algo/obstacle.hpp"
#include "algo/terrain/ground_class.hpp"
#include "sim/sensor_configs.hpp"

namespace server::reproduce {

/// One piece of ground. Its edge is at x = 0; the robot comes from x < 0 along the x axis.
struct MasudaGround {
  algo::GroundClass kind = algo::GroundClass::Flat;
  double size = 0;  // [m] height of a step, up positive, or width and depth of a trench;
                    // [rad] of a slope, up positive
  double skew = 0;  // [rad] of the edge from square to the robot's way
  /// The obstacles that make it.
  std::vector<algo::Obstacle> obstacles() const;
  /// [m] Height of the floor that the robot stands on.
  double floor() const;
};

/// How the readings are taken for the paper's formulas.
struct MasudaReading {
  bool literal = false;    // the printed rules, D[N/2] of an odd window, and means of all values
  std::size_t window = 5;  // of the median: N1, NI
  algo::GroundThresholds limits{};
  algo::MedianRank rank() const {
    return literal ? algo::MedianRank::Literal : algo::MedianRank::Corrected;
  }
};

/// The mean, the ends and the variance of some trials.
struct MasudaSpread {
  std::size_t count = 0;
  double mean = 0, max = 0, min = 0, variance = 0;
};
MasudaSpread spread_of(const std::vector<double>& values);

/// The paper's sensors: L 8 cm, X2o 20 cm, 45 degrees, at the front of the robot.
sim::FloorSensorConfig masuda_sensors(bool grazing);

/// Section 4.3: `trials` values at rest, the front edge `d1` [m] before the foot: heights [m] of a
/// step, angles [rad] of a slope. Each trial fills a median anew.
std::vector<double> static_trials(const MasudaGround& ground,
                                  double d1,
                                  const MasudaReading& reading,
                                  std::size_t trials,
                                  std::uint64_t seed);

/// One drive of section 5, 2 mm from one reading to the next.
struct MasudaDrive {
  algo::GroundClass found = algo::GroundClass::Flat;  // by the vote of 20 trials
  bool alarm = false;                                 // some look was neither flat nor pending
  double value = 0;  // [m] or [rad], as MasudaGround::size; of a trench, Eq. 13's depth
};
MasudaDrive drive_over(const MasudaGround& ground,
                       const MasudaReading& reading,
                       std::uint64_t seed);

/// The readings of one drive, for a picture.
struct MasudaTrace {
  std::vector<double> way{};                    // [m] of the near beam's foot past the edge
  std::array<std::vector<double>, 4> raw{};     // [m] far left, far right, near left, near right
  std::array<std::vector<double>, 4> smooth{};  // after the median
};
MasudaTrace trace_over(const MasudaGround& ground, double from, double to, std::uint64_t seed);

}  // namespace server::reproduce
