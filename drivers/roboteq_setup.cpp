// drivers/roboteq_setup.cpp: the set-up of a Roboteq controller before it is driven.
#include <algorithm>

#include <fmt/format.h>

#include "drivers/roboteq_machine.hpp"

namespace drivers::roboteq {
namespace {

constexpr int kQueryPeriod_ms = 10;  // between two of the repeated queries

}  // namespace

void RoboteqMachine::take_line(double now, std::string_view line) {
  const Reply reply = parse_reply(line);
  using Kind = Reply::Kind;
  switch (step_) {
    case Step::Greeting:
      if (reply.kind == Kind::Accepted) begin(Step::Identity, now);
      return;
    case Step::Identity:
      if (reply.name != "FID") return;
      firmware_ = reply.text;
      parameter_ = 0;
      written_ = false;
      begin(Step::Reading, now);
      return;
    case Step::Reading:
      if (reply.kind == Kind::Values && reply.name == wanted_[parameter_].name) {
        parameter_read(now, reply);
      } else if (reply.kind == Kind::Refused && wanted_[parameter_].optional) {
        skip_parameter(now);
      }
      return;
    case Step::Writing:
      if (reply.kind == Kind::Refused && wanted_[parameter_].optional) {
        skip_parameter(now);
      } else if (reply.kind == Kind::Refused) {
        refuse("The motor controller does not accept its parameter ^" +
                   std::string(wanted_[parameter_].name) + ".",
               now);
      } else if (reply.kind == Kind::Accepted && --confirmations_ <= 0) {
        begin(Step::Reading, now);  // verify by reading it back
      }
      return;
    case Step::Running:
    case Step::Leaving:
      if (reply.kind == Kind::Refused) ++refused_;
      if (reply.kind == Kind::Values) take_values(now, reply);
      return;
    default:
      return;
  }
}

void RoboteqMachine::parameter_read(double now, const Reply& reply) {
  const Wanted& wanted = wanted_[parameter_];
  const std::size_t count = std::min(reply.count, reply.values.size());
  if (wanted.per_channel && count < 2) {
    refuse("This controller has one channel: no base can be driven with it.", now);
    return;
  }
  const bool as_wanted =
      count > 0 && std::all_of(reply.values.begin(),
                               reply.values.begin() + static_cast<std::ptrdiff_t>(count),
                               [&](int value) { return value == wanted.value; });
  if (as_wanted) {
    next_parameter(now);
  } else if (!written_) {
    written_ = true;
    begin(Step::Writing, now);
  } else if (wanted.optional) {
    skip_parameter(now);
  } else {
    refuse(fmt::format("The motor controller keeps ^{} at {} instead of {}.",
                       wanted.name,
                       reply.values[0],
                       wanted.value),
           now);
  }
}

void RoboteqMachine::skip_parameter(double now) {
  remarks_.push_back("It does not take ^" + std::string(wanted_[parameter_].name) +
                     ": only the encoder shows a blocked wheel.");
  written_ = false;
  next_parameter(now);
}

void RoboteqMachine::next_parameter(double now) {
  if (written_) {
    remarks_.push_back("Its parameter ^" + std::string(wanted_[parameter_].name) +
                       " was set, until power-off.");
  }
  written_ = false;
  ++parameter_;
  if (parameter_ < wanted_.size()) {
    begin(Step::Reading, now);
  } else {
    run(now);
  }
}

/// The power stage stays off until enable(true).
void RoboteqMachine::run(double now) {
  // Counts and speeds come in every round, since other values change more slowly. A controller
  // keeps at most sixteen queries.
  constexpr std::array<std::string_view, 16> kQueries{
      "C", "S", "FF", "FM", "C", "S", "A", "V", "C", "S", "FF", "FM", "C", "S", "FS", "DI"};
  const bool bumpers = !setup_.bumper_inputs.empty() || !setup_.rear_bumper_inputs.empty();
  const std::size_t count = bumpers ? kQueries.size() : kQueries.size() - 1;
  send(emergency_stop());
  send(set_counter(1, 0));
  send(set_counter(2, 0));
  send(repeat_queries(std::span(kQueries).first(count), kQueryPeriod_ms));
  step_ = Step::Running;
  deadline_ = now + kSilent;
  inputs_at_ = now;
  const algo::Pose2 pose = state_.pose;  // the last pose before it was lost
  state_ = {.set_ups = state_.set_ups, .pose = pose};
  trouble_ = "The motor controller is being set up.";
}

}  // namespace drivers::roboteq
