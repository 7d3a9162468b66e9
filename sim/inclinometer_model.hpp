// sim/inclinometer_model.hpp: roll and pitch with a lag and noise.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/random.hpp"
#include "sim/sensor.hpp"

namespace sim {

/// The defect of the configuration as part of a sentence, or nothing.
std::optional<std::string> defect(const InclinometerConfig& config);

/// A first-order lag of the true attitude, which it has at rest, and Gaussian noise on either
/// angle.
class InclinometerModel final : public Sensor {
 public:
  /// Throws std::invalid_argument with the defect.
  InclinometerModel(const InclinometerConfig& config, std::uint64_t seed);

  void sense(const Surroundings& around, algo::Observation& observation) override;

 private:
  InclinometerConfig config_{};
  Every every_;
  Random noise_;
  std::optional<double> stamp_{};  // [s] of the newest tick
  double roll_ = 0;                // [rad] after the lag
  double pitch_ = 0;
};

}  // namespace sim
