// sim/infrared_model.hpp: the model of an infrared range scanner.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/random.hpp"
#include "sim/sensor.hpp"

namespace sim {

/// The defect of the configuration as part of a sentence, or nothing.
std::optional<std::string> defect(const InfraredConfig& config);

/// Takes scan n at (n + phase) x period [s, run clock], all beams at once. The phase is drawn once
/// per run, so that two scanners do not fire together.
class InfraredModel final : public CastingSensor {
 public:
  /// Scanner `index` of a run with `seed`. Throws std::invalid_argument with the defect.
  InfraredModel(const InfraredConfig& config, std::uint64_t seed, std::uint32_t index);

  void sense(const Surroundings& around, algo::Observation& observation) override {
    sense(around.stamp, around.trail, observation.infrared, around.solids);
  }
  double memory() const override { return config_.period; }

  /// Appends the readings of the newest scan taken by `now` [s, run clock], unless already
  /// reported. With `solids`, the ground is not level, and the fan tilts with the robot.
  void sense(double now,
             const PoseTrail& trail,
             algo::Recycled<algo::RangeReading>& readings,
             const SolidCaster* solids = nullptr);

 private:
  void cast_in_space(double stamp, const PoseTrail& trail, const SolidCaster& solids);

  InfraredConfig config_{};
  BeamPattern fan_{};
  Random noise_;
  double phase_ = 0;                     // [s]
  std::int64_t scans_ = 0;               // reported or skipped
  std::vector<algo::Pose2> mounts_R_{};  // of the beams
  std::vector<double> ranges_{};
  std::vector<std::uint32_t> hits_{};
  std::vector<double> errors_{};
};

}  // namespace sim
