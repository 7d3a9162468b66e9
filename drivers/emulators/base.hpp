// drivers/emulators/base.hpp: the common part of emulated bases: wheels that a world turns.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

namespace drivers::emulators {

struct WheelMotion {
  double left = 0;   // [m/s] over the ground
  double right = 0;  // [m/s]
  bool operator==(const WheelMotion&) const = default;
};

struct SonarEcho {
  std::uint8_t index = 0;
  double range = 0;  // [m]
};

/// The world's feedback to a base.
struct BaseSenses {
  double left_travel = 0;   // [m] rolled by each wheel since the start
  double right_travel = 0;  // [m]
  WheelMotion motion{};     // as measured
  bool front_bumper = false;
  bool rear_bumper = false;
  std::vector<SonarEcho> echoes{};  // new ones
};

/// A motion command of the host, for the record.
struct BaseCommand {
  double time = 0;       // [s]
  WheelMotion wanted{};  // of the wheels, before any ramp
};

/// Injected faults of the wheels.
struct WheelTrouble {
  double runaway = 0;         // [m/s] both wheels turn at this speed while powered
  double gain = 1;            // factor from the commanded to the actual speed
  bool blocked = false;       // the left wheel does not turn
  bool encoder_dead = false;  // the left encoder counts nothing
};

/// The wheels of a base; its line, if any, is a Device.
class Base {
 public:
  Base() = default;
  virtual ~Base() = default;
  Base(const Base&) = delete;
  Base& operator=(const Base&) = delete;

  WheelTrouble trouble{};

  /// drive(), changed by the injected faults.
  WheelMotion turn(double now) {
    WheelMotion motion = drive(now);
    if (trouble.runaway != 0 && powered()) motion = {trouble.runaway, trouble.runaway};
    motion.left *= trouble.blocked ? 0 : trouble.gain;
    motion.right *= trouble.gain;
    return motion;
  }
  /// feel(), likewise: a dead encoder keeps its count.
  void sense(const BaseSenses& senses, double now) {
    BaseSenses felt = senses;
    unseen_ += trouble.encoder_dead ? senses.left_travel - sensed_travel_ : 0;
    sensed_travel_ = senses.left_travel;
    felt.left_travel -= unseen_;
    if (trouble.encoder_dead) felt.motion.left = 0;
    feel(felt, now);
  }

  virtual void feel(const BaseSenses& senses, double now) = 0;
  /// The wheel motion that the motors produce at `now`.
  virtual WheelMotion drive(double now) = 0;
  /// Called for each motion command, and with 0 when the base stops by itself.
  std::function<void(const BaseCommand&)> on_command{};

  virtual void press_stop_button(bool pressed) = 0;
  virtual void press_bumper(bool pressed) = 0;
  virtual void set_battery(double volts) = 0;
  /// Fault bits as the device reports them.
  virtual void set_faults_reported(std::uint16_t bits) = 0;
  /// Whether the motors have power.
  virtual bool powered() const = 0;
  /// Restarts the controller: all settings of the host are lost.
  virtual void restart(double now, double boot_time) = 0;

 protected:
  /// `now` moved towards `wanted` by at most `most`.
  static double towards(double now, double wanted, double most) {
    return now + std::clamp(wanted - now, -most, most);
  }
  void report(double time, const WheelMotion& wanted) const {
    if (on_command) on_command({.time = time, .wanted = wanted});
  }

 private:
  double sensed_travel_ = 0;  // [m] of the left wheel
  double unseen_ = 0;         // [m] its travel while its encoder was dead
};

}  // namespace drivers::emulators
