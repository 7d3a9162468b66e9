// sim/gyro_model.hpp: what a yaw gyro reads.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/random.hpp"
#include "sim/sensor_configs.hpp"

namespace sim {

/// What is wrong with the configuration as a sentence part, or nothing.
std::optional<std::string> defect(const GyroConfig& config);

class GyroModel {
 public:
  /// Throws std::invalid_argument with the defect.
  GyroModel(const GyroConfig& config, std::uint64_t seed);

  /// [rad/s] The reading at the true `rate` [rad/s], `dt` [s] after the one before.
  double read(double rate, double dt);

 private:
  GyroConfig config_{};
  Random random_;
  double bias_ = 0;  // [rad/s]
};

}  // namespace sim
