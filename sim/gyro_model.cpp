// sim/gyro_model.cpp: a drifting bias, and noise.
#include "sim/gyro_model.hpp"

#include <array>
#include <cmath>
#include <span>

#include "sim/sensor.hpp"

namespace sim {
namespace {

constexpr std::uint64_t kGyroPurpose = 0x4759524f;  // of its errors: unlike any other sensor's

}  // namespace

std::optional<std::string> defect(const GyroConfig& config) {
  if (!within(config.bias, 0, 1)) return "bias must be 0 to 1 rad/s";
  if (!within(config.bias_walk, 0, 1)) return "bias_walk must be 0 to 1 rad/s";
  if (!within(config.noise, 0, 1)) return "noise must be 0 to 1 rad/s";
  return std::nullopt;
}

GyroModel::GyroModel(const GyroConfig& config, std::uint64_t seed)
    : config_(checked(config, "Gyro")), random_(seed, kGyroPurpose) {
  double draw = 0;
  random_.fill_normal(std::span(&draw, 1));
  bias_ = config_.bias * draw;
}

double GyroModel::read(double rate, double dt) {
  std::array<double, 2> draws{};
  random_.fill_normal(draws);
  bias_ += config_.bias_walk * std::sqrt(dt) * draws[0];
  return rate + bias_ + config_.noise * draws[1];
}

}  // namespace sim
