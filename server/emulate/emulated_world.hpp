// server/emulate/emulated_world.hpp: a simulated world in real time with emulated devices.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include "drivers/emulators/base.hpp"
#include "drivers/emulators/lms200_emulator.hpp"
#include "drivers/emulators/psd_emulator.hpp"
#include "server/emulate/connection.hpp"
#include "server/emulate/floor_rays.hpp"
#include "server/emulate/mirror.hpp"
#include "server/emulate/sonar_ring.hpp"
#include "server/emulate/truth_record.hpp"
#include "sim/world.hpp"

namespace server::emulate {

/// Turns the wheels of the base and the mirrors of the scanners. The physics steps are those of a
/// pure simulation of the scenario, so that both differ only by the devices.
class EmulatedWorld {
 public:
  struct Links {
    std::vector<Served<drivers::lms200::Emulator>> scanners{};  // one per laser of the scenario
    std::optional<Served<drivers::emulators::Base>> base{};     // without a base the robot stands
    std::optional<Served<drivers::psd::Emulator>> floor{};      // sensors that look at the floor
  };
  struct Truth {
    double time = 0;  // [s] of the run clock
    algo::Pose2 pose_W{};
    double clearance = 0;  // [m]
    bool collided = false;
    std::uint64_t missed = 0;  // skipped physics steps
  };

  /// Throws std::exception with a sentence when the scenario cannot be run.
  EmulatedWorld(const sim::Scenario& scenario,
                std::uint64_t seed,
                Links links,
                TruthRecord& record);

  void start();
  Truth truth() const;
  /// Of the scenario's vehicle.
  const algo::RobotSpec& spec() const { return world_.spec(); }

 private:
  void run(const std::stop_token& stop);
  algo::Command command();
  void feel(const algo::Observation& observation, const algo::Pose2& pose_W, double due);
  void look(double now);
  void look_at_floor(double now, const algo::GroundTruth& truth);
  void note(double now, const algo::GroundTruth& truth);

  sim::Scenario scenario_{};
  Links links_{};
  TruthRecord& record_;
  double metres_per_count_ = 0;
  sim::World world_;
  std::uint64_t missed_ = 0;  // steps
  sim::PoseTrail trail_;
  std::vector<Mirror> mirrors_{};
  SonarRing sonars_;
  FloorRays floor_;

  algo::Encoders encoders_{};
  drivers::emulators::BaseSenses senses_{};
  drivers::emulators::WheelMotion motion_{};
  double next_note_ = 0;
  mutable std::mutex mutex_{};
  Truth truth_{};
  std::jthread thread_{};
};

}  // namespace server::emulate
