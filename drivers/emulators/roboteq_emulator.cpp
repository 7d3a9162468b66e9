// drivers/emulators/roboteq_emulator.cpp: how a Roboteq controller handles its input lines.
#include "drivers/emulators/roboteq_emulator.hpp"

#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

namespace drivers::roboteq {
namespace {

using emulators::WheelMotion;

constexpr unsigned kBaud = 115200;  // fixed
constexpr std::uint8_t kEnquiryByte = 0x05;
constexpr std::uint8_t kEnquiryAnswer = 0x06;
constexpr double kThinking = 0.001;  // [s] before an answer
constexpr std::size_t kLongestLine = 128;
constexpr int kFullCommand = 1000;
constexpr int kRestartKey = 321654987;

enum Fault : unsigned { Undervoltage = 4, EmergencyStop = 16 };
enum Status : unsigned { Serial = 1, StageOff = 8, Stalled = 16 };
enum MotorFlag : unsigned { MotorStalled = 2, LoopError = 4 };
constexpr double kLowestVolts = 20;

std::size_t index_of(int channel) {
  return static_cast<std::size_t>(channel - 1);
}

}  // namespace

Emulator::Emulator(const EmulatorOptions& options)
    : Device(kBaud, options.seed), options_(options), volts_(options.volts) {
  parameters_.watchdog_ms = options.watchdog_ms;
  parameters_.full_rpm = {options.full_speed_rpm, options.full_speed_rpm};
  parameters_.encoder_lines = {options.encoder_lines, options.encoder_lines};
  stored_ = parameters_;
  counts_.fill(options.first_count);
}

// ---- lines -------------------------------------------------------------------------------------

void Emulator::on_byte(std::uint8_t byte, double at) {
  if (at < boot_end_) return;
  if (byte == kEnquiryByte) {
    line().say(std::array{kEnquiryAnswer}, at);
    return;
  }
  if (echo_) line().say(std::array{byte}, at);
  if (byte == '_' || byte == '\r' || byte == '\n') {
    const std::string whole = std::exchange(line_text_, {});
    if (!whole.empty()) take(whole, at);
    return;
  }
  if (line_text_.size() < kLongestLine) line_text_.push_back(static_cast<char>(byte));
}

void Emulator::say(std::string_view text, double at) {
  FixedBytes<256> bytes;
  bytes.append(text);
  bytes.push_back('\r');
  line().say(bytes.view(), at + kThinking);
}

/// Splits "!G 1 500" into '!', "G" and its numbers; false for any other text.
bool Emulator::parse(std::string_view text, Order& order) const {
  if (text.empty()) return false;
  order.kind = text[0];
  text.remove_prefix(1);
  const auto word = [&text] {
    const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
    text.remove_prefix(begin);
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view found = text.substr(0, end);
    text.remove_prefix(end);
    return found;
  };
  order.name = word();
  for (std::string_view number = word(); !number.empty(); number = word()) {
    if (order.count == order.numbers.size()) return false;
    int value = 0;
    const char* const end = number.data() + number.size();
    if (std::from_chars(number.data(), end, value).ptr != end) return false;
    order.numbers[order.count++] = value;
  }
  return true;
}

void Emulator::take(std::string_view line, double at) {
  Order order;
  const bool sound = parse(line, order);
  bool done = false;
  switch (order.kind) {
    case '!':
      done = sound && command(order, at);
      break;
    case '^':
      done = sound && set(order);
      break;
    case '%':
      done = sound && maintain(order, at);
      break;
    case '?':
      if (sound && ask(order, at)) {
        history_.emplace_back(line);
        return;
      }
      break;
    case '~':
      if (sound && read(order, at)) return;
      break;
    case '#':
      // Only this command may have a letter as argument.
      repeat(order, at);
      return;
    default:
      break;
  }
  say(done ? "+" : "-", at);
}

// ---- commands ----------------------------------------------------------------------------------

bool Emulator::channel_fits(int channel) const {
  return channel == 1 || (channel == 2 && !options_.one_channel);
}

bool Emulator::command(const Order& order, double at) {
  if (order.name == "EX" && order.count == 0) {
    emergency_ = true;
    halt(at);
    return true;
  }
  if (order.name == "MG" && order.count == 0) {
    if (!stop_pressed_) emergency_ = false;
    return true;
  }
  return drive_command(order, at) || channel_command(order, at);
}

/// Motion commands, which feed the watchdog.
bool Emulator::drive_command(const Order& order, double at) {
  const auto fraction = [&](std::size_t channel, int value) {
    return std::clamp(value, -kFullCommand, kFullCommand) * parameters_.full_rpm[channel] /
           static_cast<double>(kFullCommand);
  };
  std::array<double, kChannels> wanted = wanted_rpm_;
  if (order.name == "G" && order.count == 2 && channel_fits(order.numbers[0])) {
    const std::size_t channel = index_of(order.numbers[0]);
    wanted[channel] = fraction(channel, order.numbers[1]);
  } else if (order.name == "S" && order.count == 2 && channel_fits(order.numbers[0]) &&
             parameters_.mode[index_of(order.numbers[0])] == 1) {
    const std::size_t channel = index_of(order.numbers[0]);
    const int full = parameters_.full_rpm[channel];
    wanted[channel] = std::clamp(order.numbers[1], -full, full);
  } else if (order.name == "M" && order.count == 2 && !options_.one_channel) {
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      wanted[channel] = fraction(channel, order.numbers[channel]);
    }
  } else if (order.name == "MS" && order.count == 1 && channel_fits(order.numbers[0])) {
    wanted[index_of(order.numbers[0])] = 0;
  } else {
    return false;
  }
  commanded_ = at;
  if (emergency_ || (fault_bits() & Undervoltage) != 0) wanted = {};
  wanted_rpm_ = wanted;
  report(at, {.left = wheel_speed(0, wanted[0]), .right = wheel_speed(1, wanted[1])});
  return true;
}

bool Emulator::channel_command(const Order& order, double at) {
  if (order.count != 2 || !channel_fits(order.numbers[0])) return false;
  const std::size_t channel = index_of(order.numbers[0]);
  const int value = order.numbers[1];
  if (order.name == "C") {
    counts_[channel] = value;
    asked_counts_[channel] = value;
  } else if (order.name == "AC" && value > 0) {
    parameters_.acceleration[channel] = value;
  } else if (order.name == "DC" && value > 0) {
    parameters_.deceleration[channel] = value;
  } else {
    return false;
  }
  commanded_ = at;  // any command that begins with ! feeds the watchdog
  return true;
}

/// The values of a parameter for both channels.
Emulator::Pair* Emulator::pair_of(std::string_view name) {
  const std::array<std::pair<std::string_view, Pair*>, 11> table{{
      {"MMOD", &parameters_.mode},
      {"MXRPM", &parameters_.full_rpm},
      {"EPPR", &parameters_.encoder_lines},
      {"EMOD", &parameters_.encoder_use},
      {"MAC", &parameters_.acceleration},
      {"MDEC", &parameters_.deceleration},
      {"ALIM", &parameters_.amperes},
      {"CLERD", &parameters_.loop_error},
      {"KP", &parameters_.p},
      {"KI", &parameters_.i},
      {"KD", &parameters_.d},
  }};
  for (const auto& [known, pair] : table) {
    if (known == name) return pair;
  }
  return nullptr;
}

bool Emulator::set(const Order& order) {
  constexpr int kMost = 65535;
  if (order.name == "ECHOF" && order.count == 1 &&
      (order.numbers[0] == 0 || order.numbers[0] == 1)) {
    echo_ = order.numbers[0] == 0;
    return true;
  }
  if (order.name == "RWD") {
    if (order.count != 1 || order.numbers[0] < 0 || order.numbers[0] > kMost) return false;
    parameters_.watchdog_ms = order.numbers[0];
    return true;
  }
  Pair* const pair = pair_of(order.name);
  if (pair == nullptr || order.count != 2 || !channel_fits(order.numbers[0])) return false;
  const int value = order.numbers[1];
  const bool may_be_zero =
      order.name == "MMOD" || order.name == "EMOD" || order.name == "CLERD" || order.name[0] == 'K';
  if (value < (may_be_zero ? 0 : 1)) return false;
  if (order.name == "MMOD" && value != 0 && value != 1 && value != 3) return false;
  (*pair)[index_of(order.numbers[0])] = value;
  return true;
}

bool Emulator::maintain(const Order& order, double at) {
  if (order.name == "EESAV" && order.count == 0) {
    stored_ = parameters_;
    ++memory_writes_;
    return true;
  }
  if (order.name == "RESET" && order.count == 1 && order.numbers[0] == kRestartKey) {
    restart(at, 1.0);
    return true;
  }
  return false;
}

/// "# C" clears the list of queries, "# 20" repeats them in turn every 20 ms, "#" stops that.
void Emulator::repeat(const Order& order, double at) {
  if (order.name == "C") {
    history_.clear();
    return;
  }
  int milliseconds = 0;
  const char* const end = order.name.data() + order.name.size();
  std::from_chars(order.name.data(), end, milliseconds);
  repeat_every_ = milliseconds / 1000.0;
  next_query_ = 0;
  next_repeat_ = milliseconds > 0 && !history_.empty() ? at + repeat_every_ : emulators::kNever;
}

void Emulator::restart(double now, double boot_time) {
  line().cut(now);
  halt(now);
  parameters_ = stored_;
  echo_ = true;
  emergency_ = stop_pressed_;
  history_.clear();
  next_repeat_ = emulators::kNever;
  line_text_.clear();
  counts_.fill(0);
  asked_counts_.fill(0);
  commanded_ = -emulators::kNever;
  boot_end_ = now + boot_time;
}

void Emulator::press_stop_button(bool pressed) {
  stop_pressed_ = pressed;
  if (!pressed) return;  // latched until !MG
  emergency_ = true;
  wanted_rpm_ = {};
}

// ---- queries -----------------------------------------------------------------------------------

std::int32_t Emulator::counter(std::size_t channel) const {
  const auto whole = static_cast<std::int64_t>(std::floor(counts_[channel]));
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(whole));
}

unsigned Emulator::fault_bits() const {
  unsigned bits = faults_;
  if (emergency_) bits |= EmergencyStop;
  if (volts_ < kLowestVolts) bits |= Undervoltage;
  return bits;
}

unsigned Emulator::status_bits() const {
  unsigned bits = Serial;
  if (fault_bits() != 0) bits |= StageOff;
  if (stalled_[0] || stalled_[1]) bits |= Stalled;
  return bits;
}

/// All values, or only the one that the query names.
void Emulator::say_values(std::string_view name,
                          const std::vector<long>& values,
                          const Order& order,
                          double at) {
  std::string text(name);
  text += '=';
  if (order.count == 1) {
    text += std::to_string(values[index_of(order.numbers[0])]);
  } else {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i > 0) text += ':';
      text += std::to_string(values[i]);
    }
  }
  say(text, at);
}

bool Emulator::ask(const Order& order, double at) {
  const std::size_t channels = options_.one_channel ? 1 : kChannels;
  std::vector<long> values;
  const auto each = [&](auto&& value) {
    for (std::size_t channel = 0; channel < channels; ++channel) values.push_back(value(channel));
  };
  const auto measured_rpm = [&](std::size_t channel) {
    const double speed = channel == 0 ? senses_.motion.left : senses_.motion.right;
    return speed / (2 * std::numbers::pi * options_.wheel_radius) * 60 * options_.gear;
  };
  constexpr long kRestAmperes = 2;  // [0.1 A]
  if (order.name == "FID") {
    say("FID=" + options_.firmware, at);
    return order.count == 0;
  }
  if (order.name == "S") {
    each([&](std::size_t channel) { return std::lround(measured_rpm(channel)); });
  } else if (order.name == "SR") {
    each([&](std::size_t channel) {
      return std::lround(measured_rpm(channel) * kFullCommand / parameters_.full_rpm[channel]);
    });
  } else if (order.name == "C") {
    each([&](std::size_t channel) { return long{counter(channel)}; });
  } else if (order.name == "CR") {
    each([&](std::size_t channel) {
      const std::int32_t now = counter(channel);
      const auto moved = static_cast<std::int32_t>(
          static_cast<std::uint32_t>(now) - static_cast<std::uint32_t>(asked_counts_[channel]));
      asked_counts_[channel] = now;
      return long{moved};
    });
  } else if (order.name == "V") {
    values = {120, std::lround(volts_ * 10), 5010};
  } else if (order.name == "A" || order.name == "BA") {
    each([&](std::size_t channel) { return rpm_[channel] == 0 ? 0 : kRestAmperes; });
  } else if (order.name == "T") {
    values = {30, 32, 31};
  } else if (order.name == "M") {
    each([&](std::size_t channel) {
      return std::lround(wanted_rpm_[channel] * kFullCommand / parameters_.full_rpm[channel]);
    });
  } else if (order.name == "P") {
    each([&](std::size_t channel) {
      return std::lround(rpm_[channel] * kFullCommand / parameters_.full_rpm[channel]);
    });
  } else if (order.name == "FF") {
    values = {static_cast<long>(fault_bits())};
  } else if (order.name == "FS") {
    values = {static_cast<long>(status_bits())};
  } else if (order.name == "FM") {
    each([&](std::size_t channel) {
      return stalled_[channel] ? long{MotorStalled | LoopError} : 0;
    });
  } else if (order.name == "DI") {
    const bool front = senses_.front_bumper || bumper_pressed_;
    values = {front ? 1 : 0, senses_.rear_bumper ? 1 : 0, 0, 0, 0, 0};
  } else {
    return false;
  }
  const bool fits = order.count == 0 || (order.count == 1 && order.numbers[0] >= 1 &&
                                         index_of(order.numbers[0]) < values.size());
  if (fits) say_values(order.name, values, order, at);
  return fits;
}

bool Emulator::read(const Order& order, double at) {
  if (order.name == "RWD" && order.count == 0) {
    say_values("RWD", {parameters_.watchdog_ms}, order, at);
    return true;
  }
  if (order.name == "ECHOF" && order.count == 0) {
    say_values("ECHOF", {echo_ ? 0 : 1}, order, at);
    return true;
  }
  const Pair* const pair = pair_of(order.name);
  const bool fits = order.count == 0 || (order.count == 1 && channel_fits(order.numbers[0]));
  if (pair == nullptr || !fits) return false;
  std::vector<long> values{(*pair)[0]};
  if (!options_.one_channel) values.push_back((*pair)[1]);
  say_values(order.name, values, order, at);
  return true;
}

void Emulator::work(double now) {
  while (next_repeat_ <= now) {
    Order order;
    if (parse(history_[next_query_], order)) ask(order, next_repeat_);
    next_query_ = (next_query_ + 1) % history_.size();
    next_repeat_ += repeat_every_;
  }
}

double Emulator::next_duty() const {
  return next_repeat_;
}

// ---- motors ------------------------------------------------------------------------------------

double Emulator::wheel_speed(std::size_t /*channel*/, double rpm) const {
  return rpm / options_.gear / 60 * 2 * std::numbers::pi * options_.wheel_radius;
}

void Emulator::halt(double at) {
  wanted_rpm_ = {};
  report(at, {});
}

/// Switches off a motor that does not follow its command, until it is commanded to stop.
void Emulator::watch_loop(std::size_t channel, double dt) {
  constexpr std::array<double, 4> kPatience{emulators::kNever, 0.25, 0.5, 1.0};  // [s] by ^CLERD
  const double told = wheel_speed(channel, rpm_[channel]);
  const double turns = channel == 0 ? senses_.motion.left : senses_.motion.right;
  const bool lost = std::abs(told) > 0.02 && std::abs(turns) < 0.1 * std::abs(told);
  lost_for_[channel] = lost ? lost_for_[channel] + dt : 0;
  const auto chosen = static_cast<std::size_t>(parameters_.loop_error[channel]);
  if (lost_for_[channel] > kPatience[std::min(chosen, kPatience.size() - 1)]) {
    stalled_[channel] = true;
  }
  if (wanted_rpm_[channel] == 0) stalled_[channel] = false;
}

WheelMotion Emulator::drive(double now) {
  const double dt = driven_until_ > -emulators::kNever ? std::max(0.0, now - driven_until_) : 0;
  driven_until_ = now;
  const bool moves = wanted_rpm_[0] != 0 || wanted_rpm_[1] != 0;
  const bool overdue =
      parameters_.watchdog_ms > 0 && now - commanded_ > parameters_.watchdog_ms / 1000.0;
  if (moves && (overdue || fault_bits() != 0)) halt(now);
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    watch_loop(channel, dt);
    const double wanted = stalled_[channel] ? 0 : wanted_rpm_[channel];
    const bool slower = std::abs(wanted) < std::abs(rpm_[channel]) || wanted * rpm_[channel] < 0;
    const int rate = slower ? parameters_.deceleration[channel] : parameters_.acceleration[channel];
    rpm_[channel] = towards(rpm_[channel], wanted, rate / 10.0 * dt);
  }
  return {.left = wheel_speed(0, rpm_[0]), .right = wheel_speed(1, rpm_[1])};
}

void Emulator::feel(const emulators::BaseSenses& senses, double /*now*/) {
  if (felt_) {
    const std::array<double, kChannels> moved{senses.left_travel - senses_.left_travel,
                                              senses.right_travel - senses_.right_travel};
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      const double turns = moved[channel] / (2 * std::numbers::pi * options_.wheel_radius);
      counts_[channel] += turns * options_.gear * 4 * options_.encoder_lines;
    }
  }
  felt_ = true;
  senses_ = senses;
}

}  // namespace drivers::roboteq
