// drivers/serial_robot.cpp: each tick: judge, command, wait, sense.
#include "drivers/serial_robot.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "algo/diff_drive.hpp"
#include "algo/explain.hpp"
#include "drivers/lms200_device.hpp"
#include "drivers/serial_base.hpp"

namespace drivers {
namespace {

using algo::Halt;

constexpr double kBatteryTime = 3.0;  // [s] a voltage may sag when the motors start
constexpr double kStallTime = 0.5;    // [s]
constexpr double kMotorsTime = 2.0;   // [s] from arming until they must be on
constexpr double kLateHold = 1.0;     // [s] the robot stands after a late tick
constexpr double kSonarMax = 5.0;     // [m] a Pioneer's, and its word for nothing

/// Somebody has to look at these before the robot may go on.
bool needs_a_person(Halt halt) {
  return halt == Halt::StopButton || halt == Halt::BaseFault || halt == Halt::OverCurrent ||
         halt == Halt::BatteryLow;
}

/// `pose`, given in the frame that `origin` is given in, as seen from `origin`.
algo::Pose2 seen_from(const algo::Pose2& origin, const algo::Pose2& pose) {
  const algo::Vec2 d = pose.position() - origin.position();
  const double c = std::cos(origin.heading);
  const double s = std::sin(origin.heading);
  return {c * d.x() + s * d.y(),
          -s * d.x() + c * d.y(),
          algo::wrap_angle(pose.heading - origin.heading)};
}

/// How long `condition` has held: sets `since` when it begins, clears it when it ends.
bool lasts(bool condition, double now, double time, double& since) {
  if (!condition) since = 0;
  if (condition && since == 0) since = now;
  return condition && now - since > time;
}

}  // namespace

SerialRobot::SerialRobot(RobotFile file,
                         std::vector<std::unique_ptr<Scanner>> scanners,
                         std::unique_ptr<Base> base,
                         std::unique_ptr<Clock> clock)
    : file_(std::move(file)),
      scanners_(std::move(scanners)),
      base_(std::move(base)),
      clock_(std::move(clock)) {
  epoch_ = deadline_ = sensed_at_ = clock_->now();
}

SerialRobot::~SerialRobot() {
  disarm();
}

void SerialRobot::become_real_time() {
  name_this_thread("control");
  ask_for_punctual_timers();
  const bool priority = request_real_time(kControlPriority);
  const std::lock_guard lock(mutex_);
  real_time_ = priority;
}

void SerialRobot::reset(algo::Observation& observation) {
  disarm();
  become_real_time();
  const double now = clock_->now();
  epoch_ = deadline_ = sensed_at_ = now;
  late_until_ = battery_low_since_ = stalled_since_ = 0;
  missed_.store(0);
  origin_ = base_->state().pose;
  {
    const std::lock_guard lock(mutex_);
    lateness_ = {};
    halted_since_ = 0;
  }
  observe(observation);
}

// ---- what stops the wheels -------------------------------------------------------------------

Halt SerialRobot::base_halt(const BaseState& base, double now) {
  if (!base.running || now - base.stamp > kBaseTimeout) return Halt::BaseLost;
  if (base.stop_button) return Halt::StopButton;
  if (base.faulty) return Halt::BaseFault;
  if (base.over_current) return Halt::OverCurrent;
  if (lasts(base.stalled, now, kStallTime, stalled_since_)) return Halt::OverCurrent;
  const double least = file_.base.battery_low;
  const bool low = least > 0 && base.volts && *base.volts < least;
  if (lasts(low, now, kBatteryTime, battery_low_since_)) return Halt::BatteryLow;
  return Halt::None;
}

Halt SerialRobot::scanner_halt(double now) {
  for (const auto& scanner : scanners_) {
    const ScannerState state = scanner->state();
    if (state.faulty) return Halt::ScannerFault;
    const double limit = kScanPeriods * state.period + kArrivalJitter;
    if (!state.running || now - state.last_scan > limit) return Halt::ScannerLost;
    if (state.bad_line) return Halt::BadLine;
  }
  return Halt::None;
}

/// The worst first; a robot that is well and not armed is disarmed.
Halt SerialRobot::judge(const BaseState& base, double now) {
  Halt halt = base_halt(base, now);
  if (halt == Halt::None) halt = scanner_halt(now);
  if (halt == Halt::None && now < late_until_) halt = Halt::LateTick;
  bool armed = false;
  double armed_at = 0;
  std::uint32_t set_up = 0;
  {
    const std::lock_guard lock(mutex_);
    armed = armed_;
    armed_at = armed_at_;
    set_up = armed_set_up_;
  }
  if (armed && base.running && base.set_ups != set_up) {
    disarm("The base was lost and found again. Arm it again when all is well.");
    armed = false;
  }
  if (halt == Halt::None && !armed) halt = Halt::Disarmed;
  if (halt == Halt::None && !base.motors_on) {
    halt = Halt::MotorsOff;
    if (now - armed_at > kMotorsTime) {
      disarm("The motors did not stay on. Look at the base, then arm it again.");
      halt = Halt::Disarmed;
    }
  }
  latch(halt, now);
  return halt;
}

/// Notes `halt`, and disarms where the robot must not go on by itself.
void SerialRobot::latch(Halt halt, double now) {
  bool too_long = false;
  bool armed = false;
  {
    const std::lock_guard lock(mutex_);
    halt_ = halt;
    armed = armed_;
    too_long = lasts(halt != Halt::None && halt != Halt::MotorsOff, now, kRearm, halted_since_);
  }
  if (!armed || (!needs_a_person(halt) && !too_long)) return;
  const char* advice = halt == Halt::StopButton ? "" : " Arm it again when all is well.";
  // It stands there until somebody arms, and by then the trouble may be over.
  disarm("Motors off. What happened: " + algo::explain(halt).why + advice);
}

/// `command`, or as much of it as may be carried out.
algo::Twist2 SerialRobot::permitted(const algo::Command& command,
                                    const BaseState& base,
                                    Halt halt) const {
  if (halt != Halt::None) return {};
  algo::Twist2 twist = limited(command.base, file_.limits);
  // Away from what was hit, straight, and no faster than a person walks slowly.
  constexpr double kBackingOff = 0.1;  // [m/s]
  if (base.bumper_front) twist = {std::clamp(twist.v, -kBackingOff, 0.0), 0};
  if (base.bumper_rear)
    twist = {std::clamp(twist.v, 0.0, base.bumper_front ? 0.0 : kBackingOff), 0};
  return twist;
}

// ---- the tick --------------------------------------------------------------------------------

bool SerialRobot::step(const algo::Command& command, algo::Observation& observation) {
  const double now = clock_->now();
  // A command that was decided on what was sensed long ago is none.
  if (now - sensed_at_ > kOverrun * file_.spec.period) late_until_ = now + kLateHold;
  const BaseState base = base_->state();
  const Halt halt = judge(base, now);
  base_->drive(permitted(command, base, halt));
  wait_for_deadline(now);
  observe(observation);
  return true;
}

/// Absolute deadlines: lateness of less than a period does not delay the next. Whole periods that
/// went by are counted and left out.
void SerialRobot::wait_for_deadline(double now) {
  const double period = file_.spec.period;
  deadline_ += period;
  if (now - deadline_ >= period) {
    const double skipped = std::floor((now - deadline_) / period);
    deadline_ += skipped * period;
    missed_.fetch_add(static_cast<std::uint64_t>(skipped), std::memory_order_relaxed);
  }
  clock_->sleep_until(deadline_);
  const double late = std::max(0.0, clock_->now() - deadline_);
  const std::lock_guard lock(mutex_);
  lateness_.add(late);
}

void SerialRobot::observe(algo::Observation& observation) {
  const double now = clock_->now();
  sensed_at_ = now;
  observation.clear_sensors();
  observation.stamp = now - epoch_;
  const BaseState base = base_->state();
  observation.halt = judge(base, now);
  observe_base(base, now, observation);
  for (std::size_t i = 0; i < scanners_.size(); ++i) {
    algo::LaserScan& scan = observation.scans.append();
    if (!scanners_[i]->take(scan)) {
      observation.scans.pop_back();
      continue;
    }
    scan.mount_R = file_.lasers[i].mount_R;
    scan.stamp -= epoch_;
    algo::quantise(scan);
  }
}

void SerialRobot::observe_base(const BaseState& base,
                               double now,
                               algo::Observation& observation) const {
  const double stamp = base.stamp - epoch_;
  // Where the robot is now, not where it was when the base last said so: a tenth of a second in a
  // turn is as far as the nearest obstacle's bearing moves while a controller makes up its mind.
  const double age = base.running ? std::clamp(now - base.stamp, 0.0, kBaseTimeout) : 0.0;
  const algo::Pose2 pose = algo::integrate_arc(base.pose, base.twist, age);
  observation.odometry = {stamp + age, seen_from(origin_, pose), base.twist};
  if (base.counts) {
    observation.encoders = algo::Encoders{stamp, (*base.counts)[0], (*base.counts)[1]};
  }
  const double edge = file_.spec.half_length > 0 ? file_.spec.half_length : file_.spec.radius;
  observation.bumpers.push_back({{edge, 0, 0}, stamp, base.bumper_front});
  observation.bumpers.push_back({{-edge, 0, std::numbers::pi}, stamp, base.bumper_rear});
  const auto& mounts = file_.base.sonar_mounts_R;
  for (std::size_t i = 0; i < std::min(base.sonar_count, mounts.size()); ++i) {
    const BaseSonar& sonar = base.sonars[i];
    if (sonar.stamp == 0) continue;
    const bool hit = sonar.range < kSonarMax;
    observation.sonar.push_back({mounts[i],
                                 sonar.stamp - epoch_,
                                 hit ? sonar.range : kSonarMax,
                                 kSonarMax,
                                 hit ? algo::Beam::Ok : algo::Beam::Free});
  }
}

void SerialRobot::stop() noexcept {
  base_->stop();
}

std::optional<std::string> SerialRobot::edit(const algo::Request& request) {
  const bool obstacle = std::holds_alternative<algo::AddObstacle>(request) ||
                        std::holds_alternative<algo::MoveObstacle>(request) ||
                        std::holds_alternative<algo::RemoveObstacle>(request);
  if (!obstacle) return std::nullopt;
  return "This is real hardware: obstacles are put in its way by hand.";
}

// ---- arming ----------------------------------------------------------------------------------

std::optional<std::string> SerialRobot::arm() {
  const BaseState base = base_->state();
  Halt halt = Halt::None;
  {
    const std::lock_guard lock(mutex_);
    halt = halt_;
    if (armed_) return std::nullopt;
  }
  if (halt != Halt::Disarmed && halt != Halt::None) {
    return "It cannot be armed now. " + report().trouble;
  }
  const double now = clock_->now();
  base_->enable(true);
  const std::lock_guard lock(mutex_);
  armed_ = true;
  armed_at_ = now;
  armed_set_up_ = base.set_ups;
  halted_since_ = 0;
  disarmed_because_.clear();
  return std::nullopt;
}

void SerialRobot::disarm(const std::string& why) {
  {
    const std::lock_guard lock(mutex_);
    armed_ = false;
    disarmed_because_ = why;
  }
  base_->stop();
  base_->enable(false);
}

void SerialRobot::note_memory_locked(bool locked) {
  const std::lock_guard lock(mutex_);
  memory_locked_ = locked;
}

HardwareReport SerialRobot::report() {
  HardwareReport out;
  for (const auto& scanner : scanners_) out.devices.push_back(scanner->report());
  out.devices.push_back(base_->report());
  out.warnings = file_.warnings;
  out.missed_periods = missed_periods();
  const std::lock_guard lock(mutex_);
  out.armed = armed_;
  out.halt = halt_;
  out.trouble = words(halt_, out.devices);
  out.real_time = real_time_;
  out.memory_locked = memory_locked_;
  out.lateness = lateness_;
  return out;
}

/// The device's own words where one is to blame.
std::string SerialRobot::words(Halt halt, const std::vector<DeviceReport>& devices) const {
  if (halt == Halt::None) return "";
  if (halt == Halt::Disarmed && !disarmed_because_.empty()) return disarmed_because_;
  const bool of_base = halt == Halt::BaseLost || halt == Halt::StopButton ||
                       halt == Halt::BaseFault || halt == Halt::OverCurrent;
  const bool of_scanner =
      halt == Halt::ScannerLost || halt == Halt::ScannerFault || halt == Halt::BadLine;
  for (const DeviceReport& device : devices) {
    const bool base = device.name == "base";
    if (device.well || !(base ? of_base : of_scanner)) continue;
    return "The " + device.name + " at " + device.port + ": " + device.sentence;
  }
  return algo::explain(halt).why;
}

// ---- from a file -----------------------------------------------------------------------------

std::shared_ptr<SerialRobot> open_robot(const RobotFile& file) {
  std::vector<std::unique_ptr<Scanner>> scanners;
  scanners.reserve(file.lasers.size());
  for (const LaserEntry& laser : file.lasers) {
    scanners.push_back(std::make_unique<lms200::Lms200Device>(laser.name, laser.port, laser.setup));
  }
  std::unique_ptr<BaseMachine> machine = std::visit(
      [](const auto& setup) -> std::unique_ptr<BaseMachine> {
        using Setup = std::decay_t<decltype(setup)>;
        if constexpr (std::is_same_v<Setup, p2os::PioneerSetup>) {
          return std::make_unique<p2os::PioneerMachine>(setup);
        } else {
          return std::make_unique<roboteq::RoboteqMachine>(setup);
        }
      },
      file.base.setup);
  return std::make_shared<SerialRobot>(
      file,
      std::move(scanners),
      std::make_unique<SerialBase>(file.base.port, std::move(machine)),
      std::make_unique<SteadyClock>());
}

}  // namespace drivers
