// drivers/p2os_machine.hpp: finds a Pioneer base, opens its session, drives and closes it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "drivers/base_machine.hpp"
#include "drivers/p2os_protocol.hpp"

namespace drivers::p2os {

struct PioneerSetup {
  unsigned baud = 9600;  // [bit/s] tried first; then the others
  Units units{};
  BaseLimits limits{};
  double half_track = 0.165;  // [m]
  double watchdog = 2.0;      // [s] as set in the base's own memory; it cannot be set from here
  bool sonar = true;
};

class PioneerMachine final : public BaseMachine {
 public:
  explicit PioneerMachine(const PioneerSetup& setup);

  unsigned opening_baud() const override { return setup_.baud; }
  void opened(double now, unsigned baud) override;
  void closed(double now, const std::string& why) override;
  void rate_set(double now, unsigned baud) override;
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
    return {.ramp_of_wheels = false,
            .ramps = {setup_.limits.acceleration, setup_.limits.turn_acceleration},
            .checked = true};
  }
  algo::DeviceReport report(double now) const override;

 private:
  enum class Step : std::uint8_t { NoLine, Greeting, ClosingOld, Waiting, Running, Leaving, Left };

  void search(double now);
  void greet(double now);
  void request(double now);
  void open(double now);
  void take_packet(double now, ByteView body);
  double transfer_time(std::size_t body) const;
  void take_state(double now, ByteView body);
  bool reporting() const { return step_ == Step::Running || step_ == Step::Leaving; }
  void close();
  void send(const Packet& packet);
  void send_twist(double now, const algo::Twist2& twist);
  void ask_watchdog(double now);

  PioneerSetup setup_;
  PacketReader reader_{};
  Handshake handshake_{};
  Step step_ = Step::NoLine;
  std::vector<unsigned> rates_{};  // [bit/s] in the order they are tried
  std::size_t rate_index_ = 0;
  unsigned port_baud_ = 0;
  bool fixed_rate_ = false;

  Identity identity_{};
  State packet_{};
  Odometer odometer_{};
  algo::Pose2 found_at_{};        // the base's odometry when it was found
  algo::Pose2 lost_at_{};         // our pose then: the last one before the base was lost
  int watchdog_asked_ = 0;        // times
  double watchdog_asked_at_ = 0;  // [s]
  algo::Twist2 sent_{};           // the command in force
  double sent_at_ = 0;            // [s]
  std::uint64_t jumps_ = 0;       // jumps of the odometry, left out
};

}  // namespace drivers::p2os
