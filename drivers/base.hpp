// drivers/base.hpp: a mobile base with two driven wheels, independent of its protocol.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "algo/health.hpp"
#include "algo/types.hpp"
#include "drivers/wheel_watch.hpp"

namespace drivers {

/// The newest reading of one sonar.
struct BaseSonar {
  double range = 0;  // [m]
  double stamp = 0;  // [s] steady clock; 0: none yet
};

struct BaseState {
  static constexpr std::size_t kSonars = 16;

  bool running = false;       // found, set up, and reporting
  std::uint32_t set_ups = 0;  // number of set-ups; each leaves the motors off
  double stamp = 0;           // [s] steady clock, time of the newest report
  algo::Pose2 pose{};         // dead reckoning since it was found
  algo::Twist2 twist{};
  std::optional<std::array<std::uint32_t, 2>> counts{};  // of the encoders, left and right
  bool motors_on = false;
  bool stop_button = false;
  bool bumper_front = false;
  bool bumper_rear = false;
  bool bumpers_unread = false;  // a bumper input is not reported, so it counts as hit
  bool stalled = false;
  bool over_current = false;
  bool faulty = false;
  std::optional<double> volts{};     // of the battery
  std::optional<double> watchdog{};  // [s] as the base reports it
  std::array<BaseSonar, kSonars> sonars{};
  std::size_t sonar_count = 0;
};

/// Call from the control thread, except where "any thread" is said.
class Base {
 public:
  Base() = default;
  virtual ~Base() = default;
  Base(const Base&) = delete;
  Base& operator=(const Base&) = delete;

  /// Requests motors on or off; state() tells when that is done. Off: the base brakes as by stop(),
  /// then switches its motors off once the wheels stand, or after braking_time() at the latest.
  /// From the request on, drive() does nothing until the motors are requested on again.
  virtual void enable(bool on) = 0;
  /// Switches the motors off at once, even if the wheels turn: for a base that does not obey. From
  /// any thread.
  virtual void cut() noexcept = 0;
  /// Commands `twist`, clamped to the base's limits. The device stops by itself unless this is
  /// called again within watchdog(), so only the control tick may call it.
  virtual void drive(const algo::Twist2& twist) = 0;
  /// Brakes with the base's own emergency ramp; call it each tick to keep braking. From any thread.
  virtual void stop() noexcept = 0;
  virtual BaseState state() = 0;
  /// [s] without a command after which the device stops by itself, from the robot's file.
  virtual double watchdog() const = 0;
  /// How its wheels follow commands. A ramp of 0 is unknown.
  virtual WheelDynamics dynamics() const { return {}; }
  /// From any thread.
  virtual algo::DeviceReport report() = 0;
};

/// [limits] of the robot's file.
struct BaseLimits {
  double speed = 0.1;              // [m/s] of the base's middle
  double turn = 0.5;               // [rad/s]
  double acceleration = 0.3;       // [m/s2]
  double turn_acceleration = 1.0;  // [rad/s2]
  double jerk = 0;                 // [m/s3] for the controller; 0: no limit
  double turn_jerk = 0;            // [rad/s3]
};

/// [m/s2] the least deceleration of a wheel in an emergency stop.
constexpr double kEmergencyDeceleration = 2.0;

/// [s] the longest emergency stop of a base within `limits`.
double braking_time(const BaseLimits& limits);

/// `twist` clamped to `limits`; NaN becomes 0.
algo::Twist2 limited(const algo::Twist2& twist, const BaseLimits& limits);

}  // namespace drivers
