// drivers/lms200_setup.cpp: the requests to an LMS2xx that bring it to the wanted settings.
#include <algorithm>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "drivers/lms200_machine.hpp"

namespace drivers::lms200 {
namespace {

constexpr double kAnswer = 0.06;              // [s] an ordinary answer, without its transfer
constexpr double kProbeWait = 0.2;            // [s] a scan that was cut may have to run out first
constexpr double kModeSwitch = 3.5;           // [s] at most 3, plus the answer's transfer
constexpr double kDeaf = 3.0;                 // [s] after a switch or power-on, at most
constexpr double kConfigurationWrite = 15.0;  // [s] at most
constexpr double kRateSettle = 0.3;           // [s] after a change of the rate
constexpr int kTries = 3;
constexpr std::uint64_t kMostWrites = 2;  // of the configuration while this program runs

double answer_time(std::size_t bytes, unsigned baud) {
  return kAnswer + transfer_time(bytes, baud > 0 ? baud : kStartRate);
}

std::optional<Rate> rate_of(unsigned baud) {
  for (const Rate rate : {Rate::Baud9600, Rate::Baud19200, Rate::Baud38400, Rate::Baud500000}) {
    if (baud_of(rate) == baud) return rate;
  }
  return std::nullopt;
}

std::string variant_text(const Variant& variant) {
  return fmt::format(
      "{} degrees in steps of {:.2f}", variant.angle_degrees, variant.step_centidegrees / 100.0);
}

}  // namespace

bool good_password(std::string_view password) {
  const auto plain = [](char c) { return c >= ' ' && c <= '~'; };
  return password.size() == kFactoryPassword.size() && std::ranges::all_of(password, plain);
}

std::string refusal(const LaserSetup& setup) {
  if (carries(setup.variant, setup.baud)) return "";
  return fmt::format(
      "180 degrees in steps of 0.25 come interlaced, which a line of {} bit/s does not "
      "carry: take steps of 0.5, 100 degrees, or 500000 bit/s",
      setup.baud);
}

// ---- asking ----------------------------------------------------------------------------------

void LaserMachine::begin(Step step, double now) {
  step_ = step;
  step_since_ = now;
  naks_ = strays_ = 0;
  tries_left_ = tries_for(step);
  request(now);
}

void LaserMachine::request(double now) {
  --tries_left_;
  requested_at_ = now;
  acknowledged_ = false;
  orders_.send_slowly(command_for(step_).view());
  deadline_ = now + limit_for(step_);
}

Command LaserMachine::command_for(Step step) const {
  switch (step) {
    case Step::Probe:
    case Step::Stopping:
      return mode_command(Mode::OnRequest);
    case Step::Type:
    case Step::RateConfirmed:
      return type_command();
    case Step::Status:
      return status_command();
    case Step::Rate:
      return rate_command(rate_of(wanted_).value_or(Rate::Baud9600));
    case Step::Variant:
      return variant_command(set_variant());
    case Step::Installation:
      return installation_command(setup_.password);
    case Step::ReadConfiguration:
      return read_configuration_command();
    case Step::WriteConfiguration:
      return write_configuration_command(written_block_);
    case Step::Start:
      return mode_command(interlaced() ? Mode::PartialScans : Mode::Continuous);
    case Step::Restoring:
      return rate_command(rate_of(found_baud_).value_or(Rate::Baud9600));
    default:
      return {};
  }
}

double LaserMachine::limit_for(Step step) const {
  constexpr std::size_t kStatusBytes = 160;
  constexpr std::size_t kShortBytes = 60;
  switch (step) {
    case Step::Probe:
    case Step::Stopping:
    case Step::Restoring:
      return kProbeWait + transfer_time(kShortBytes, port_baud_);
    case Step::Status:
      return 2 * answer_time(kStatusBytes, port_baud_);
    case Step::Rate:
    case Step::Variant:
    case Step::Installation:
    case Step::Start:
      return kModeSwitch;
    case Step::WriteConfiguration:
      return kConfigurationWrite;
    default:
      return 2 * answer_time(kShortBytes, port_baud_);
  }
}

int LaserMachine::tries_for(Step step) const {
  switch (step) {
    case Step::WriteConfiguration:
      return 1;  // a repetition would wear the memory again
    case Step::Stopping:
    case Step::Restoring:
      return 2;
    default:
      return kTries;
  }
}

/// Handles a byte outside of telegrams. At a wrong rate any byte may come.
void LaserMachine::take_stray(std::uint8_t byte) {
  if (byte == kNak) ++naks_;
  if (byte != kNak && byte != kAck) ++strays_;
  acknowledged_ = byte == kAck;
}

/// An acknowledged mode switch may take long; without an acknowledgement the wait is shorter.
bool LaserMachine::waits_on(double now) {
  const bool switches = step_ == Step::Probe || step_ == Step::Stopping || step_ == Step::Restoring;
  if (!switches || !acknowledged_ || now >= requested_at_ + kModeSwitch) return false;
  deadline_ = std::min(now + limit_for(step_), requested_at_ + kModeSwitch);
  return true;
}

/// A device that answered before may be deaf for a while, so the request is repeated until then.
bool LaserMachine::asks_again(double now) const {
  switch (step_) {
    case Step::Probe:
    case Step::WriteConfiguration:
      return false;
    case Step::Stopping:
    case Step::Restoring:
      return now - last_heard_ < kDeaf;
    default:
      return now - step_since_ < kDeaf;
  }
}

bool LaserMachine::takes_all_for_damaged() const {
  constexpr int kSurely = 2;
  return naks_ >= kSurely && strays_ == 0;
}

std::string LaserMachine::damaged_words() const {
  return fmt::format(
      "A device answers at {} bit/s, but only with NAK (damaged). Look at the cable, its shield "
      "and its ground; another kind of device would not send NAK.",
      nak_baud_ > 0 ? nak_baud_ : port_baud_);
}

// ---- set-up ----------------------------------------------------------------------------------

void LaserMachine::identified(double now) {
  if (!setup_.as_it_is && !fixed_rate_ && baud_ != wanted_) {
    told_baud_ = wanted_;
    begin(Step::Rate, now);
  } else if (!setup_.as_it_is) {
    choose_variant(now);
  } else {
    begin(Step::Installation, now);
  }
}

/// Called once the rate is settled, since the rate decides which variant the line can carry.
void LaserMachine::choose_variant(double now) {
  if (!carries(setup_.variant, baud_)) {
    setup_.variant = {180, 50};
    remark(fmt::format("A line of {} bit/s does not carry quarters of a degree: half degrees come.",
                       baud_));
  }
  begin(variant_ == set_variant() ? Step::Installation : Step::Variant, now);
}

/// The device answers at the old rate, then switches.
void LaserMachine::rate_answered(double now, const Telegram& telegram) {
  if (const std::string why = refusal_text(telegram); !why.empty()) {
    if (wanted_ > kFallbackRate) {
      fall_back(why);
      identified(now);
    } else {
      remark(fmt::format("It stays at {} bit/s: ", baud_) + why);
      choose_variant(now);
    }
    return;
  }
  orders_.set_baud(wanted_);
  port_baud_ = baud_ = wanted_;
  step_ = Step::RateSettles;
  deadline_ = now + kRateSettle;
}

void LaserMachine::variant_answered(double now, const Telegram& telegram) {
  if (const auto answer = variant_answer(telegram)) variant_ = answer->now;
  if (variant_ != set_variant()) {
    remark("It does not take " + variant_text(set_variant()) + "; it has " +
           variant_text(variant_.value_or(Variant{})) + ".");
  }
  begin(Step::Installation, now);
}

/// The configuration read, with only the necessary changes.
Configuration LaserMachine::wanted_configuration(const Configuration& now) const {
  // Each range has three modes that differ only in their flag bits, which are masked anyway.
  const auto mode = [&]() -> std::uint8_t {
    const std::uint16_t top = setup_.range == 16 ? 0x3FFF : setup_.range == 32 ? 0x7FFF : 0x1FFF;
    const auto format = word_format(now.measuring_mode());
    if (format && format->mask == top) return now.measuring_mode();
    return setup_.range == 16 ? 0x04 : setup_.range == 32 ? 0x06 : 0x00;
  };
  Configuration wanted = now;
  wanted.set_measuring_mode(mode());
  wanted.set_millimetres(setup_.range != 80);
  return wanted;
}

void LaserMachine::adopt(const Configuration& configuration) {
  configuration_ = configuration;
  measuring_mode_ = configuration.measuring_mode();
  in_millimetres_ = configuration.in_millimetres();
}

void LaserMachine::configuration_read(double now, const Telegram& telegram) {
  const auto answer = configuration_answer(telegram);
  if (!answer) {
    remark("Its configuration cannot be read and stays as it is: " + refusal_text(telegram));
    begin(Step::Start, now);
    return;
  }
  adopt(answer->now);
  written_block_ = wanted_configuration(answer->now);
  if (written_block_ == configuration_ || setup_.as_it_is) {
    begin(Step::Start, now);
  } else if (written_ >= kMostWrites) {
    remark("Its configuration is not as wanted and is not written again, to spare its memory.");
    begin(Step::Start, now);
  } else {
    ++written_;
    begin(Step::WriteConfiguration, now);
  }
}

void LaserMachine::configuration_written(double now, const Telegram& telegram) {
  const auto answer = configuration_answer(telegram);
  if (answer) adopt(answer->now);
  if (!answer || !answer->done || !(configuration_ == written_block_)) {
    remark("It did not take its configuration; the one in force is used.");
  }
  begin(Step::Start, now);
}

}  // namespace drivers::lms200
