// drivers/p2os_machine.cpp: the dialogue with a Pioneer base.
#include "drivers/p2os_machine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "algo/diff_drive.hpp"
#include "algo/units.hpp"

namespace drivers::p2os {
namespace {

using algo::units::kRadiansPerDegree;

constexpr std::array<unsigned, 5> kRates{9600, 38400, 19200, 115200, 57600};
constexpr int kTries = 3;
constexpr double kEchoWait = 0.4;                 // [s] for the echo of a greeting
constexpr double kCloseWait = 0.4;                // [s] after an old session was closed
constexpr double kSearchPause = 1.0;              // [s] before all rates are tried again
constexpr double kSilent = 1.0;                   // [s] without a state packet: search again
constexpr double kCommandPause = 0.005;           // [s] between two packets
constexpr double kRepeat = 0.9 * kCommandPeriod;  // [s] a tick early rather than one too late
constexpr double kFastest = 0.04;                 // [s] between two commands that differ
constexpr int kMost = 0x7FFF;
constexpr int kWatchdogTries = 5;       // older bases do not answer
constexpr double kWatchdogPause = 1.0;  // [s] between two

int millimetres(double metres) {
  return rounded(metres * 1000.0, kMost);
}
int degrees(double radians) {
  return rounded(radians / kRadiansPerDegree, kMost);
}

}  // namespace

PioneerMachine::PioneerMachine(const PioneerSetup& setup) : setup_(setup), odometer_(setup.units) {
  rates_.push_back(setup.baud);
  for (const unsigned rate : kRates) {
    if (rate != setup.baud) rates_.push_back(rate);
  }
}

void PioneerMachine::opened(double now, unsigned baud) {
  orders_.clear();
  reader_.clear();
  fixed_rate_ = baud == 0;
  port_baud_ = setup_.baud;
  searching_since_ = now;
  search(now);
}

void PioneerMachine::closed(double /*now*/, const std::string& why) {
  reader_.clear();
  if (step_ != Step::Left) step_ = Step::NoLine;
  lose_line(why);
}

void PioneerMachine::rate_set(double /*now*/, unsigned /*baud*/) {
  reader_.clear();  // earlier bytes were read at the wrong rate
}

void PioneerMachine::receive(double now, ByteView bytes) {
  reader_.feed(
      bytes, [&](ByteView packet) { take_packet(now, body_of(packet)); }, [](std::uint8_t) {});
}

void PioneerMachine::advance(double now) {
  if (off_.due(now, state_)) cut(now);
  if (off_.pending()) halt(now);  // even without further ticks
  if (step_ == Step::Leaving && !off_.pending()) close();
  if (now < deadline_) return;
  switch (step_) {
    case Step::Leaving:
      close();  // the device no longer answers
      return;
    case Step::NoLine:
    case Step::Left:
      deadline_ = std::numeric_limits<double>::infinity();
      return;
    case Step::ClosingOld:
      greet(now);
      return;
    case Step::Waiting:
      search(now);
      return;
    case Step::Running:
      state_.running = false;
      state_.motors_on = false;
      trouble_ = fmt::format("The base has been silent for {:.1f} s; it is looked for again.",
                             now - state_.stamp);
      searching_since_ = now;
      search(now);
      return;
    case Step::Greeting:
      if (tries_left_ > 0) {
        request(now);
        return;
      }
      ++rate_index_;
      if (rate_index_ < (fixed_rate_ ? 1 : rates_.size())) {
        greet(now);
        return;
      }
      trouble_ = fmt::format(
          "No base answers at any rate, for {:.0f} s now. Is it switched on, and the "
          "cable at its HOST port?",
          now - searching_since_);
      step_ = Step::Waiting;
      deadline_ = now + kSearchPause;
      return;
  }
}

// ---- finding the base ------------------------------------------------------------------------

void PioneerMachine::search(double now) {
  rate_index_ = 0;
  greet(now);
}

void PioneerMachine::greet(double now) {
  const unsigned rate = rates_[rate_index_];
  if (!fixed_rate_ && rate != port_baud_) orders_.set_baud(rate);
  port_baud_ = rate;
  reader_.clear();
  handshake_ = Handshake();
  step_ = Step::Greeting;
  tries_left_ = kTries;
  request(now);
}

void PioneerMachine::request(double now) {
  --tries_left_;
  send(handshake_.request());
  deadline_ = now + kEchoWait;
}

void PioneerMachine::take_packet(double now, ByteView body) {
  if (reporting()) {
    if (is_state(body)) take_state(now, body);
    if (const auto watchdog = configured_watchdog(body)) state_.watchdog = watchdog;
    return;
  }
  if (step_ != Step::Greeting) return;
  switch (handshake_.receive(body)) {
    case Handshake::Progress::Ignored:
      return;
    case Handshake::Progress::Advanced:
      tries_left_ = kTries;
      request(now);
      return;
    case Handshake::Progress::Done:
      identity_ = handshake_.identity();
      open(now);
      return;
    case Handshake::Progress::SessionOpen:
      // An earlier program did not close its session.
      send(command(Code::Close));
      step_ = Step::ClosingOld;
      deadline_ = now + kCloseWait;
      return;
  }
}

/// The motors stay off until enable(true).
void PioneerMachine::open(double now) {
  send(command(Code::Open));
  send(command(Code::Enable, 0));
  send(command(Code::Acceleration, millimetres(setup_.limits.acceleration)));
  send(command(Code::Acceleration, -millimetres(setup_.limits.acceleration)));
  send(command(Code::TurnAcceleration, degrees(setup_.limits.turn_acceleration)));
  send(command(Code::TurnAcceleration, -degrees(setup_.limits.turn_acceleration)));
  send(command(Code::BumpStall, 3));  // the base stops by itself too
  send(command(Code::Sonar, setup_.sonar ? 1 : 0));
  step_ = Step::Running;
  deadline_ = now + kSilent;
  trouble_ = "The base is being set up.";
  state_.watchdog.reset();
  watchdog_asked_ = 0;
  ask_watchdog(now);
  odometer_ = Odometer(setup_.units);
  sent_ = {};
  sent_at_ = 0;
  braking_ = false;
  off_.cancel();
}

/// Any packet feeds the base's watchdog, so this one is sent only while the motors are off.
void PioneerMachine::ask_watchdog(double now) {
  send(command(Code::Configuration));
  ++watchdog_asked_;
  watchdog_asked_at_ = now;
}

// ---- reports ---------------------------------------------------------------------------------

/// [s] from the first byte of a packet to its last: the base has moved meanwhile.
double PioneerMachine::transfer_time(std::size_t body) const {
  constexpr std::size_t kAround = 5;  // head, count and sum
  constexpr double kBits = 10;        // per byte on the line
  return fixed_rate_ ? 0 : kBits * static_cast<double>(body + kAround) / port_baud_;
}

void PioneerMachine::take_state(double now, ByteView body) {
  if (!decode_state(body, packet_, setup_.units)) return;
  if (!odometer_.update(packet_)) ++jumps_;
  const algo::Pose2& at = odometer_.pose();
  if (!state_.running) {
    found_at_ = at;
    lost_at_ = state_.pose;
    state_.running = true;
    ++state_.set_ups;
    trouble_.clear();
  }
  deadline_ = now + kSilent;
  if (!state_.watchdog && !state_.motors_on && watchdog_asked_ < kWatchdogTries &&
      now - watchdog_asked_at_ > kWatchdogPause) {
    ask_watchdog(now);
  }
  state_.stamp = now - transfer_time(body.size());
  const algo::Vec2 way = at.position() - found_at_.position();
  const algo::Vec2 ahead = algo::direction(found_at_.heading);
  state_.pose = algo::compose(lost_at_,
                              {ahead.dot(way),
                               ahead.x() * way.y() - ahead.y() * way.x(),
                               algo::wrap_angle(at.heading - found_at_.heading)});
  state_.twist = algo::twist_of({packet_.left_speed, packet_.right_speed}, setup_.half_track);
  if (!(setup_.half_track > 0)) state_.twist.omega = 0;
  state_.motors_on = packet_.motors_on();
  state_.stop_button = packet_.stop_button();
  state_.bumper_front = packet_.front_bumpers != 0;
  state_.bumper_rear = packet_.rear_bumpers != 0;
  state_.stalled = packet_.stalled();
  state_.faulty = packet_.faults.value_or(0) != 0;
  state_.volts = packet_.volts;
  for (std::size_t i = 0; i < packet_.sonar_count; ++i) {
    const SonarReading& reading = packet_.sonars[i];
    if (reading.index >= BaseState::kSonars) continue;
    state_.sonars[reading.index] = {.range = reading.range, .stamp = now};
    state_.sonar_count = std::max(state_.sonar_count, reading.index + std::size_t{1});
  }
}

// ---- commands --------------------------------------------------------------------------------

void PioneerMachine::send(const Packet& packet) {
  orders_.send(packet.view(), kCommandPause);
}

void PioneerMachine::send_twist(double now, const algo::Twist2& twist) {
  const VelocityPackets packets = velocity(twist, {setup_.limits.speed, setup_.limits.turn});
  // A zero command never expires.
  const bool moves = twist != algo::Twist2{};
  const double expires = moves ? now + kMotionExpires : std::numeric_limits<double>::infinity();
  orders_.send_before(expires, packets.velocity.view(), kCommandPause);
  orders_.send_before(expires, packets.turn_rate.view(), kCommandPause);
  sent_ = twist;
  sent_at_ = now;
}

void PioneerMachine::enable(double now, bool on) {
  if (step_ != Step::Running) return;
  if (on) {
    off_.cancel();
    send(command(Code::Enable, 1));
    return;
  }
  halt(now);
  if (state_.motors_on) {
    off_.begin(now, braking_time(setup_.limits));
  } else {
    cut(now);
  }
}

void PioneerMachine::cut(double now) {
  if (!reporting()) return;
  halt(now);
  off_.cancel();
  send(command(Code::Enable, 0));
}

/// A slow line cannot carry two packets per tick: a changed command is sent at up to 25 Hz, an
/// unchanged one at 10 Hz, a stop at once.
void PioneerMachine::drive(double now, const algo::Twist2& twist) {
  if (step_ != Step::Running || off_.pending()) return;
  const algo::Twist2 wanted = limited(twist, setup_.limits);
  if (braking_ && wanted == algo::Twist2{}) {
    halt(now);  // keep the emergency ramp
    return;
  }
  braking_ = false;
  const bool stopping = wanted == algo::Twist2{} && sent_ != algo::Twist2{};
  const double age = now - sent_at_;
  const bool due = wanted == sent_ ? age >= kRepeat : age >= kFastest;
  if (stopping || due) send_twist(now, wanted);
}

/// The base acknowledges no packet, so the emergency stop is repeated while the wheels may turn.
/// A zero speed would brake along the driving ramp.
void PioneerMachine::halt(double now) {
  if (!reporting() || (braking_ && now - sent_at_ < kRepeat)) return;
  if (!braking_) braking_since_ = now;
  braking_ = true;
  if (now - braking_since_ > braking_time(setup_.limits)) {
    send_twist(now, {});
    return;
  }
  send(command(Code::EmergencyStop));
  sent_ = {};
  sent_at_ = now;
}

void PioneerMachine::leave(double now) {
  orders_.clear();
  if (step_ != Step::Running) {
    step_ = Step::Left;
    return;
  }
  braking_ = false;  // the stop may not have been sent
  enable(now, false);
  step_ = Step::Leaving;
  if (!off_.pending()) close();
}

void PioneerMachine::close() {
  send(command(Code::Close));
  step_ = Step::Left;
}

algo::DeviceReport PioneerMachine::report(double now) const {
  algo::DeviceReport out;
  out.well = state_.running && trouble_.empty() && !state_.stop_button && !state_.faulty;
  out.sentence = trouble_;
  if (state_.running && state_.faulty) {
    out.sentence = fmt::format("The base reports fault flags 0x{:04x}.", *packet_.faults);
  }
  if (state_.running && state_.stop_button) {
    out.sentence = "Its stop button is pressed: release it, then arm.";
  }
  if (out.sentence.empty()) {
    out.sentence = state_.motors_on ? "Well, motors on." : "Well, motors off.";
  }
  if (state_.stalled) out.remarks.emplace_back("A wheel is blocked.");
  if (jumps_ > 0) {
    out.remarks.push_back(fmt::format("Its position jumped {:.0f} times; the jumps were left out.",
                                      static_cast<double>(jumps_)));
  }
  out.facts = {{"kind", "Pioneer (P2OS)"}, {"rate", fmt::format("{} bit/s", port_baud_)}};
  if (!identity_.name.empty()) {
    out.facts.emplace_back("type",
                           identity_.type + "-" + identity_.subtype + ", " + identity_.name);
  }
  if (state_.running) {
    out.facts.emplace_back("battery", fmt::format("{:.1f} V", state_.volts.value_or(0)));
    if (state_.watchdog)
      out.facts.emplace_back("watchdog", fmt::format("{:.1f} s", *state_.watchdog));
    out.facts.emplace_back("age", fmt::format("{:.2f} s", now - state_.stamp));
  }
  out.facts.emplace_back(
      "damaged packets",
      std::to_string(reader_.counters().bad_checks + reader_.counters().given_up));
  return out;
}

}  // namespace drivers::p2os
