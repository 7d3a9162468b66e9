// sim/inclinometer_model.cpp: the lag goes on every tick, readings come at the period.
#include "sim/inclinometer_model.hpp"

#include <array>
#include <cmath>

namespace sim {
namespace {

constexpr std::uint64_t kTiltPurpose = 0x54494c54;  // of its noise: unlike any other sensor's

}  // namespace

std::optional<std::string> defect(const InclinometerConfig& config) {
  if (!within(config.noise, 0, 1)) return "noise_deg must be 0 to 57";
  if (!within(config.lag, 0, 10)) return "lag must be 0 to 10 s";
  if (!within(config.period, 0, 10)) return "period must be 0 to 10 s";
  return std::nullopt;
}

InclinometerModel::InclinometerModel(const InclinometerConfig& config, std::uint64_t seed)
    : config_(checked(config, "Inclinometer")), every_(config.period), noise_(seed, kTiltPurpose) {}

void InclinometerModel::sense(const Surroundings& around, algo::Observation& observation) {
  const VehicleState& now = around.vehicle;
  const bool first = !stamp_;
  const double dt = first ? 0 : around.stamp - *stamp_;
  const double share = first || config_.lag == 0 ? 1 : 1 - std::exp(-dt / config_.lag);
  stamp_ = around.stamp;
  roll_ += share * (now.roll - roll_);
  pitch_ += share * (now.pitch - pitch_);
  observation.inclinometer.reset();  // in place of the ideal one
  if (!every_.due(around.stamp)) return;
  std::array<double, 2> draws{};
  noise_.fill_normal(draws);
  observation.inclinometer = algo::Inclinometer{
      around.stamp, roll_ + config_.noise * draws[0], pitch_ + config_.noise * draws[1]};
}

}  // namespace sim
