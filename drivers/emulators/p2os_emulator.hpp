// drivers/emulators/p2os_emulator.hpp: a Pioneer base (P2OS, AROS, ARCOS) on its serial line.
//
// Written from the manuals of the Pioneer 2 and 3 as public clients use them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/bytes.hpp"
#include "drivers/emulators/base.hpp"
#include "drivers/emulators/device.hpp"

namespace drivers::p2os {

struct EmulatorOptions {
  std::string name = "Pioneer";
  std::string type = "p3dx-sh";
  std::string subtype = "emulated";
  unsigned baud = 9600;
  double watchdog = 2.0;      // [s] stored in the robot's memory
  double half_track = 0.165;  // [m]
  double volts = 12.6;
  int first_x_mm = 0;  // initial value of its counter
  int first_y_mm = 0;
  bool tail = true;  // state packets have the tail of newer firmware
  std::uint64_t seed = 1;
};

/// Position commands (MOVE, HEAD, DHEAD) and gyro packets are not emulated: like unknown commands
/// they get no answer.
class Emulator final : public emulators::Device, public emulators::Base {
 public:
  explicit Emulator(const EmulatorOptions& options = {});

  void feel(const emulators::BaseSenses& senses, double now) override;
  emulators::WheelMotion drive(double now) override;
  void press_stop_button(bool pressed) override;
  void press_bumper(bool pressed) override { bumper_pressed_ = pressed; }
  void set_battery(double volts) override { volts_ = volts; }
  void set_faults_reported(std::uint16_t bits) override { faults_ = bits; }
  bool powered() const override { return motors_on_; }
  void restart(double now, double boot_time) override;

  // ---- for tests ----
  bool open() const { return step_ == Step::Open; }
  bool motors_on() const { return motors_on_; }
  std::uint64_t bad_packets() const { return bad_packets_; }

 private:
  enum class Step : std::uint8_t { Sync0, Sync1, Sync2, Waiting, Open };
  struct Motion {
    double v = 0;      // [m/s]
    double omega = 0;  // [rad/s]
  };
  /// The motion that the host commands.
  struct Order {
    std::uint8_t code = 0;
    std::optional<int> argument{};
  };

  void on_byte(std::uint8_t byte, double at) override;
  void on_quiet(double /*silence*/) override {}
  void work(double now) override;
  double next_duty() const override;

  void take(ByteView body, double at);
  void synchronise(std::uint8_t code, double at);
  void obey(const Order& order, double at);
  void move(const Order& order, double at);
  void stop(double now, bool hard);
  void say(ByteView body, double at);
  void say_state(double at);
  void say_encoders(double at);
  void say_configuration(double at);
  void forget();
  emulators::WheelMotion wheels(const Motion& motion) const;

  EmulatorOptions options_;
  FixedBytes<256> packet_{};  // the bytes so far
  std::uint64_t bad_packets_ = 0;
  double boot_end_ = -emulators::kNever;
  Step step_ = Step::Sync0;
  double next_state_ = emulators::kNever;
  double heard_ = 0;  // [s] the last intact packet

  bool motors_on_ = false;
  bool sonar_on_ = true;
  bool stop_pressed_ = false;
  bool bumper_pressed_ = false;
  unsigned bump_stall_ = 0;
  int encoder_packets_ = 0;  // 2: with each state
  double volts_ = 0;
  std::uint16_t faults_ = 0;

  Motion wanted_{};
  Motion now_{};
  bool braking_ = false;  // emergency stop, until the next motion command
  double driven_until_ = -emulators::kNever;
  double acceleration_ = 0, deceleration_ = 0;            // [m/s2]
  double turn_acceleration_ = 0, turn_deceleration_ = 0;  // [rad/s2]
  double speed_limit_ = 0;                                // [m/s]
  double turn_limit_ = 0;                                 // [rad/s]
  double blocked_for_ = 0;                                // [s] commanded to move without moving
  double stalled_until_ = -emulators::kNever;

  emulators::BaseSenses senses_{};
  bool felt_ = false;
  double x_ = 0, y_ = 0, heading_ = 0;  // [m, rad] since SETO
  std::vector<emulators::SonarEcho> echoes_{};
};

}  // namespace drivers::p2os
