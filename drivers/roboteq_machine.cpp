// drivers/roboteq_machine.cpp: the dialogue with a Roboteq controller.
#include "drivers/roboteq_machine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "algo/diff_drive.hpp"

namespace drivers::roboteq {
namespace {

constexpr double kAnswer = 0.3;  // [s]
constexpr int kTries = 4;
constexpr double kPause = 2.0;        // [s] before the search starts again
constexpr double kInputsAge = 0.5;    // [s] older bumper readings count as hit
constexpr double kReleaseTime = 0.5;  // [s] the controller may still report a released stop
constexpr double kRepeat = 0.1;       // [s] between two orders to brake
constexpr double kCurrentTime = 0.2;  // [s] a motor may take more when it starts
constexpr std::uint16_t kStopFault = 16;
constexpr int kQuickLoopError = 1;  // of ^CLERD: after 0.25 s of an error of 100
// An answer that contradicts the earlier ones must be repeated: lines carry no check value.
constexpr int kBelieved = 5;
constexpr int kAgreeing = 2;         // answers that say a wheel is blocked
constexpr int kClosedLoopSpeed = 1;  // of the parameter MMOD

}  // namespace

RoboteqMachine::RoboteqMachine(RoboteqSetup setup) : setup_(std::move(setup)) {
  const auto whole = [](double value) { return static_cast<int>(std::lround(value)); };
  wanted_ = {{"RWD", whole(setup_.watchdog * 1000), false},
             {"MMOD", kClosedLoopSpeed, true},
             {"MXRPM", whole(setup_.wheel.full_speed_rpm), true},
             {"EPPR", whole(setup_.wheel.encoder_lines), true},
             {"MAC", wheel_ramp(), true},
             {"MDEC", wheel_ramp(), true},
             {"CLERD", kQuickLoopError, true, true}};
}

/// [0.1 rpm/s] of a motor at the largest forward and the largest turning acceleration at once: the
/// controller's own ramp must not be slower than the file allows.
int RoboteqMachine::wheel_ramp() const {
  const BaseLimits& limits = setup_.limits;
  const double wheel = limits.acceleration + limits.turn_acceleration * setup_.half_track;
  return std::max(1, static_cast<int>(std::lround(10 * setup_.wheel.rpm(wheel))));
}

/// [0.1 rpm/s] likewise, in an emergency stop.
int RoboteqMachine::emergency_ramp() const {
  const int ramp = static_cast<int>(std::lround(10 * setup_.wheel.rpm(kEmergencyDeceleration)));
  return std::max(ramp, wheel_ramp());
}

void RoboteqMachine::opened(double now, unsigned /*baud*/) {
  searching_since_ = now;
  greet(now);
}

void RoboteqMachine::greet(double now) {
  orders_.clear();
  reader_.clear();
  remarks_.clear();
  values_ = {};
  counts_.reset();
  jumps_ = 0;
  singles_ = 0;
  stalls_ = {};
  enabled_ = false;
  braking_ = false;
  off_.cancel();
  state_.running = false;
  state_.motors_on = false;
  send(command(""));  // ends a line that an earlier program left unfinished
  send(end_repetition());
  begin(Step::Greeting, now);
}

void RoboteqMachine::closed(double /*now*/, const std::string& why) {
  if (step_ != Step::Left) step_ = Step::NoLine;
  lose_line(why);
}

void RoboteqMachine::receive(double now, ByteView bytes) {
  reader_.feed(bytes, [&](std::string_view line) { take_line(now, line); });
}

void RoboteqMachine::begin(Step step, double now) {
  step_ = step;
  tries_left_ = kTries;
  request(now);
}

void RoboteqMachine::request(double now) {
  --tries_left_;
  deadline_ = now + kAnswer;
  switch (step_) {
    case Step::Greeting:
      send(echo_off());
      return;
    case Step::Identity:
      send(query("FID"));
      return;
    case Step::Reading:
      send(read_parameter(wanted_[parameter_].name));
      return;
    case Step::Writing: {
      const Wanted& wanted = wanted_[parameter_];
      const std::string name = "^" + std::string(wanted.name);
      confirmations_ = wanted.per_channel ? 2 : 1;
      if (wanted.per_channel) {
        send(command(name, 1, wanted.value));
        send(command(name, 2, wanted.value));
      } else {
        send(command(name, wanted.value));
      }
      return;
    }
    default:
      return;
  }
}

void RoboteqMachine::advance(double now) {
  if (off_.due(now, state_)) cut(now);
  if (off_.pending() && now - braked_at_ > kRepeat) halt(now);  // even without further ticks
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
    case Step::Waiting:
      greet(now);
      return;
    case Step::Running:
      searching_since_ = now;
      greet(now);
      trouble_ =
          fmt::format("The motor controller has been silent for {:.1f} s; it is looked for again.",
                      now - state_.stamp);
      return;
    default:
      break;
  }
  if (tries_left_ > 0) {
    request(now);
  } else if (step_ == Step::Reading && !written_) {
    written_ = true;  // a controller that does not report its parameter may still accept it
    begin(Step::Writing, now);
  } else if ((step_ == Step::Reading || step_ == Step::Writing) && wanted_[parameter_].optional) {
    skip_parameter(now);
  } else if (step_ == Step::Greeting) {
    refuse(fmt::format(
               "No motor controller answers, for {:.0f} s now. Is it powered, and is its serial "
               "line at {} bit/s?",
               now - searching_since_,
               setup_.baud),
           now);
  } else {
    refuse("The motor controller stopped answering while it was being set up.", now);
  }
}

void RoboteqMachine::refuse(const std::string& why, double now) {
  trouble_ = why;
  step_ = Step::Waiting;
  deadline_ = now + kPause;
}

// ---- reports ---------------------------------------------------------------------------------

template <class T>
std::array<T, 2> RoboteqMachine::by_side(const std::array<T, 2>& channels) const {
  std::array<T, 2> sides = channels;
  if (setup_.swapped) std::swap(sides[0], sides[1]);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (setup_.reversed[i]) sides[i] = -sides[i];
  }
  return sides;
}

void RoboteqMachine::take_values(double now, const Reply& reply) {
  if (reply.name == "DI") {
    const auto told = [&](int input) { return static_cast<std::size_t>(input) <= reply.count; };
    const auto hit = [&](int input) {
      return !told(input) || reply.values[static_cast<std::size_t>(input) - 1] != 0;
    };
    bumper_front_ = std::ranges::any_of(setup_.bumper_inputs, hit);
    bumper_rear_ = std::ranges::any_of(setup_.rear_bumper_inputs, hit);
    inputs_told_ = std::ranges::all_of(setup_.bumper_inputs, told) &&
                   std::ranges::all_of(setup_.rear_bumper_inputs, told);
    inputs_at_ = now;
    return;
  }
  if (!update(values_, reply)) {
    // A line that lost a colon looks like that of a controller with one channel.
    singles_ += values_.one_channel ? 1 : 0;
    values_.one_channel = false;
    if (singles_ == kBelieved) {
      refuse("This controller has one channel: no base can be driven with it.", now);
    }
    return;
  }
  if (reply.name == "C" || reply.name == "S") singles_ = 0;
  if (reply.name == "FM" || reply.name == "FS") {
    int& times = stalls_[reply.name == "FM" ? 0 : 1];
    times = says_stalled(reply) ? times + 1 : 0;
  }
  if (reply.name == "C") take_counts(now);
  judge(now);
}

/// Whether the counts imply a faster wheel than possible. Lines carry no check value, so a damaged
/// digit looks like a position far away. If it persists, the counters were reset.
bool RoboteqMachine::jumped(double now, const std::array<std::int32_t, 2>& counts) {
  constexpr double kSlack = 0.01;  // [m] answers come in bursts
  const double fastest = setup_.limits.speed + setup_.limits.turn * setup_.half_track;
  const double furthest = 2 * fastest * (now - state_.stamp) + kSlack;
  const auto too_far = [&](std::size_t i) {
    const std::int64_t moved = algo::count_difference(static_cast<std::uint32_t>(counts[i]),
                                                      static_cast<std::uint32_t>((*counts_)[i]));
    return std::abs(setup_.wheel.metres(moved)) > furthest;
  };
  if (!too_far(0) && !too_far(1)) return false;
  if (++jumps_ == kBelieved) counts_.reset();
  return jumps_ < kBelieved;
}

void RoboteqMachine::take_counts(double now) {
  deadline_ = now + kSilent;
  const std::array<std::int32_t, 2>& counts = *values_.counts;
  if (counts_ && jumped(now, counts)) return;
  jumps_ = 0;
  if (counts_) {
    const auto difference = [&](std::size_t i) {
      return algo::count_difference(static_cast<std::uint32_t>(counts[i]),
                                    static_cast<std::uint32_t>((*counts_)[i]));
    };
    const auto [left, right] = by_side(std::array<std::int64_t, 2>{difference(0), difference(1)});
    const algo::SideMotion rolled{setup_.wheel.metres(left), setup_.wheel.metres(right)};
    // Both wheels' travel as if driven in one second: the arc is the same.
    state_.pose = algo::integrate_arc(state_.pose, algo::twist_of(rolled, setup_.half_track), 1.0);
  }
  counts_ = counts;
  const auto [left, right] = by_side(std::array<std::int64_t, 2>{counts[0], counts[1]});
  state_.counts = std::array{static_cast<std::uint32_t>(left), static_cast<std::uint32_t>(right)};
  state_.stamp = now;
}

/// Assembles the state from the newest answer to each query.
void RoboteqMachine::judge(double now) {
  if (!state_.running && values_.counts && values_.faults && values_.rpm) {
    state_.running = true;
    ++state_.set_ups;
    trouble_.clear();
  }
  if (values_.rpm) {
    const auto [left, right] = by_side(*values_.rpm);
    state_.twist =
        algo::twist_of({setup_.wheel.speed(left), setup_.wheel.speed(right)}, setup_.half_track);
  }
  const std::uint16_t faults = values_.faults.value_or(0);
  const bool stopped = (faults & kStopFault) != 0;
  state_.motors_on = enabled_ && !stopped;
  // With the motors off, our own stop is active and hides the state of the button.
  state_.stop_button = enabled_ && stopped && now - enabled_at_ > kReleaseTime;
  state_.faulty = must_stop(faults & static_cast<std::uint16_t>(~kStopFault));
  state_.volts = values_.battery_volts;
  const bool unread = now - inputs_at_ > kInputsAge;
  const bool watched = !setup_.bumper_inputs.empty() || !setup_.rear_bumper_inputs.empty();
  state_.bumpers_unread = watched && (unread || !inputs_told_);
  state_.bumper_front = !setup_.bumper_inputs.empty() && (bumper_front_ || unread);
  state_.bumper_rear = !setup_.rear_bumper_inputs.empty() && (bumper_rear_ || unread);
  state_.stalled = enabled_ && (stalls_[0] >= kAgreeing || stalls_[1] >= kAgreeing);
  if (values_.motor_amperes && setup_.max_current > 0) {
    const auto& amperes = *values_.motor_amperes;
    const bool high = std::max(std::abs(amperes[0]), std::abs(amperes[1])) > setup_.max_current;
    if (!high) current_since_ = 0;
    if (high && current_since_ == 0) current_since_ = now;
    state_.over_current = high && now - current_since_ > kCurrentTime;
  }
}

// ---- commands --------------------------------------------------------------------------------

void RoboteqMachine::enable(double now, bool on) {
  if (step_ != Step::Running) return;
  if (!on) {
    halt(now);
    if (enabled_) {
      off_.begin(now, braking_time(setup_.limits));
    } else {
      cut(now);
    }
    return;
  }
  off_.cancel();
  enabled_ = true;
  enabled_at_ = now;
  send(release_stop());
  judge(now);
}

void RoboteqMachine::cut(double now) {
  if (!reporting()) return;
  off_.cancel();
  enabled_ = false;
  send(roboteq::drive(0, 0));
  send(emergency_stop());
  judge(now);
}

void RoboteqMachine::drive(double now, const algo::Twist2& twist) {
  if (step_ != Step::Running || !enabled_ || off_.pending()) return;
  const algo::Twist2 wanted = limited(twist, setup_.limits);
  if (braking_ && wanted == algo::Twist2{}) {
    halt(now);  // keep the emergency ramp
    return;
  }
  if (braking_) set_deceleration(wheel_ramp());
  braking_ = false;
  const algo::SideMotion speeds = algo::sides_of(wanted, setup_.half_track);
  const double limit = setup_.limits.speed + setup_.limits.turn * setup_.half_track;
  const std::array<int, 2> sides{setup_.wheel.command_for(speeds.left, limit),
                                 setup_.wheel.command_for(speeds.right, limit)};
  std::array<int, 2> channels{setup_.reversed[0] ? -sides[0] : sides[0],
                              setup_.reversed[1] ? -sides[1] : sides[1]};
  if (setup_.swapped) std::swap(channels[0], channels[1]);
  const bool moves = channels != std::array<int, 2>{};
  const double expires = moves ? now + kMotionExpires : std::numeric_limits<double>::infinity();
  orders_.send_before(expires, roboteq::drive(channels[0], channels[1]).view());
}

/// Brakes in closed loop with the steepest ramp: without power, as after !EX, the wheels would
/// coast. Lines may be lost, so the ramp is sent again while the wheels may turn.
void RoboteqMachine::halt(double now) {
  if (!reporting()) return;
  if (!braking_) braking_since_ = now;
  braking_ = true;
  braked_at_ = now;
  if (now - braking_since_ <= braking_time(setup_.limits)) set_deceleration(emergency_ramp());
  send(roboteq::drive(0, 0));
}

void RoboteqMachine::set_deceleration(int ramp) {
  send(deceleration(1, ramp));
  send(deceleration(2, ramp));
}

void RoboteqMachine::leave(double now) {
  orders_.clear();
  if (step_ != Step::Running) {
    close();
    return;
  }
  enable(now, false);
  step_ = Step::Leaving;
  if (!off_.pending()) close();
}

void RoboteqMachine::close() {
  if (step_ != Step::NoLine) send(end_repetition());
  step_ = Step::Left;
}

algo::DeviceReport RoboteqMachine::report(double now) const {
  algo::DeviceReport out;
  const std::uint16_t faults = values_.faults.value_or(0);
  const auto others = static_cast<std::uint16_t>(faults & ~kStopFault);
  out.well = state_.running && trouble_.empty() && others == 0 && !state_.stop_button &&
             !state_.over_current && !state_.stalled;
  out.sentence = trouble_;
  if (state_.running && others != 0)
    out.sentence = "The controller reports: " + fault_text(others) + ".";
  if (state_.stalled) out.sentence = "A wheel is blocked: a motor cannot follow its command.";
  if (state_.over_current) out.sentence = "A motor takes more current than the file allows.";
  if (state_.stop_button)
    out.sentence = "Its stop input is active: release the stop button, then arm.";
  if (out.sentence.empty()) {
    out.sentence = state_.motors_on ? "Well, motors on." : "Well, motors off.";
  }
  out.remarks = remarks_;
  if (refused_ > 0) {
    out.remarks.push_back("It has refused " + std::to_string(refused_) + " commands.");
  }
  out.facts = {{"kind", "Roboteq"}, {"rate", fmt::format("{} bit/s", setup_.baud)}};
  if (!firmware_.empty()) out.facts.emplace_back("firmware", firmware_);
  if (state_.running) {
    if (state_.volts) out.facts.emplace_back("battery", fmt::format("{:.1f} V", *state_.volts));
    if (values_.motor_amperes) {
      out.facts.emplace_back(
          "motors",
          fmt::format(
              "{:.1f} A, {:.1f} A", (*values_.motor_amperes)[0], (*values_.motor_amperes)[1]));
    }
    if (values_.motor_flags) {
      out.facts.emplace_back(
          "motor flags",
          fmt::format("{}, {}", (*values_.motor_flags)[0], (*values_.motor_flags)[1]));
    }
    out.facts.emplace_back("age", fmt::format("{:.2f} s", now - state_.stamp));
  }
  return out;
}

}  // namespace drivers::roboteq
