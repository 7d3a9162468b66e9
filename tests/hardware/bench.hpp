// tests/hardware/bench.hpp: the whole hardware path without hardware: an emulated robot, the real
// drivers on its ports, and a record of both sides.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/serial_robot.hpp"
#include "server/emulate/emulation.hpp"
#include "server/record/headless.hpp"

namespace server::hardware {

struct BenchOptions {
  std::string scenario = "exp1";
  emulate::BaseKind base = emulate::BaseKind::Roboteq;
  std::uint64_t seed = 1;
  std::filesystem::path folder{};
  double damage = 0;                   // of telegrams
  std::optional<algo::Vec2> goal_W{};  // instead of the scenario's
  double watchdog = 0.5;
};

/// A scan as the emulator sent it, and its fate.
struct SentLine {
  std::uint64_t number = 0;
  double time = 0;  // [s] machine time
  std::string fate{};
  std::vector<std::uint16_t> beams{};
};
struct WheelLine {
  double time = 0;
  double left = 0, right = 0;  // [mm/s]
};
struct PoseLine {
  double time = 0;
  algo::Pose2 pose_W{};
};
/// The emulator's record.
struct Truth {
  std::vector<SentLine> scans{};
  std::vector<WheelLine> wheels{};
  std::vector<PoseLine> poses{};
};
Truth read_truth(const std::filesystem::path& record);

/// Emulated devices in the world of a scenario and a SerialRobot on them.
class Bench {
 public:
  explicit Bench(const BenchOptions& options);
  ~Bench();

  const RunSpec& spec() const { return spec_; }
  drivers::SerialRobot& robot() { return *robot_; }
  emulate::Emulation& emulation() { return *emulation_; }
  std::filesystem::path record() const { return options_.folder / "truth"; }
  std::filesystem::path database() const { return options_.folder / "runs.db"; }

  /// Drives to the goal or until `stop`; arms as soon as possible. Stored in database().
  HeadlessResult drive(const std::stop_token& stop);
  /// Arms once that is possible; false after `seconds`.
  bool arm(double seconds);
  /// Waits for `condition`; false after `seconds`.
  static bool wait_for(const std::function<bool()>& condition, double seconds);

 private:
  BenchOptions options_;
  std::unique_ptr<emulate::Emulation> emulation_{};
  std::shared_ptr<drivers::SerialRobot> robot_{};
  RunSpec spec_{};
};

}  // namespace server::hardware
