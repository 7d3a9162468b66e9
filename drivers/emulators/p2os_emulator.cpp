// drivers/emulators/p2os_emulator.cpp: how a Pioneer base handles packets and reports its state.
#include "drivers/emulators/p2os_emulator.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "algo/units.hpp"
#include "drivers/p2os_protocol.hpp"

namespace drivers::p2os {
namespace {

using emulators::WheelMotion;

constexpr std::uint8_t kMark1 = 0xFA;
constexpr std::uint8_t kMark2 = 0xFB;
constexpr std::uint8_t kPositive = 0x3B;  // types of an argument
constexpr std::uint8_t kNegative = 0x1B;
constexpr std::uint8_t kStopped = 0x32;  // kinds of packets
constexpr std::uint8_t kMoving = 0x33;
constexpr std::uint8_t kEncoders = 0x90;
constexpr std::uint8_t kConfiguration = 0x20;

using algo::units::kRadiansPerDegree;

constexpr double kTopSpeed = 2.2;                          // [m/s] for any command
constexpr double kTopTurn = 500 * kRadiansPerDegree;       // [rad/s]
constexpr double kHardStop = 2.0;                          // [m/s2] with the brakes
constexpr double kHardTurnStop = 600 * kRadiansPerDegree;  // [rad/s2]
constexpr double kStallTime = 0.5;                         // [s] blocked until it reports a stall
constexpr double kStallRest = 1.0;                         // [s] the motors rest after a stall
constexpr double kAtRest = 1e-4;                           // [m/s]

/// Sum over a body: words high byte first, a last odd byte into the low byte. Written independently
/// of drivers/p2os_protocol.hpp, so that an error there shows.
std::uint16_t sum_of(ByteView body) {
  unsigned sum = 0;
  for (std::size_t i = 0; i + 1 < body.size(); i += 2)
    sum += (unsigned{body[i]} << 8U) | body[i + 1];
  if (body.size() % 2 != 0) sum ^= body.back();
  return static_cast<std::uint16_t>(sum & 0xFFFFU);
}

std::uint16_t word(long value) {
  return static_cast<std::uint16_t>(static_cast<unsigned long>(value) & 0xFFFFU);
}

std::uint16_t millimetres(double metres) {
  return word(std::lround(metres * 1000));
}

}  // namespace

Emulator::Emulator(const EmulatorOptions& options)
    : Device(options.baud, options.seed), options_(options), volts_(options.volts) {
  forget();
}

/// Resets everything that a host can set.
void Emulator::forget() {
  step_ = Step::Sync0;
  next_state_ = emulators::kNever;
  motors_on_ = false;
  sonar_on_ = true;
  bump_stall_ = 0;
  encoder_packets_ = 0;
  wanted_ = {};
  acceleration_ = deceleration_ = 0.3;
  turn_acceleration_ = turn_deceleration_ = 100 * kRadiansPerDegree;
  speed_limit_ = kTopSpeed;
  turn_limit_ = kTopTurn;
}

// ---- the line ----------------------------------------------------------------------------------

void Emulator::on_byte(std::uint8_t byte, double at) {
  if (at < boot_end_) return;
  const std::size_t size = packet_.size();
  if (size == 0 && byte != kMark1) return;
  if (size == 1 && byte != kMark2) {
    packet_.clear();
    if (byte == kMark1) packet_.push_back(byte);
    return;
  }
  packet_.push_back(byte);
  if (packet_.size() < 3) return;
  const std::size_t count = packet_.view()[2];
  if (count < 3) {
    packet_.clear();
    return;
  }
  if (packet_.size() < count + 3) return;
  const FixedBytes<256> whole = packet_;
  packet_.clear();
  const ByteView body = whole.view().subspan(3, count - 2);
  const unsigned sum = (unsigned{whole.view()[count + 1]} << 8U) | whole.view()[count + 2];
  if (sum == sum_of(body)) {
    take(body, at);
  } else {
    ++bad_packets_;  // dropped without an answer
  }
}

void Emulator::say(ByteView body, double at) {
  FixedBytes<256> packet;
  packet.push_back(kMark1);
  packet.push_back(kMark2);
  packet.push_back(static_cast<std::uint8_t>(body.size() + 2));
  packet.append(body);
  const std::uint16_t sum = sum_of(body);
  packet.push_back(static_cast<std::uint8_t>(sum >> 8U));
  packet.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
  line().say(packet.view(), at);
}

void Emulator::work(double now) {
  while (next_state_ <= now) {
    say_state(next_state_);
    if (encoder_packets_ > 0) say_encoders(next_state_);
    if (encoder_packets_ == 1) encoder_packets_ = 0;
    next_state_ += kStatePeriod;
  }
}

double Emulator::next_duty() const {
  return next_state_;
}

void Emulator::take(ByteView body, double at) {
  heard_ = at;
  if (step_ != Step::Open) {
    synchronise(body[0], at);
    return;
  }
  Order order{.code = body[0]};
  if (body.size() == 4 && (body[1] == kPositive || body[1] == kNegative)) {
    const int size = word_at(body, 2);
    order.argument = body[1] == kNegative ? -size : size;
  }
  obey(order, at);
}

/// SYNC0, SYNC1, SYNC2 in this order, each echoed; the last with the base's names. Then OPEN.
void Emulator::synchronise(std::uint8_t code, double at) {
  constexpr double kThinking = 0.005;  // [s]
  const double then = at + kThinking;
  if (code == 0 && step_ != Step::Waiting) {
    step_ = Step::Sync1;
    say(std::array<std::uint8_t, 1>{0}, then);
  } else if (code == 1 && step_ == Step::Sync1) {
    step_ = Step::Sync2;
    say(std::array<std::uint8_t, 1>{1}, then);
  } else if (code == 2 && step_ == Step::Sync2) {
    step_ = Step::Waiting;
    FixedBytes<200> names;
    names.push_back(2);
    for (const std::string* name : {&options_.name, &options_.type, &options_.subtype}) {
      names.append(std::string_view(*name));
      names.push_back(0);
    }
    say(names.view(), then);
  } else if (code == static_cast<std::uint8_t>(Code::Open) && step_ == Step::Waiting) {
    step_ = Step::Open;
    next_state_ = at + kStatePeriod;
  } else {
    step_ = Step::Sync0;
  }
}

// ---- commands ----------------------------------------------------------------------------------

void Emulator::obey(const Order& order, double at) {
  const int argument = order.argument.value_or(0);
  const auto linear = [&](double& up, double& down) {
    if (order.argument) (argument < 0 ? down : up) = std::abs(argument) / 1000.0;
  };
  switch (static_cast<Code>(order.code)) {
    case Code::Close:
      stop(at, true);
      forget();
      return;
    case Code::Enable:
      if (!order.argument || stop_pressed_) return;
      motors_on_ = argument != 0;
      if (!motors_on_) stop(at, true);
      return;
    case Code::Acceleration:
      linear(acceleration_, deceleration_);
      return;
    case Code::TurnAcceleration:
      if (order.argument) {
        (argument < 0 ? turn_deceleration_ : turn_acceleration_) =
            std::abs(argument) * kRadiansPerDegree;
      }
      return;
    case Code::SpeedLimit:
      if (argument > 0) speed_limit_ = std::min(argument / 1000.0, kTopSpeed);
      return;
    case Code::TurnLimit:
      if (argument > 0) turn_limit_ = std::min(argument * kRadiansPerDegree, kTopTurn);
      return;
    case Code::ZeroOdometry:
      x_ = y_ = heading_ = 0;
      options_.first_x_mm = options_.first_y_mm = 0;
      return;
    case Code::Configuration:
      say_configuration(at);
      return;
    case Code::Encoders:
      if (order.argument) encoder_packets_ = argument;
      return;
    case Code::Sonar:
      if (order.argument) sonar_on_ = argument != 0;
      return;
    case Code::BumpStall:
      if (order.argument) bump_stall_ = static_cast<unsigned>(argument) & 3U;
      return;
    case Code::HostBaud: {
      constexpr std::array<unsigned, 5> kRates{9600, 19200, 38400, 57600, 115200};
      if (order.argument && argument >= 0 && argument < 5) {
        line().set_baud(kRates[static_cast<std::size_t>(argument)]);
      }
      return;
    }
    case Code::Reset:
      restart(at, 1.0);
      return;
    case Code::Stop:
    case Code::EmergencyStop:
      stop(at, order.code == static_cast<std::uint8_t>(Code::EmergencyStop));
      return;
    default:
      move(order, at);
  }
}

void Emulator::move(const Order& order, double at) {
  if (!order.argument) return;
  const int argument = *order.argument;
  switch (static_cast<Code>(order.code)) {
    case Code::Velocity:
      wanted_.v = argument / 1000.0;
      break;
    case Code::Rotate:
    case Code::TurnRate:
      wanted_.omega = argument * kRadiansPerDegree;
      break;
    case Code::WheelVelocities: {
      constexpr double kStep = 0.02;  // [m/s]
      const auto bits = static_cast<unsigned>(argument);
      const double right = static_cast<std::int8_t>(bits & 0xFFU) * kStep;
      const double left = static_cast<std::int8_t>((bits >> 8U) & 0xFFU) * kStep;
      wanted_ = {.v = (left + right) / 2, .omega = (right - left) / (2 * options_.half_track)};
      break;
    }
    default:
      return;
  }
  braking_ = false;
  if (!motors_on_) wanted_ = {};  // a command with the motors off is lost
  report(at, wheels(wanted_));
}

void Emulator::stop(double now, bool hard) {
  wanted_ = {};
  braking_ = braking_ || hard;
  report(now, {});
}

void Emulator::press_stop_button(bool pressed) {
  stop_pressed_ = pressed;
  if (!pressed) return;
  motors_on_ = false;
  wanted_ = {};
}

void Emulator::restart(double now, double boot_time) {
  line().cut(now);
  packet_.clear();
  stop(now, true);
  forget();
  line().set_baud(options_.baud);
  boot_end_ = now + boot_time;
}

// ---- motion ------------------------------------------------------------------------------------

WheelMotion Emulator::wheels(const Motion& motion) const {
  const double turn = motion.omega * options_.half_track;
  return {.left = motion.v - turn, .right = motion.v + turn};
}

WheelMotion Emulator::drive(double now) {
  const double dt = driven_until_ > -emulators::kNever ? std::max(0.0, now - driven_until_) : 0;
  driven_until_ = now;
  if (open() && now - heard_ > options_.watchdog &&
      wanted_.v * wanted_.v + wanted_.omega * wanted_.omega > 0) {
    wanted_ = {};
    report(now, {});
  }
  const bool bumped = (bump_stall_ & 1U) != 0 && (senses_.front_bumper || bumper_pressed_);
  const bool bumped_behind = (bump_stall_ & 2U) != 0 && senses_.rear_bumper;
  const bool rests = now < stalled_until_;
  Motion wanted = wanted_;
  if ((bumped && wanted.v > 0) || (bumped_behind && wanted.v < 0) || rests) wanted = {};
  wanted.v = std::clamp(wanted.v, -speed_limit_, speed_limit_);
  wanted.omega = std::clamp(wanted.omega, -turn_limit_, turn_limit_);
  if (!motors_on_ || braking_) {  // full deceleration
    now_.v = towards(now_.v, 0, kHardStop * dt);
    now_.omega = towards(now_.omega, 0, kHardTurnStop * dt);
    return wheels(now_);
  }
  const auto ramp = [dt](double from, double to, double up, double down) {
    const bool slower = std::abs(to) < std::abs(from) || to * from < 0;
    return towards(from, to, (slower ? down : up) * dt);
  };
  now_.v = ramp(now_.v, wanted.v, acceleration_, deceleration_);
  now_.omega = ramp(now_.omega, wanted.omega, turn_acceleration_, turn_deceleration_);

  const WheelMotion told = wheels(now_);
  const double effort = std::max(std::abs(told.left), std::abs(told.right));
  const double motion = std::max(std::abs(senses_.motion.left), std::abs(senses_.motion.right));
  blocked_for_ = effort > 0.02 && motion < 0.1 * effort ? blocked_for_ + dt : 0;
  if (blocked_for_ > kStallTime) {
    stalled_until_ = now + kStallRest;
    blocked_for_ = 0;
    now_ = {};
  }
  return told;
}

void Emulator::feel(const emulators::BaseSenses& senses, double /*now*/) {
  if (felt_) {
    const double left = senses.left_travel - senses_.left_travel;
    const double right = senses.right_travel - senses_.right_travel;
    const double turn = (right - left) / (2 * options_.half_track);
    const double way = (left + right) / 2;
    x_ += way * std::cos(heading_ + turn / 2);
    y_ += way * std::sin(heading_ + turn / 2);
    heading_ += turn;
  }
  felt_ = true;
  senses_ = senses;
  for (const emulators::SonarEcho& echo : senses.echoes) echoes_.push_back(echo);
}

// ---- reports -----------------------------------------------------------------------------------

void Emulator::say_state(double at) {
  constexpr std::uint16_t kPosition = 0x7FFF;  // 15 bits of it
  constexpr double kPerTurn = 4096;
  const bool moving =
      std::max(std::abs(senses_.motion.left), std::abs(senses_.motion.right)) > kAtRest;
  const bool stalled = at < stalled_until_;
  const bool bumped = senses_.front_bumper || bumper_pressed_;
  FixedBytes<200> body;
  body.push_back(moving ? kMoving : kStopped);
  body.append_word(word(std::lround(x_ * 1000) + options_.first_x_mm) & kPosition);
  body.append_word(word(std::lround(y_ * 1000) + options_.first_y_mm) & kPosition);
  body.append_word(word(std::lround(std::remainder(heading_, 2 * std::numbers::pi) /
                                    (2 * std::numbers::pi) * kPerTurn)));
  body.append_word(millimetres(senses_.motion.left));
  body.append_word(millimetres(senses_.motion.right));
  const auto tenths = static_cast<std::uint8_t>(rounded(volts_ * 10, 255));
  body.push_back(tenths);
  unsigned stall = stalled ? 0x0101U : 0U;
  if (bumped) stall |= 1U << 10U;
  if (senses_.rear_bumper) stall |= 1U << 2U;
  body.append_word(static_cast<std::uint16_t>(stall));
  body.append_word(0);  // heading set point: no position control
  unsigned flags = motors_on_ ? 1U : 0U;
  if (sonar_on_) flags |= 0x1EU;
  if (stop_pressed_) flags |= 0x60U;
  body.append_word(static_cast<std::uint16_t>(flags));
  body.push_back(0);  // compass: none
  constexpr std::size_t kMostEchoes = 24;
  if (!sonar_on_) echoes_.clear();
  const std::size_t echoes = std::min(echoes_.size(), kMostEchoes);
  body.push_back(static_cast<std::uint8_t>(echoes));
  for (std::size_t i = 0; i < echoes; ++i) {
    body.push_back(echoes_[i].index);
    body.append_word(millimetres(echoes_[i].range));
  }
  echoes_.clear();
  for (int i = 0; i < 5; ++i) body.push_back(0);  // gripper, analog and digital inputs
  if (options_.tail) {
    const double turn_rate =
        (senses_.motion.right - senses_.motion.left) / (2 * options_.half_track);
    body.append_word(tenths);
    body.push_back(0);  // not charging
    body.append_word(word(std::lround(turn_rate / kRadiansPerDegree * 10)));
    body.append_word(faults_);
  }
  say(body.view(), at);
}

/// The contents of its memory up to the watchdog; the gains after it are left out.
void Emulator::say_configuration(double at) {
  FixedBytes<200> body;
  const auto text = [&body](std::string_view what) {
    body.append(what);
    body.push_back(0);
  };
  body.push_back(kConfiguration);
  text(options_.type);
  text(options_.subtype);
  text("0001");
  body.push_back(0);  // two motors
  for (const int limit : {360, 2200, 600, 2000, 500}) {
    body.append_word(static_cast<std::uint16_t>(limit));
  }
  text(options_.name);
  for (const int byte : {100, 0, 0}) body.push_back(static_cast<std::uint8_t>(byte));
  body.append_word(0);    // no gripper
  body.append_word(1);    // sonar ahead
  body.push_back(0);      // none behind
  body.append_word(110);  // [0.1 V] low battery
  body.append_word(500);  // counts per turn
  body.append_word(word(std::lround(options_.watchdog * 1000)));
  say(body.view(), at);
}

void Emulator::say_encoders(double at) {
  FixedBytes<16> body;
  body.push_back(kEncoders);
  for (const double travel : {senses_.left_travel, senses_.right_travel}) {
    constexpr double kPerMetre = 128000;  // counts; differs from base to base
    const auto counts = static_cast<unsigned long long>(std::llround(travel * kPerMetre));
    body.append_word(static_cast<std::uint16_t>(counts & 0xFFFFU));
    body.append_word(static_cast<std::uint16_t>((counts >> 16U) & 0xFFFFU));
  }
  say(body.view(), at);
}

}  // namespace drivers::p2os
