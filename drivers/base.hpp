// drivers/base.hpp: a mobile base with two driven wheels, whatever its motor controller speaks.
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
  std::uint32_t set_ups = 0;  // times it was: a base set up anew has its motors off
  double stamp = 0;           // [s] steady clock, of the newest report
  algo::Pose2 pose{};         // dead reckoning since it was found
  algo::Twist2 twist{};
  std::optional<std::array<std::uint32_t, 2>> counts{};  // of the encoders, left and right
  bool motors_on = false;
  bool stop_button = false;
  bool bumper_front = false;
  bool bumper_rear = false;
  bool stalled = false;
  bool over_current = false;
  bool faulty = false;
  std::optional<double> volts{};     // of the battery
  std::optional<double> watchdog{};  // [s] as the base itself says
  std::array<BaseSonar, kSonars> sonars{};
  std::size_t sonar_count = 0;
};

/// Calls from the control thread, but for report().
class Base {
 public:
  Base() = default;
  virtual ~Base() = default;
  Base(const Base&) = delete;
  Base& operator=(const Base&) = delete;

  /// Asks for the motors to be switched on or off; state() says when they are. Off: the base
  /// brakes as by stop() and its motors go off once the wheels stand, after braking_time() at the
  /// latest. drive() does nothing from then on until they are switched on again.
  virtual void enable(bool on) = 0;
  /// Motors off at once, whatever the wheels do: for a base that does not obey. From any thread.
  virtual void cut() noexcept = 0;
  /// Wheels as for `twist`, within the base's limits. The device stops by itself when this is not
  /// called again within watchdog(): so the control tick calls it, and nobody else does.
  virtual void drive(const algo::Twist2& twist) = 0;
  /// Zero speed with the base's own emergency ramp; call it again each tick while that is to last.
  /// From any thread.
  virtual void stop() noexcept = 0;
  virtual BaseState state() = 0;
  /// [s] after which the device stops by itself when no command comes, as its file says.
  virtual double watchdog() const = 0;
  /// How its wheels follow its commands. Ramps of 0 are not known.
  virtual WheelDynamics dynamics() const { return {}; }
  /// From any thread.
  virtual algo::DeviceReport report() = 0;
};

/// The limits of a file, for every kind of base.
struct BaseLimits {
  double speed = 0.1;              // [m/s] of the base's middle
  double turn = 0.5;               // [rad/s]
  double acceleration = 0.3;       // [m/s2]
  double turn_acceleration = 1.0;  // [rad/s2]
};

/// [m/s2] of a wheel that brakes in an emergency, at least.
constexpr double kEmergencyDeceleration = 2.0;

/// [s] within which the wheels stand when a base within `limits` brakes in an emergency.
double braking_time(const BaseLimits& limits);

/// `twist` within `limits`; what is no number becomes 0.
algo::Twist2 limited(const algo::Twist2& twist, const BaseLimits& limits);

}  // namespace drivers
