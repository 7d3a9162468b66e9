// drivers/roboteq_machine.hpp: finds a Roboteq controller, checks its parameters and drives it.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "drivers/base_machine.hpp"
#include "drivers/roboteq_protocol.hpp"

namespace drivers::roboteq {

struct RoboteqSetup {
  unsigned baud = 115'200;
  Wheel wheel{};
  double half_track = 0.25;  // [m]
  BaseLimits limits{};
  double watchdog = 0.5;           // [s]
  double max_current = 0;          // [A] of a motor; 0: not watched
  std::array<bool, 2> reversed{};  // the motor turns the other way: left, right
  bool swapped = false;            // channel 1 is the right motor
  // Digital inputs, counted from 1, that read 1 when hit.
  std::vector<int> bumper_inputs{};  // at the front
  std::vector<int> rear_bumper_inputs{};
};

class RoboteqMachine final : public BaseMachine {
 public:
  explicit RoboteqMachine(RoboteqSetup setup);

  unsigned opening_baud() const override { return setup_.baud; }
  void opened(double now, unsigned baud) override;
  void closed(double now, const std::string& why) override;
  void rate_set(double /*now*/, unsigned /*baud*/) override {}
  void receive(double now, ByteView bytes) override;
  void lost_bytes() override { reader_.clear(); }
  void advance(double now) override;
  void leave(double now) override;
  bool left() const override { return step_ == Step::Left; }

  void enable(double now, bool on) override;
  void cut(double now) override;
  void drive(double now, const algo::Twist2& twist) override;
  void halt(double now) override;
  double watchdog() const override { return setup_.watchdog; }
  WheelDynamics dynamics() const override {
    const double ramp =
        setup_.limits.acceleration + setup_.limits.turn_acceleration * setup_.half_track;
    const double step = setup_.wheel.full_speed_rpm / 1000;  // [rpm] of a command; reports: 1
    return {.ramp_of_wheels = true,
            .ramps = {ramp, ramp},
            .resolution = setup_.wheel.speed(std::max(1.0, step)),
            .checked = false};
  }
  algo::DeviceReport report(double now) const override;

 private:
  static constexpr double kSilent = 1.0;  // [s] without an answer: search again

  enum class Step : std::uint8_t {
    NoLine,
    Greeting,  // echo off
    Identity,
    Reading,  // a parameter
    Writing,  // a parameter with a wrong value
    Running,
    Waiting,  // before the search starts again
    Leaving,
    Left,
  };
  /// A parameter that must have a given value, for the controller or for each channel.
  struct Wanted {
    std::string_view name{};
    int value = 0;
    bool per_channel = false;
    bool optional = false;  // older controllers lack it
  };

  int wheel_ramp() const;
  int emergency_ramp() const;
  bool reporting() const { return step_ == Step::Running || step_ == Step::Leaving; }
  void close();
  void set_deceleration(int ramp);
  void greet(double now);
  void begin(Step step, double now);
  void request(double now);
  void take_line(double now, std::string_view line);
  void parameter_read(double now, const Reply& reply);
  void next_parameter(double now);
  void refuse(const std::string& why, double now);
  void skip_parameter(double now);
  void run(double now);
  void take_values(double now, const Reply& reply);
  bool jumped(double now, const std::array<std::int32_t, 2>& counts);
  void take_counts(double now);
  void judge(double now);
  void send(const Line& line) { orders_.send(line.view()); }
  /// Converts a pair in the controller's order to left and right motor, forward positive.
  template <class T>
  std::array<T, 2> by_side(const std::array<T, 2>& channels) const;

  RoboteqSetup setup_;
  std::vector<Wanted> wanted_{};
  LineReader reader_{};
  Step step_ = Step::NoLine;
  std::string firmware_{};
  std::vector<std::string> remarks_{};
  std::size_t parameter_ = 0;  // index in wanted_
  bool written_ = false;       // this parameter was written already
  int confirmations_ = 0;      // outstanding for the parameter written

  State values_{};
  std::optional<std::array<std::int32_t, 2>> counts_{};  // before the newest answer
  int jumps_ = 0;                                        // of the counts, in a row
  int singles_ = 0;                                      // answers with one channel, in a row
  std::array<int, 2> stalls_{};  // answers to ?FM and ?FS that say so, in a row
  bool enabled_ = false;
  double enabled_at_ = 0;     // [s]
  double braked_at_ = 0;      // [s] the newest order to brake
  double current_since_ = 0;  // [s] since when it is too high; 0: it is not
  double inputs_at_ = 0;      // [s] time of the newest bumper reading
  bool bumper_front_ = false;
  bool bumper_rear_ = false;
  bool inputs_told_ = true;  // of all bumpers, by the newest reading
  std::uint64_t refused_ = 0;
};

}  // namespace drivers::roboteq
