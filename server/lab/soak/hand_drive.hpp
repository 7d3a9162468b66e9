// server/lab/soak/hand_drive.hpp: a simulated robot that somebody drives by hand.
#pragma once

#include <cstdint>
#include <optional>

#include "algo/pipeline/pipeline.hpp"
#include "sim/world.hpp"

namespace server::soak {

/// A world and the pipeline of its robot. Throws std::invalid_argument with a sentence if there can
/// be no such world.
class HandDrive {
 public:
  static constexpr double kWordEvery = 0.1;  // [s] between two words of the stick

  HandDrive(const sim::Scenario& scenario, std::uint64_t seed);
  /// The same, but the pipeline takes the robot to stand as `believed`; nothing: it takes it for a
  /// robot that cannot turn over.
  HandDrive(const sim::Scenario& scenario,
            std::uint64_t seed,
            const std::optional<algo::Stance>& believed);

  /// One period. The robot hears `stick` every kWordEvery; where its mode is refused, guarded.
  void tick(algo::Joystick stick);
  /// The same stick for `seconds`.
  void hold(const algo::Joystick& stick, double seconds);

  /// The stick that the robot has heard last.
  const algo::Joystick& heard() const { return pipeline_.intent().stick; }
  const algo::RobotSpec& spec() const { return world_.spec(); }
  const algo::Observation& observation() const { return t_.observation; }
  const algo::GroundTruth& truth() const { return truth_; }
  bool overturned() const { return world_.overturned(); }
  const sim::VehicleState& state() const { return world_.state(); }
  /// The newest tick, but for its observation, which is already the next one's.
  const algo::Telemetry& telemetry() const { return t_; }

 private:
  void begin();

  sim::World world_;
  algo::Pipeline pipeline_;
  algo::Telemetry t_{};
  algo::GroundTruth truth_{};
  double next_word_ = 0;  // [s] run clock
};

}  // namespace server::soak
