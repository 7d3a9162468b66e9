// sim/infrared_model.hpp: what an infrared range scanner reports of a world.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/random.hpp"
#include "sim/sensor.hpp"

namespace sim {

/// What is wrong with the configuration as a sentence part, or nothing.
std::optional<std::string> defect(const InfraredConfig& config);

/// Scan n is taken at (n + phase) x period [s, run clock], all beams at once; the phase is drawn
/// once a run, so that two scanners do not fire together.
class InfraredModel final : public CastingSensor {
 public:
  /// Scanner `index` of a run with `seed`. Throws std::invalid_argument with the defect.
  InfraredModel(const InfraredConfig& config, std::uint64_t seed, std::uint32_t index);

  void sense(const Surroundings& around, algo::Observation& observation) override {
    sense(around.stamp, around.trail, observation.infrared);
  }
  double memory() const override { return config_.period; }

  /// Appends the readings of the newest scan taken by `now` [s, run clock], unless it was reported
  /// before.
  void sense(double now, const PoseTrail& trail, algo::Recycled<algo::RangeReading>& readings);

 private:
  InfraredConfig config_{};
  BeamPattern fan_{};
  Random noise_;
  double phase_ = 0;                     // [s]
  std::int64_t scans_ = 0;               // reported, or passed over
  std::vector<algo::Pose2> mounts_R_{};  // of the beams
  std::vector<double> ranges_{};
  std::vector<std::uint32_t> hits_{};
  std::vector<double> errors_{};
};

}  // namespace sim
