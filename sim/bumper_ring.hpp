// sim/bumper_ring.hpp: bumpers spaced evenly around the hull, from straight ahead.
#pragma once

#include <cstdint>

#include "sim/sensor.hpp"

namespace sim {

/// A contact presses the bumper whose sector it lies in.
class BumperRing final : public Sensor {
 public:
  /// `count` at least 1, on a hull of `radius` [m].
  BumperRing(std::uint32_t count, double radius) : count_(count), radius_(radius) {}

  void sense(const Surroundings& around, algo::Observation& observation) override;

 private:
  std::uint32_t count_ = 1;
  double radius_ = 0;  // [m]
};

}  // namespace sim
