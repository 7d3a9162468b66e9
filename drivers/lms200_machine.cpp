// drivers/lms200_machine.cpp: the dialogue with an LMS2xx, step by step.
#include "drivers/lms200_machine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "algo/dazzle.hpp"
#include "algo/perceive.hpp"

namespace drivers::lms200 {
namespace {

constexpr std::array<unsigned, 4> kRates{9600, 19200, 38400, 500'000};

constexpr double kByteSilence = 0.03;  // [s] ends a frame: 14 ms and a USB chip's 16
constexpr double kListen = 3.0;        // [s] for a greeting before all rates are tried again
constexpr double kBootTime = 60.0;     // [s] at most from power to greeting
constexpr double kSilent = 1.0;        // [s] without a telegram: search for the device again
constexpr double kFirstScan = 3.5;     // [s] at most until the first scan
constexpr double kDamageWeight = 1.0 / 16;
constexpr std::uint64_t kMostAtOnce = 4;
constexpr double kStorm = 0.5;  // share of damaged telegrams that starts a storm
constexpr double kCalm = 0.1;   // share that ends it: a bad cable is intermittent

/// Whether a port set to `wanted` that runs at `is` [bit/s] can talk to a device at `wanted`.
bool close_enough(unsigned wanted, unsigned is) {
  constexpr double kTolerance = 0.03;  // relative; 8N1 tolerates no more
  return std::abs(static_cast<double>(is) - wanted) <= kTolerance * wanted;
}

}  // namespace

LaserMachine::LaserMachine(LaserSetup setup) : setup_(std::move(setup)), wanted_(setup_.baud) {}

// ---- the line --------------------------------------------------------------------------------

void LaserMachine::opened(double now, unsigned baud) {
  orders_.clear();
  remarks_.clear();
  fixed_rate_ = baud == 0;
  port_baud_ = wanted_;
  baud_ = told_baud_ = found_baud_ = 0;
  last_byte_ = now;
  if (!fixed_rate_ && !close_enough(wanted_, baud)) {
    fall_back(fmt::format("This port makes {} bit/s of {}.", baud, wanted_));
  }
  searching_since_ = now;
  search(now);
}

void LaserMachine::closed(double /*now*/, const std::string& why) {
  orders_.clear();
  reader_.clear();
  if (step_ != Step::Left) step_ = Step::NoLine;
  baud_ = 0;
  trouble_ = why;
  deadline_ = std::numeric_limits<double>::infinity();
}

void LaserMachine::rate_set(double now, unsigned baud) {
  reader_.clear();
  if (step_ != Step::Probe || fixed_rate_ || close_enough(port_baud_, baud)) return;
  // Do not probe at a rate that this port cannot make.
  if (port_baud_ == wanted_) {
    fall_back(fmt::format("This port makes {} bit/s of {}.", baud, wanted_));
  }
  orders_.clear();
  ++rate_index_;
  probe(now);
}

/// Uses the fallback rate from now on, and reports the cost.
void LaserMachine::fall_back(const std::string& why) {
  if (wanted_ <= kFallbackRate) return;
  wanted_ = kFallbackRate;
  remark(why +
         fmt::format(" The line runs at {} bit/s instead, which brings 4 to 5 scans a second at "
                     "half a degree instead of 37: drive slowly.",
                     kFallbackRate));
}

void LaserMachine::remark(const std::string& sentence) {
  if (std::find(remarks_.begin(), remarks_.end(), sentence) == remarks_.end()) {
    remarks_.push_back(sentence);
  }
}

void LaserMachine::receive(double now, ByteView bytes) {
  last_byte_ = now;
  reader_.feed(
      bytes,
      [&](ByteView frame) { take_telegram(now, frame); },
      [&](std::uint8_t byte) { take_stray(byte); });
}

void LaserMachine::advance(double now) {
  if (reader_.pending() > 0 && now - last_byte_ > kByteSilence) {
    reader_.expire([&](ByteView frame) { take_telegram(now, frame); },
                   [&](std::uint8_t byte) { take_stray(byte); });
  }
  if (now < deadline_) return;
  switch (step_) {
    case Step::NoLine:
    case Step::Left:
      deadline_ = std::numeric_limits<double>::infinity();
      return;
    case Step::Listen:
      search(now);
      return;
    case Step::RateSettles:
      reader_.clear();
      begin(Step::RateConfirmed, now);
      return;
    case Step::Streaming:
      trouble_ = fmt::format("The scanner has been silent for {:.1f} s; it is looked for again.",
                             now - last_heard_);
      searching_since_ = now;
      search(now);
      return;
    default:
      if (waits_on(now)) return;
      if (tries_left_ > 0 || asks_again(now)) {
        request(now);
      } else {
        unanswered(now);
      }
  }
}

double LaserMachine::wake_time() const {
  return reader_.pending() > 0 ? std::min(deadline_, last_byte_ + 1.1 * kByteSilence) : deadline_;
}

// ---- finding the device ----------------------------------------------------------------------

/// Probes the wanted rate first: an earlier program may have left the device streaming at it.
void LaserMachine::search(double now) {
  rates_[0] = wanted_;
  std::size_t n = 1;
  for (const unsigned rate : kRates) {
    if (rate != wanted_ && n < rates_.size()) rates_[n++] = rate;
  }
  rate_index_ = 0;
  baud_ = nak_baud_ = 0;
  probe(now);
}

void LaserMachine::probe(double now) {
  if (rate_index_ >= (fixed_rate_ ? 1 : rates_.size())) {
    listen(now);
    return;
  }
  const unsigned rate = rates_[rate_index_];
  if (!fixed_rate_ && rate != port_baud_) orders_.set_baud(rate);
  port_baud_ = rate;
  reader_.clear();
  begin(Step::Probe, now);
}

/// Waits for the greeting of a starting device, always sent at kStartRate.
void LaserMachine::listen(double now) {
  step_ = Step::Listen;
  deadline_ = now + kListen;
  const double waited = now - searching_since_;
  trouble_ =
      nak_baud_ > 0 ? damaged_words()
      : waited < kBootTime
          ? fmt::format("No answer at any rate; waiting for power-on, {:.0f} s so far.", waited)
          : fmt::format(
                "No answer at any rate for {:.0f} s. Is it powered, are RX and TX the right "
                "way round, does the plug's jumper fit the line (RS-232 or RS-422)?",
                waited);
  if (fixed_rate_ || port_baud_ == kStartRate) return;
  orders_.set_baud(kStartRate);
  port_baud_ = kStartRate;
  reader_.clear();
}

// ---- received bytes --------------------------------------------------------------------------

void LaserMachine::take_telegram(double now, ByteView frame) {
  const Telegram telegram = telegram_of(frame);
  last_heard_ = now;
  address_ = static_cast<std::uint8_t>(telegram.address - kAnswerAddress);
  const LineCounters& line = reader_.counters();
  const std::uint64_t bad = line.bad_checks + line.given_up;
  // Noise between two telegrams may look like several telegrams.
  for (auto n = std::min(bad - bad_before_, kMostAtOnce); n > 0; --n) {
    damaged_ += (1 - damaged_) * kDamageWeight;
  }
  damaged_ -= damaged_ * kDamageWeight;
  bad_before_ = bad;
  storm_ = damaged_ > (storm_ ? kCalm : kStorm);

  switch (static_cast<Answer>(telegram.code())) {
    case Answer::Values:
      if (step_ == Step::Streaming) take_values(now, telegram, frame.size());
      return;
    case Answer::PowerOn:
      // The device has restarted: it is at its start rate and must be set up again.
      if (step_ == Step::Stopping || step_ == Step::Restoring || step_ == Step::Left) return;
      if (step_ == Step::Streaming) {
        trouble_ = "The scanner has restarted; it is being set up again.";
        searching_since_ = now;
      }
      begin(Step::Type, now);
      return;
    default:
      if (answers(telegram)) answered(now, telegram);
  }
}

/// Whether `telegram` answers the request of the present step.
bool LaserMachine::answers(const Telegram& telegram) const {
  const auto code = static_cast<Answer>(telegram.code());
  if (step_ == Step::NoLine || step_ == Step::Left || step_ == Step::Listen ||
      step_ == Step::RateSettles || step_ == Step::Streaming) {
    return false;
  }
  if (code == Answer::Refused) return true;
  switch (step_) {
    case Step::Type:
    case Step::RateConfirmed:
      return code == Answer::Type;
    case Step::Status:
      return code == Answer::Status;
    case Step::Variant:
      return code == Answer::Variant;
    case Step::ReadConfiguration:
      return code == Answer::Configuration;
    case Step::WriteConfiguration:
      return code == Answer::ConfigurationWritten;
    default:
      return code == Answer::Mode;
  }
}

void LaserMachine::answered(double now, const Telegram& telegram) {
  switch (step_) {
    case Step::Probe:
      begin(Step::Type, now);
      return;
    case Step::Type:
      if (const auto text = type_text(telegram)) {
        type_ = text->substr(0, text->find_last_not_of(' ') + 1);
      }
      // A rate other than the ordered one is the device's own: it has restarted.
      if (found_baud_ == 0 || port_baud_ != told_baud_) found_baud_ = port_baud_;
      baud_ = port_baud_;
      begin(Step::Status, now);
      return;
    case Step::Status:
      if (const auto status = device_status(telegram)) {
        software_ = status->software.substr(0, status->software.find_last_not_of(' ') + 1);
        variant_ = status->variant;
        measuring_mode_ = status->measuring_mode;
        in_millimetres_ = status->in_millimetres;
        if (status->faulty) remark("The scanner reports a fault: read its error memory.");
      }
      health_ = Health(telegram.status());
      identified(now);
      return;
    case Step::Rate:
      rate_answered(now, telegram);
      return;
    case Step::RateConfirmed:
      choose_variant(now);
      return;
    case Step::Variant:
      variant_answered(now, telegram);
      return;
    case Step::Installation:
      if (const std::string why = refusal_text(telegram); !why.empty()) {
        remark("Its configuration cannot be read and stays as it is: " + why);
        begin(Step::Start, now);
      } else {
        begin(Step::ReadConfiguration, now);
      }
      return;
    case Step::ReadConfiguration:
      configuration_read(now, telegram);
      return;
    case Step::WriteConfiguration:
      configuration_written(now, telegram);
      return;
    case Step::Start:
      if (const std::string why = refusal_text(telegram); !why.empty()) {
        listen(now);
        trouble_ = "The scanner does not start to send: " + why;
      } else {
        start_streaming(now);
      }
      return;
    case Step::Stopping:
      restore_rate(now);
      return;
    case Step::Restoring:
      step_ = Step::Left;
      return;
    default:
      return;
  }
}

void LaserMachine::unanswered(double now) {
  switch (step_) {
    case Step::Probe:
      if (takes_all_for_damaged()) nak_baud_ = port_baud_;
      ++rate_index_;
      probe(now);
      return;
    case Step::Status:
      identified(now);  // optional: scans arrive without it too
      return;
    case Step::RateConfirmed:
      fall_back(fmt::format("The scanner does not answer at {} bit/s.", wanted_));
      search(now);
      return;
    case Step::WriteConfiguration:
      remark("The scanner did not confirm its new configuration.");
      begin(Step::ReadConfiguration, now);
      return;
    case Step::Stopping:
      restore_rate(now);
      return;
    case Step::Restoring:
      step_ = Step::Left;
      return;
    default:
      trouble_ = takes_all_for_damaged()
                     ? damaged_words()
                     : "The scanner stopped answering while it was being set up; it is looked for "
                       "again.";
      search(now);
  }
}

// ---- scans -----------------------------------------------------------------------------------

/// [s] between two scans, from the manual.
double LaserMachine::nominal_period() const {
  return lms200::scan_period(interlaced() ? setup_.variant : decoder_.variant(),
                             baud_ > 0 ? baud_ : kStartRate);
}

void LaserMachine::start_streaming(double now) {
  const std::optional<WordFormat> format = word_format(measuring_mode_);
  if (!format) {
    listen(now);
    trouble_ = "The scanner's measuring mode sends no distances.";
    return;
  }
  fresh_ = false;
  blinded_ = false;
  dazzled_.reset();
  decoder_ = ScanDecoder(variant_.value_or(set_variant()), *format);
  parts_ = PartialScans(setup_.variant, *format);
  period_ = nominal_period();
  last_arrival_ = 0;
  long_gaps_ = 0;
  last_heard_ = now;
  trouble_.clear();
  ++set_ups_;
  step_ = Step::Streaming;
  deadline_ = now + std::max(kFirstScan, 4 * period_);
}

void LaserMachine::take_values(double now, const Telegram& telegram, std::size_t bytes) {
  deadline_ = now + std::max(kSilent, 4 * period_);
  const std::optional<MeasuredValues> values = measured_values(telegram);
  if (!values) return;
  const bool whole =
      values->partial ? parts_.add(*values, filling_) : decoder_.decode(*values, filling_);
  if (whole) deliver(now, bytes, values->health);
}

void LaserMachine::deliver(double now, std::size_t bytes, Health health) {
  health_ = health;
  measure_period(now);
  if (!health.usable()) return;
  ++scans_;
  // The last byte arrived now; the sweep ended when the first byte was sent.
  filling_.stamp = now - transfer_time(bytes, baud_);
  if (setup_.upside_down) {
    std::reverse(filling_.ranges.begin(), filling_.ranges.end());
    std::reverse(filling_.status.begin(), filling_.status.end());
    std::reverse(filling_.codes.begin(), filling_.codes.end());
  }
  filling_.mount_R = {};  // the recycled scan still has its last reader's mount
  blinded_ = algo::blinded(filling_);
  dazzled_.reset();
  if (const algo::BeamSpan cone = algo::widest_cone(filling_); cone.end > cone.begin) {
    dazzled_ = Dazzled{filling_.angle(cone.begin), filling_.angle(cone.end - 1)};
  }
  last_scan_ = now;
  if (fresh_) ++replaced_;
  std::swap(filling_, ready_);
  fresh_ = true;
}

/// The motor sets the scan rate: scans in a bunch were delayed on the way, and a gap means missing
/// scans. Only when every gap is long is the rate itself lower, from the line or a setting.
void LaserMachine::measure_period(double now) {
  constexpr double kWeight = 1.0 / 16;
  constexpr double kShortest = 0.9;  // of the nominal period
  constexpr double kLongest = 2.5;   // periods
  constexpr unsigned kSurely = 8;    // gaps in a row
  const double gap = now - last_arrival_;
  const bool first = last_arrival_ == 0;
  last_arrival_ = now;
  if (first) return;
  long_gaps_ = gap < kLongest * period_ ? 0 : long_gaps_ + 1;
  if (long_gaps_ == 0) {
    period_ = std::max(period_ + (gap - period_) * kWeight, kShortest * nominal_period());
  } else if (long_gaps_ >= kSurely) {
    period_ = gap;
    long_gaps_ = 0;
  }
}

bool LaserMachine::take(algo::LaserScan& scan) {
  if (!fresh_) return false;
  fresh_ = false;
  const algo::Pose2 mount = scan.mount_R;
  std::swap(scan, ready_);
  scan.mount_R = mount;
  return true;
}

Stage LaserMachine::stage() const {
  switch (step_) {
    case Step::NoLine:
    case Step::Left:
      return Stage::NoLine;
    case Step::Probe:
    case Step::Listen:
      return Stage::Searching;
    case Step::Streaming:
      return Stage::Running;
    default:
      return Stage::SettingUp;
  }
}

LaserReport LaserMachine::report() const {
  LaserReport out;
  out.stage = stage();
  out.trouble = trouble_;
  if (trouble_.empty() && out.stage != Stage::Running) out.trouble = "The scanner is being set up.";
  out.remarks = remarks_;
  out.type = type_;
  out.software = software_;
  out.baud = baud_;
  out.address = address_;
  out.variant = interlaced() ? setup_.variant : variant_.value_or(Variant{});
  out.measuring_mode = measuring_mode_;
  out.in_millimetres = in_millimetres_;
  out.health = health_;
  out.line = reader_.counters();
  out.scans = scans_;
  out.replaced = replaced_;
  out.set_ups = set_ups_;
  out.written = written_;
  out.damaged = damaged_;
  out.storm = storm_;
  out.blinded = blinded_;
  out.dazzled = dazzled_;
  out.nominal_period = nominal_period();
  out.scan_period = period_;
  out.last_scan = last_scan_;
  return out;
}

// ---- leaving ---------------------------------------------------------------------------------

/// A device at an unknown rate cannot be commanded.
void LaserMachine::leave(double now) {
  orders_.clear();
  if (baud_ == 0) {
    step_ = Step::Left;
    return;
  }
  begin(Step::Stopping, now);
}

void LaserMachine::restore_rate(double now) {
  if (fixed_rate_ || baud_ == found_baud_) {
    step_ = Step::Left;
  } else {
    begin(Step::Restoring, now);
  }
}

}  // namespace drivers::lms200
