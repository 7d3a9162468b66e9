// drivers/serial_robot.hpp: scanners and a base as one algo::Robot, with its safety stops.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "algo/robot.hpp"
#include "drivers/base.hpp"
#include "drivers/clock.hpp"
#include "drivers/floor_sense.hpp"
#include "drivers/published_senses.hpp"
#include "drivers/real_time.hpp"
#include "drivers/robot_file.hpp"
#include "drivers/scanner.hpp"

namespace drivers {

/// Real devices behind algo::Robot. The wheels turn only while the robot is armed and has no fault.
/// A fault stops the base in the tick that detects it. A fault that ends within kRearm lets the
/// robot drive on. A longer one, or one that a person must check, disarms it: a robot that has
/// stood still for long must not drive off by itself.
///
/// reset() and step() belong to the control thread, the rest to any.
class SerialRobot final : public algo::Robot, public algo::Arming {
 public:
  static constexpr double kBaseTimeout = 0.3;     // [s] largest age of the base's newest report
  static constexpr double kScanPeriods = 3;       // without a scan, unless that is too long
  static constexpr double kArrivalJitter = 0.02;  // [s] a USB chip may hold bytes for 16 ms
  static constexpr double kOverrun = 3;           // periods from a tick's deadline to its command
  static constexpr double kSlept = 0.5;           // [s] likewise; longer: the program stood still
  static constexpr double kRearm = 0.5;  // [s] longer than one or two lost scans of a fast line

  /// Scanners in the order of the file, already running. `floor` may be null.
  SerialRobot(RobotFile file,
              std::vector<std::unique_ptr<Scanner>> scanners,
              std::unique_ptr<Base> base,
              std::unique_ptr<Clock> clock,
              std::unique_ptr<FloorSense> floor = nullptr);
  ~SerialRobot() override;
  SerialRobot(const SerialRobot&) = delete;
  SerialRobot& operator=(const SerialRobot&) = delete;

  const algo::RobotSpec& spec() const override { return file_.spec; }
  /// Disarms: a new run must not set the robot in motion.
  void reset(algo::Observation& observation) override;
  bool step(const algo::Command& command, algo::Observation& observation) override;
  void stop() noexcept override;
  algo::Arming* arming() override { return this; }
  algo::Publishing* publishing() override { return published_.any() ? &published_ : nullptr; }

  std::optional<std::string> arm() override;
  void disarm(const std::string& why) override;
  std::uint32_t epoch() const override;
  algo::HealthReport health() const override;
  /// Tells the report whether lock_memory() succeeded.
  void note_memory_locked(bool locked);
  const RobotFile& file() const { return file_; }

 private:
  /// A bumper, and whether it was pressed when the operator armed the robot.
  struct BumperWatch {
    bool known = false;
    double free_since = 0;  // [s]; 0: it is pressed
  };

  void become_real_time();
  algo::Halt base_halt(const BaseState& base, double now);
  algo::Halt scanner_halt(double now);
  algo::Halt floor_halt(double now);
  double longest_gap(double scan_period) const;
  algo::Halt judge(const BaseState& base, double now);
  bool wheels_obey(const BaseState& base);
  bool bumper_hit(const BaseState& base, double now);
  bool came_late(double now);
  void latch(algo::Halt halt, double now);
  void disarm_after(const std::string& fault);
  algo::Twist2 permitted(const algo::Command& command, const BaseState& base) const;
  std::optional<std::string> watchdog_refusal(const BaseState& base) const;
  std::string watchdog_warning(const BaseState& base) const;
  void wait_for_deadline(double now);
  void observe(algo::Observation& observation);
  void observe_base(const BaseState& base, double now, algo::Observation& observation) const;
  algo::Pose2 at_R(const algo::Pose2& wheels) const;
  void observe_floor(algo::Observation& observation);
  std::string words(algo::Halt halt, const std::vector<algo::DeviceReport>& devices) const;

  RobotFile file_;
  std::vector<std::unique_ptr<Scanner>> scanners_;
  std::unique_ptr<Base> base_;
  std::unique_ptr<Clock> clock_;
  std::unique_ptr<FloorSense> floor_;
  PublishedSenses published_;

  double epoch_ = 0;              // [s] steady clock at the run's time 0
  algo::Pose2 origin_{};          // of R at the start, in the base's own odometry frame
  double deadline_ = 0;           // [s]
  double late_until_ = 0;         // [s]
  double battery_low_since_ = 0;  // [s]; 0: it is not
  WheelWatch wheels_;
  std::atomic<std::uint64_t> missed_{0};

  mutable std::mutex mutex_{};  // guards what follows
  bool armed_ = false;
  std::uint32_t armings_ = 0;             // number of armings
  double armed_at_ = 0;                   // [s]
  std::uint32_t armed_set_up_ = 0;        // the base's set_ups at arming
  std::array<BumperWatch, 2> bumpers_{};  // front, rear
  std::string disarmed_because_{};
  algo::Halt halt_ = algo::Halt::Disarmed;
  double halted_since_ = 0;  // [s]; 0: it is not
  algo::LatenessHistogram lateness_{};
  bool real_time_ = false;
  bool memory_locked_ = false;
};

}  // namespace drivers
