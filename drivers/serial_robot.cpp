// drivers/serial_robot.cpp: the steps of each tick: check, command, wait, sense.
#include "drivers/serial_robot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "algo/diff_drive.hpp"
#include "algo/explain.hpp"
#include "drivers/psd_device.hpp"

namespace drivers {
namespace {

using algo::Halt;

constexpr double kBatteryTime = 3.0;  // [s] the voltage may sag while the motors start
constexpr double kMotorsTime = 2.0;   // [s] from arming until the motors must be on
constexpr double kLateHold = 0.3;     // [s] the robot stands after a late tick
constexpr double kSonarMax = 5.0;     // [m] a Pioneer's; also its value for no echo
constexpr double kBumperFree = 0.5;   // [s] after which a bumper known to be pressed counts as free
constexpr double kLongestCoast = 2.0;  // [m] the robot may drive after the program has died

/// A person must check these before the robot may drive on.
bool needs_a_person(Halt halt) {
  return halt == Halt::StopButton || halt == Halt::BaseFault || halt == Halt::OverCurrent ||
         halt == Halt::BatteryLow;
}

/// [s] How long `condition` has held. Sets `since` when it begins, clears it when it ends.
bool lasts(bool condition, double now, double time, double& since) {
  if (!condition) since = 0;
  if (condition && since == 0) since = now;
  return condition && now - since > time;
}

/// What the inclinometer, which is one of `devices`, says of itself.
std::string tilt_words(const std::vector<algo::DeviceReport>& devices) {
  const auto tilt =
      std::ranges::find(devices, PublishedSenses::kInclinometer, &algo::DeviceReport::name);
  return "The inclinometer: " + tilt->sentence;
}

}  // namespace

SerialRobot::SerialRobot(RobotFile file,
                         std::vector<std::unique_ptr<Scanner>> scanners,
                         std::unique_ptr<Base> base,
                         std::unique_ptr<Clock> clock,
                         std::unique_ptr<FloorSense> floor)
    : file_(std::move(file)),
      scanners_(std::move(scanners)),
      base_(std::move(base)),
      clock_(std::move(clock)),
      floor_(std::move(floor)),
      published_(file_.published, file_.spec.line, *clock_),
      wheels_(base_->dynamics(), file_.spec.half_track) {
  epoch_ = deadline_ = clock_->now();
}

SerialRobot::~SerialRobot() {
  disarm("");
}

void SerialRobot::become_real_time() {
  name_this_thread("control");
  ask_for_punctual_timers();
  const bool priority = request_real_time(kControlPriority);
  const std::lock_guard lock(mutex_);
  real_time_ = priority;
}

void SerialRobot::reset(algo::Observation& observation) {
  disarm("");
  become_real_time();
  const double now = clock_->now();
  epoch_ = deadline_ = now;
  late_until_ = battery_low_since_ = 0;
  wheels_.restart();
  missed_.store(0);
  origin_ = at_R(base_->state().pose);
  {
    const std::lock_guard lock(mutex_);
    lateness_ = {};
    halted_since_ = 0;
  }
  observe(observation);
}

// ---- reasons to stop the wheels --------------------------------------------------------------

Halt SerialRobot::base_halt(const BaseState& base, double now) {
  if (!base.running || now - base.stamp > kBaseTimeout) return Halt::BaseLost;
  if (base.stop_button) return Halt::StopButton;
  if (base.faulty) return Halt::BaseFault;
  if (base.over_current || base.stalled) return Halt::OverCurrent;
  const double least = file_.base.battery_low;
  const bool low = least > 0 && base.volts && *base.volts < least;
  if (lasts(low, now, kBatteryTime, battery_low_since_)) return Halt::BatteryLow;
  return Halt::None;
}

/// [s] The longest gap between two scans of a scanner with `scan_period`, chosen so that the tick
/// that detects a longer one still stops the wheels in time. Jitter alone never exceeds it.
double SerialRobot::longest_gap(double scan_period) const {
  constexpr double kSending = 0.02;  // [s] transfer of the stop to a Pioneer at 9600 bit/s
  const double in_time = blind_time(scan_period) - file_.spec.period - kSending;
  const double usual = kScanPeriods * scan_period + kArrivalJitter;
  return std::max(std::min(usual, in_time), scan_period + kArrivalJitter);
}

/// Checked only with the motors on: a robot without power may be pushed.
bool SerialRobot::wheels_obey(const BaseState& base) {
  if (!base.motors_on) {
    wheels_.restart();
    return true;
  }
  return !wheels_.report(base.stamp, base.twist);
}

/// Whether a bumper is hit that was free when the operator armed the robot.
bool SerialRobot::bumper_hit(const BaseState& base, double now) {
  const std::array<bool, 2> pressed{base.bumper_front, base.bumper_rear};
  const std::lock_guard lock(mutex_);
  bool hit = false;
  for (std::size_t i = 0; i < pressed.size(); ++i) {
    if (lasts(!pressed[i], now, kBumperFree, bumpers_[i].free_since)) bumpers_[i].known = false;
    hit = hit || (pressed[i] && !bumpers_[i].known);
  }
  return hit && armed_;
}

Halt SerialRobot::scanner_halt(double now) {
  for (const auto& scanner : scanners_) {
    const ScannerState state = scanner->state();
    if (state.faulty || state.blinded) return Halt::ScannerFault;
    if (!state.running || now - state.last_scan > longest_gap(state.period)) {
      return Halt::ScannerLost;
    }
    if (state.bad_line) return Halt::BadLine;
  }
  return Halt::None;
}

Halt SerialRobot::floor_halt(double now) {
  if (floor_ == nullptr) return Halt::None;
  const FloorState state = floor_->state();
  if (state.faulty) return Halt::FloorFault;
  if (!state.running || now - state.last_reading > longest_gap(state.period)) {
    return Halt::FloorLost;
  }
  return Halt::None;
}

/// The gravest reason to halt; Disarmed for a robot without faults that is not armed.
Halt SerialRobot::judge(const BaseState& base, double now) {
  Halt halt = base_halt(base, now);
  if (halt == Halt::None) halt = scanner_halt(now);
  if (halt == Halt::None) halt = floor_halt(now);
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
  // The cause may be over when a person comes to look, so the sentence stays.
  if (bumper_hit(base, now)) {
    disarm(base.bumpers_unread
               ? "The base does not report its bumper inputs, so they count as hit. Check the "
                 "controller and its wiring, then arm the robot again."
               : "The robot touched something: a bumper was hit. Look at it, then arm it again.");
    armed = false;
  }
  // Its process may send again at any time, and the robot must not drive off by itself then.
  if (armed && published_.tilt_silent()) {
    disarm_after(tilt_words(health().devices));
    armed = false;
  }
  if (!wheels_obey(base)) {
    if (armed) {
      disarm(
          "A wheel does not turn as told: it runs away, is blocked, or its encoder is dead. Look "
          "at it, then arm again.");
    }
    base_->cut();  // a base that does not obey would not brake either
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

/// Records `halt`; disarms if the robot must not drive on by itself.
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
  if (halt == Halt::StopButton) {
    // With its motors off, a base may not tell whether the button is still pressed.
    disarm("Motors off. What happened: " + algo::explain(halt).why);
    return;
  }
  disarm_after(health().trouble);
}

/// The sentence is shown from the end of the fault until a person arms. As long as the fault lasts,
/// words() names it.
void SerialRobot::disarm_after(const std::string& fault) {
  disarm("Motors off. What happened: " + fault + " It is over now. Arm it again.");
}

/// `command`, restricted to what is allowed now.
algo::Twist2 SerialRobot::permitted(const algo::Command& command, const BaseState& base) const {
  algo::Twist2 twist = limited(command.base, file_.limits);
  // Straight away from the obstacle, slowly.
  constexpr double kBackingOff = 0.1;  // [m/s]
  if (base.bumper_front) twist = {std::clamp(twist.v, -kBackingOff, 0.0), 0};
  if (base.bumper_rear)
    twist = {std::clamp(twist.v, 0.0, base.bumper_front ? 0.0 : kBackingOff), 0};
  return twist;
}

// ---- the tick --------------------------------------------------------------------------------

bool SerialRobot::step(const algo::Command& command, algo::Observation& observation) {
  const double now = clock_->now();
  came_late(now);
  const BaseState base = base_->state();
  const bool moves = judge(base, now) == Halt::None;
  const algo::Twist2 twist = moves ? permitted(command, base) : algo::Twist2{};
  if (moves) {
    base_->drive(twist);
  } else {
    base_->stop();
  }
  wheels_.command(now, twist, !moves);
  // The thread may have been delayed since it read the clock.
  if (came_late(clock_->now())) base_->stop();
  wait_for_deadline(now);
  observe(observation);
  return true;
}

/// Rejects commands that come long after their tick's deadline, because the loop woke late, the
/// controller was slow or a line was slow. A program that was stopped or suspended must not drive
/// on by itself.
bool SerialRobot::came_late(double now) {
  const double late = now - deadline_;
  if (late <= kOverrun * file_.spec.period) return false;
  late_until_ = now + kLateHold;
  if (late > kSlept) {
    bool armed = false;
    {
      const std::lock_guard lock(mutex_);
      armed = armed_;
    }
    if (armed) {
      disarm(fmt::format("The program stood still for {:.1f} s. Its motors are off: arm it again.",
                         late));
    }
  }
  return true;
}

/// Absolute deadlines: a delay below one period does not shift the next deadline. Whole missed
/// periods are counted and skipped.
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
  observe_floor(observation);
  published_.observe(epoch_, observation);
}

void SerialRobot::observe_floor(algo::Observation& observation) {
  algo::FloorRanges ranges;
  if (floor_ == nullptr || !floor_->take(ranges)) return;
  ranges.stamp -= epoch_;
  observation.floor = ranges;
}

/// A base reports the pose of the middle of its wheels.
algo::Pose2 SerialRobot::at_R(const algo::Pose2& wheels) const {
  return algo::compose(wheels, {-file_.spec.axle, 0, 0});
}

void SerialRobot::observe_base(const BaseState& base,
                               double now,
                               algo::Observation& observation) const {
  const double stamp = base.stamp - epoch_;
  // Extrapolates the pose from the base's last report to now: in a turn, a tenth of a second moves
  // the nearest obstacle's bearing enough to change a controller's choice.
  const double age = base.running ? std::clamp(now - base.stamp, 0.0, kBaseTimeout) : 0.0;
  const algo::Pose2 pose = at_R(algo::integrate_arc(base.pose, base.twist, age));
  observation.odometry = {stamp + age, algo::pose_step(origin_, pose), base.twist};
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

// ---- arming ----------------------------------------------------------------------------------

/// Why the watchdog that the base reports is no protection; empty when it is.
std::optional<std::string> SerialRobot::watchdog_refusal(const BaseState& base) const {
  if (!base.watchdog) return std::nullopt;
  const double time = *base.watchdog;
  if (time == 0) {
    return "The base's own watchdog is off: should this program die, the robot would not stop. Set "
           "one in the base's memory.";
  }
  if (time < 3 * file_.spec.period) {
    return fmt::format(
        "The base's own watchdog is {:.2f} s; commands must come three times within, and the "
        "file's period is {:.3f} s.",
        time,
        file_.spec.period);
  }
  const double coast = file_.limits.speed * time;
  if (coast > kLongestCoast) {
    return fmt::format(
        "The base's own watchdog is {:.1f} s: should this program die, the robot would go on "
        "for {:.1f} m. Take a lower speed or set a shorter one.",
        time,
        coast);
  }
  return std::nullopt;
}

/// A sentence if the watchdog that the base reports differs from the file's; else empty.
std::string SerialRobot::watchdog_warning(const BaseState& base) const {
  constexpr double kRounding = 0.05;  // [s]
  if (!base.watchdog || std::abs(*base.watchdog - file_.base.watchdog) < kRounding) return "";
  return fmt::format(
      "The base says that its watchdog is {:.2f} s, the file says {:.2f} s: should this program "
      "die, the robot goes on for up to {:.2f} m.",
      *base.watchdog,
      file_.base.watchdog,
      file_.limits.speed * *base.watchdog);
}

std::optional<std::string> SerialRobot::arm() {
  const BaseState base = base_->state();
  Halt halt = Halt::None;
  {
    const std::lock_guard lock(mutex_);
    halt = halt_;
    if (armed_) return std::nullopt;
  }
  if (halt != Halt::Disarmed && halt != Halt::None) {
    return "It cannot be armed now. " + health().trouble;
  }
  if (published_.tilt_silent()) return "It cannot be armed now. " + health().trouble;
  if (auto refusal = watchdog_refusal(base)) return refusal;
  const double now = clock_->now();
  base_->enable(true);
  const std::lock_guard lock(mutex_);
  armed_ = true;
  ++armings_;
  armed_at_ = now;
  armed_set_up_ = base.set_ups;
  bumpers_ = {BumperWatch{.known = base.bumper_front}, BumperWatch{.known = base.bumper_rear}};
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

std::uint32_t SerialRobot::epoch() const {
  const std::lock_guard lock(mutex_);
  return armed_ ? armings_ : 0;
}

void SerialRobot::note_memory_locked(bool locked) {
  const std::lock_guard lock(mutex_);
  memory_locked_ = locked;
}

algo::HealthReport SerialRobot::health() const {
  algo::HealthReport out;
  for (const auto& scanner : scanners_) out.devices.push_back(scanner->report());
  if (floor_ != nullptr) out.devices.push_back(floor_->report());
  published_.report(out.devices);
  out.devices.push_back(base_->report());
  out.warnings = file_.warnings;
  if (std::string warning = watchdog_warning(base_->state()); !warning.empty()) {
    out.warnings.push_back(std::move(warning));
  }
  out.missed_periods = missed_.load(std::memory_order_relaxed);
  const std::lock_guard lock(mutex_);
  out.armed = armed_;
  out.halt = halt_;
  out.trouble = words(halt_, out.devices);
  out.real_time = real_time_;
  out.memory_locked = memory_locked_;
  out.lateness = lateness_;
  return out;
}

/// The sentence of the device at fault, if there is one.
std::string SerialRobot::words(Halt halt, const std::vector<algo::DeviceReport>& devices) const {
  const bool off = halt == Halt::Disarmed || (halt == Halt::None && !armed_);
  if (off && published_.tilt_silent()) return tilt_words(devices);
  // Between a disarming and the next tick nothing else says why.
  if (halt == Halt::None) return armed_ ? "" : disarmed_because_;
  const bool waits_for_a_person = halt == Halt::Disarmed || (halt == Halt::LateTick && !armed_);
  if (waits_for_a_person && !disarmed_because_.empty()) return disarmed_because_;
  const bool of_base = halt == Halt::BaseLost || halt == Halt::StopButton ||
                       halt == Halt::BaseFault || halt == Halt::OverCurrent;
  const bool of_floor = halt == Halt::FloorLost || halt == Halt::FloorFault;
  const bool of_scanner =
      halt == Halt::ScannerLost || halt == Halt::ScannerFault || halt == Halt::BadLine;
  for (const algo::DeviceReport& device : devices) {
    const bool concerned = device.name == "base"                     ? of_base
                           : device.name == psd::kDeviceName         ? of_floor
                           : PublishedSenses::is_one_of(device.name) ? false
                                                                     : of_scanner;
    if (device.well || !concerned) continue;
    return "The " + device.name + " at " + device.port + ": " + device.sentence;
  }
  return algo::explain(halt).why;
}

}  // namespace drivers
