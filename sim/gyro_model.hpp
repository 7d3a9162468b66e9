// sim/gyro_model.hpp: the model of a yaw gyro.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/random.hpp"
#include "sim/sensor_configs.hpp"

namespace sim {

/// The defect of the configuration as part of a sentence, or nothing.
std::optional<std::string> defect(const GyroConfig& config);

class GyroModel {
 public:
  /// Throws std::invalid_argument with the defect.
  GyroModel(const GyroConfig& config, std::uint64_t seed);

  /// [rad/s] The reading at the true `rate` [rad/s], `dt` [s] after the previous one.
  double read(double rate, double dt);

 private:
  GyroConfig config_{};
  Random random_;
  double bias_ = 0;  // [rad/s]
};

}  // namespace sim
