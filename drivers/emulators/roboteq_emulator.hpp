// drivers/emulators/roboteq_emulator.hpp: a two-channel Roboteq motor controller on its serial
// line, with a motor, a gear and an encoder on each channel.
//
// Written from public drivers; the maker's manual was not at hand. Where the drivers leave a
// choice, the emulator is strict.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/bytes.hpp"
#include "drivers/emulators/base.hpp"
#include "drivers/emulators/device.hpp"

namespace drivers::roboteq {

struct EmulatorOptions {
  std::string firmware = "Roboteq v2.0 SDC2XXX 01/01/2020";
  int watchdog_ms = 1000;     // factory setting
  double wheel_radius = 0.1;  // [m]
  double gear = 20;           // turns of the motor per turn of the wheel
  int encoder_lines = 500;    // per turn of the motor; four counts each
  int full_speed_rpm = 1000;  // of the motors; factory setting of ^MXRPM
  double volts = 24.0;
  std::int32_t first_count = 0;  // initial value of the counters
  bool one_channel = false;
  std::uint64_t seed = 1;
};

/// Channel 1 turns the left wheel, channel 2 the right one.
class Emulator final : public emulators::Device, public emulators::Base {
 public:
  explicit Emulator(const EmulatorOptions& options = {});

  void feel(const emulators::BaseSenses& senses, double now) override;
  emulators::WheelMotion drive(double now) override;
  void press_stop_button(bool pressed) override;
  /// Wired to digital input 1.
  void press_bumper(bool pressed) override { bumper_pressed_ = pressed; }
  void set_battery(double volts) override { volts_ = volts; }
  void set_faults_reported(std::uint16_t bits) override { faults_ = bits; }
  bool powered() const override { return fault_bits() == 0; }
  void restart(double now, double boot_time) override;

  // ---- for tests ----
  bool echoes() const { return echo_; }
  unsigned memory_writes() const { return memory_writes_; }

 private:
  static constexpr std::size_t kChannels = 2;
  using Pair = std::array<int, kChannels>;

  /// Parameters that a host can read and write; in RAM until stored.
  struct Parameters {
    int watchdog_ms = 1000;
    Pair mode{1, 1};  // closed loop
    Pair full_rpm{};
    Pair encoder_lines{};
    Pair encoder_use{18, 34};
    Pair acceleration{20000, 20000};  // [0.1 rpm/s]
    Pair deceleration{20000, 20000};
    Pair amperes{150, 150};  // [0.1 A] limit
    Pair p{10, 10}, i{10, 10}, d{0, 0};
    Pair loop_error{2, 2};  // 0: off; fault after 1: 0.25 s, 2: 0.5 s, 3: 1 s
  };
  /// A parsed line.
  struct Order {
    char kind = 0;
    std::string_view name{};
    std::array<int, 4> numbers{};
    std::size_t count = 0;
  };

  void on_byte(std::uint8_t byte, double at) override;
  void on_quiet(double /*silence*/) override {}
  void work(double now) override;
  double next_duty() const override;

  void take(std::string_view line, double at);
  bool parse(std::string_view text, Order& order) const;
  bool command(const Order& order, double at);
  bool drive_command(const Order& order, double at);
  bool channel_command(const Order& order, double at);
  bool set(const Order& order);
  bool maintain(const Order& order, double at);
  void repeat(const Order& order, double at);
  bool ask(const Order& order, double at);
  bool read(const Order& order, double at);
  Pair* pair_of(std::string_view name);

  void say(std::string_view text, double at);
  void say_values(std::string_view name,
                  const std::vector<long>& values,
                  const Order& order,
                  double at);
  void halt(double at);
  bool channel_fits(int channel) const;
  double wheel_speed(std::size_t channel, double rpm) const;
  void watch_loop(std::size_t channel, double dt);
  unsigned fault_bits() const;
  unsigned status_bits() const;
  std::int32_t counter(std::size_t channel) const;

  EmulatorOptions options_;
  Parameters parameters_{};
  Parameters stored_{};
  std::string line_text_{};
  bool echo_ = true;
  double boot_end_ = -emulators::kNever;
  unsigned memory_writes_ = 0;

  std::array<double, kChannels> wanted_rpm_{};
  std::array<double, kChannels> rpm_{};       // output of the ramp
  std::array<double, kChannels> lost_for_{};  // [s] commanded to turn without turning
  std::array<bool, kChannels> stalled_{};     // switched off for that, until commanded to stop
  double driven_until_ = -emulators::kNever;
  double commanded_ = -emulators::kNever;  // [s] the last motor command
  bool emergency_ = false;
  bool stop_pressed_ = false;
  bool bumper_pressed_ = false;
  double volts_ = 0;
  std::uint16_t faults_ = 0;

  emulators::BaseSenses senses_{};
  bool felt_ = false;
  std::array<double, kChannels> counts_{};  // of the encoders, not wrapped
  std::array<std::int32_t, kChannels> asked_counts_{};

  std::vector<std::string> history_{};
  double repeat_every_ = 0;  // [s] 0: no repetition
  double next_repeat_ = emulators::kNever;
  std::size_t next_query_ = 0;
};

}  // namespace drivers::roboteq
