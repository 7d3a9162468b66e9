// server/emulate/emulation.cpp: assembles devices, lines and world, and injects faults.
#include "server/emulate/emulation.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "algo/units.hpp"
#include "server/emulate/clock.hpp"

namespace server::emulate {

namespace lms200 = drivers::lms200;
namespace emulators = drivers::emulators;

/// Members in the order of construction: the thread ends before its device.
struct Emulation::Scanner {
  Scanner(std::string name,
          const lms200::EmulatorOptions& options,
          const std::filesystem::path& link)
      : device(options), thread(std::move(name), device, link) {}
  lms200::Emulator device;
  DeviceThread thread;
  std::array<std::uint64_t, 5> fates{};  // scans by SentScan::Fate; under the device's lock
};

struct Emulation::Base {
  /// A base with a serial line or with a card.
  template <class Emulator>
  Base(std::unique_ptr<Emulator> made, const EmulationOptions& options) {
    if constexpr (std::is_same_v<Emulator, emulators::AnalogEmulator>) {
      card = made.get();
      connection = std::make_unique<CardSlot>("base", *made, options.base_link, options.card);
    } else {
      line = made.get();
      line->set_faults(options.faults);
      connection = std::make_unique<DeviceThread>("base", *made, options.base_link);
    }
    device = std::move(made);
  }
  std::unique_ptr<emulators::Base> device{};
  emulators::Device* line = nullptr;          // of a serial base
  emulators::AnalogEmulator* card = nullptr;  // of the other kind
  std::unique_ptr<Connection> connection{};
  std::uint64_t commands = 0;  // motion commands; under the device's lock
};

/// The adapter of the floor sensors.
struct Emulation::Psd {
  Psd(const drivers::psd::EmulatorOptions& options, const std::filesystem::path& link)
      : device(options), thread("psd", device, link) {}
  drivers::psd::Emulator device;
  DeviceThread thread;
};

namespace {

/// Where a fault goes: a connection and what is behind it; null what is not.
struct Target {
  Connection& connection;
  emulators::Device* line = nullptr;  // with a serial line
  lms200::Emulator* scanner = nullptr;
  emulators::Base* base = nullptr;
  emulators::AnalogEmulator* card = nullptr;
  drivers::psd::Emulator* psd = nullptr;
};

/// `Line`: any device with a serial line.
enum class Who : std::uint8_t { World, Any, Line, Scanner, Base, Psd };

/// A verb of a fault line.
struct VerbRow {
  std::string_view word{};
  Who who = Who::Any;
  std::string_view help{};
  void (*inject)(const Target& to, double value) = nullptr;
};

template <double emulators::LineFaults::*Fault>
void spoil(const Target& to, double value) {
  emulators::LineFaults faults = to.line->faults();
  faults.*Fault = value;
  to.line->set_faults(faults);
}

void mute(const Target& to, double value) {
  const double until = machine_time() + value;
  if (to.line != nullptr) {
    to.line->mute(until);
  } else {
    to.card->mute(until);
  }
}

void restart(const Target& to, double value) {
  if (to.scanner != nullptr) to.scanner->restart(machine_time(), value);
  if (to.base != nullptr) to.base->restart(machine_time(), value);
  if (to.psd != nullptr) to.psd->restart(machine_time(), value);
}

/// The one fault that is not injected under the device's lock.
void unplug(const Target& to, double value) {
  to.connection.unplug(value);
}

void dirty(const Target& to, double value) {
  constexpr std::uint8_t kGood = 0x10;
  constexpr std::uint8_t kPolluted = 0x92;
  to.scanner->set_health(value != 0 ? kPolluted : kGood);
}

void stick(const Target& to, double value) {
  constexpr double kAll = drivers::psd::kSensors + 1;
  for (std::size_t i = 0; i < drivers::psd::kSensors; ++i) {
    to.psd->stick(i, value == kAll || value == static_cast<double>(i + 1));
  }
}

using emulators::LineFaults;
using T = const Target&;

constexpr std::string_view kTruth = "truth";
constexpr auto kVerbs = std::to_array<VerbRow>({
    {kTruth, Who::World, "print the robot's pose and counts of scans as JSON"},
    {"drop", Who::Line, "P: lose each byte with this probability", spoil<&LineFaults::drop>},
    {"flip",
     Who::Line,
     "P: flip a bit of each byte with this probability",
     spoil<&LineFaults::flip>},
    {"damage",
     Who::Line,
     "P: damage one byte of each telegram with this probability",
     spoil<&LineFaults::damage>},
    {"silence", Who::Any, "SECONDS: send nothing", mute},
    {"restart", Who::Any, "SECONDS: restart, which takes this long", restart},
    {"unplug", Who::Any, "SECONDS: remove the port for this long", unplug},
    {"nak",
     Who::Scanner,
     "N: answer NAK to the next N telegrams",
     [](T to, double value) { to.scanner->refuse_next(static_cast<unsigned>(value)); }},
    {"dazzle",
     Who::Scanner,
     "on|off: blind all beams",
     [](T to, double value) { to.scanner->dazzle(value != 0); }},
    {"cone",
     Who::Scanner,
     "DEGREES: blind this angle about the middle; 0: none",
     [](T to, double value) {
       to.scanner->dazzle(value > 0, value * algo::units::kRadiansPerDegree);
     }},
    {"dirty", Who::Scanner, "on|off: report a dirty window", dirty},
    {"health",
     Who::Scanner,
     "BYTE: the last byte of all answers",
     [](T to, double value) { to.scanner->set_health(static_cast<std::uint8_t>(value)); }},
    {"stop",
     Who::Base,
     "on|off: press or release the stop button",
     [](T to, double value) { to.base->press_stop_button(value != 0); }},
    {"bumper",
     Who::Base,
     "on|off: press or release a bumper",
     [](T to, double value) { to.base->press_bumper(value != 0); }},
    {"battery", Who::Base, "VOLTS", [](T to, double value) { to.base->set_battery(value); }},
    {"faults",
     Who::Base,
     "BITS: fault flags the controller reports",
     [](T to, double value) { to.base->set_faults_reported(static_cast<std::uint16_t>(value)); }},
    {"runaway",
     Who::Base,
     "SPEED: while powered, both wheels turn at this speed [m/s]; 0: none",
     [](T to, double value) { to.base->trouble.runaway = value; }},
    {"gain",
     Who::Base,
     "N: the wheels turn N times as fast as commanded",
     [](T to, double value) { to.base->trouble.gain = value; }},
    {"block",
     Who::Base,
     "on|off: the left wheel cannot turn",
     [](T to, double value) { to.base->trouble.blocked = value != 0; }},
    {"encoder",
     Who::Base,
     "on|off: connect or disconnect the left wheel's encoder",
     [](T to, double value) { to.base->trouble.encoder_dead = value == 0; }},
    {"stick", Who::Psd, "N: the count of floor sensor N stands still; 5: all; 0: none", stick},
    {"jump",
     Who::Psd,
     "SECONDS: move the clock of the floor sensors' adapter",
     [](T to, double value) { to.psd->jump(value); }},
    {"slow",
     Who::Psd,
     "N: the floor sensors' adapter sends N times as seldom",
     [](T to, double value) { to.psd->slow(std::max(1.0, value)); }},
});

const VerbRow& verb_of(const std::string& word) {
  for (const VerbRow& row : kVerbs) {
    if (row.word == word) return row;
  }
  throw std::invalid_argument("There is no command '" + word + "'. There are:\n" + command_help());
}

double value_of(const std::string& text, const VerbRow& row) {
  if (text == "on") return 1;
  if (text == "off") return 0;
  double value = 0;
  const char* const end = text.data() + text.size();
  if (text.empty() || std::from_chars(text.data(), end, value).ptr != end || !(value >= 0)) {
    throw std::invalid_argument(fmt::format("{} needs {}", row.word, row.help));
  }
  return value;
}

/// True if devices of kind `who` have the fault of `row`.
bool applies(const VerbRow& row, Who who) {
  return row.who == Who::Any || row.who == Who::Line || row.who == who;
}

void inject(const VerbRow& row, double value, const Target& to) {
  if (row.who == Who::Line && to.line == nullptr) {
    throw std::invalid_argument(
        fmt::format("'{}' needs a serial line; an acquisition card has none.", row.word));
  }
  if (row.inject == unplug) {
    unplug(to, value);
  } else {
    const auto held = to.connection.lock();
    row.inject(to, value);
  }
  to.connection.wake();
}

/// The device for `row` when the line names none.
std::string only(const VerbRow& row, std::size_t scanners, bool base) {
  if (row.who == Who::Psd) return "psd";
  const bool scanner_verb = row.who != Who::Base;
  const bool base_verb = row.who != Who::Scanner;
  if (scanner_verb && scanners == 1 && !(base_verb && base)) return "scanner";
  if (base_verb && base && !(scanner_verb && scanners > 0)) return "base";
  throw std::invalid_argument(
      fmt::format("{}: of which device? Write for example 'scanner {}'.", row.word, row.word));
}

}  // namespace

std::unique_ptr<Emulation::Base> Emulation::make_base(const EmulationOptions& options) {
  const sim::RobotModel& robot = options.scenario.robot;
  if (options.base == BaseKind::P2os) {
    drivers::p2os::EmulatorOptions made;
    made.half_track = robot.half_track;
    made.seed = options.seed + 100;
    if (options.watchdog > 0) made.watchdog = options.watchdog;
    if (options.near_wrap) made.first_x_mm = made.first_y_mm = 0x7FFF - 100;
    return std::make_unique<Base>(std::make_unique<drivers::p2os::Emulator>(made), options);
  }
  if (options.base == BaseKind::Analog) {
    emulators::AnalogOptions made;
    made.wheel_radius = robot.wheel_radius;
    if (options.watchdog > 0) made.watchdog = options.watchdog;
    if (options.near_wrap) made.first_count = emulators::CardMemory::kFullCount - 5000;
    return std::make_unique<Base>(std::make_unique<emulators::AnalogEmulator>(made), options);
  }
  drivers::roboteq::EmulatorOptions made;
  made.wheel_radius = robot.wheel_radius;
  made.seed = options.seed + 100;
  if (options.watchdog > 0) made.watchdog_ms = static_cast<int>(1000 * options.watchdog);
  if (options.near_wrap) made.first_count = std::numeric_limits<std::int32_t>::max() - 5000;
  return std::make_unique<Base>(std::make_unique<drivers::roboteq::Emulator>(made), options);
}

std::string command_help() {
  std::string text;
  for (const VerbRow& row : kVerbs) text += fmt::format("  {:8} {}\n", row.word, row.help);
  return text;
}

Emulation::Emulation(const EmulationOptions& options) : record_(options.record) {
  if (options.scanner_links.size() > options.scenario.robot.sensors.lasers.size()) {
    throw std::invalid_argument("The scenario has " +
                                std::to_string(options.scenario.robot.sensors.lasers.size()) +
                                " laser scanners.");
  }
  for (std::size_t i = 0; i < options.scanner_links.size(); ++i) add_scanner(options, i);
  if (options.base != BaseKind::None) add_base(options);
  if (!options.psd_link.empty()) add_psd(options);
  if (!options.log.empty()) {
    if (scanners_.size() != 1 || base_ || psd_) {
      throw std::invalid_argument("A log can be played to one scanner only.");
    }
    player_ = std::make_unique<LogPlayer>(
        options.log, Served<lms200::Emulator>{&scanners_[0]->device, &scanners_[0]->thread});
    return;
  }
  EmulatedWorld::Links links;
  for (const auto& scanner : scanners_)
    links.scanners.push_back({&scanner->device, &scanner->thread});
  if (base_) links.base = Served<emulators::Base>{base_->device.get(), base_->connection.get()};
  if (psd_) links.floor = Served<drivers::psd::Emulator>{&psd_->device, &psd_->thread};
  world_ = std::make_unique<EmulatedWorld>(options.scenario, options.seed, links, record_);
}

Emulation::~Emulation() = default;

void Emulation::add_scanner(const EmulationOptions& options, std::size_t index) {
  lms200::EmulatorOptions made = options.scanner;
  made.seed = options.seed + index;
  const std::string name = index == 0 ? "scanner" : "scanner" + std::to_string(index + 1);
  scanners_.push_back(std::make_unique<Scanner>(name, made, options.scanner_links[index]));
  Scanner& scanner = *scanners_.back();
  scanner.device.set_faults(options.faults);
  scanner.device.on_scan = [this, &scanner](const lms200::SentScan& scan) {
    ++scanner.fates[static_cast<std::size_t>(scan.fate)];
    record_.scan(scanner.thread.name(), scan, scanner.thread.listened_to());
  };
}

void Emulation::add_base(const EmulationOptions& options) {
  base_ = make_base(options);
  base_->device->on_command = [this](const emulators::BaseCommand& command) {
    ++base_->commands;
    record_.wheels({.time = machine_time(), .wanted = command.wanted});
  };
}

void Emulation::add_psd(const EmulationOptions& options) {
  drivers::psd::EmulatorOptions made;
  made.seed = options.seed + 200;
  psd_ = std::make_unique<Psd>(made, options.psd_link);
  psd_->device.set_faults(options.faults);
}

void Emulation::start() {
  for (const auto& scanner : scanners_) scanner->thread.start();
  if (base_) base_->connection->start();
  if (psd_) psd_->thread.start();
  if (world_) world_->start();
  if (player_) player_->start();
}

std::string Emulation::command(std::string_view line) {
  std::istringstream words{std::string(line)};
  std::string device;
  std::string word;
  std::string value;
  words >> word;
  if (word.empty() || word[0] == '#') return "";
  if (word == "base" || word == "psd" || word.starts_with("scanner")) {
    device = word;
    words >> word;
  }
  words >> value;
  const VerbRow& row = verb_of(word);
  if (row.word == kTruth) return truth();
  if (device.empty()) device = only(row, scanners_.size(), base_ != nullptr);
  const double number = value_of(value, row);
  record_.event(machine_time(), line);
  if (device == "psd" && psd_ && applies(row, Who::Psd)) {
    drivers::psd::Emulator& psd = psd_->device;
    inject(row, number, {.connection = psd_->thread, .line = &psd, .psd = &psd});
    return "";
  }
  if (device == "psd") {
    throw std::invalid_argument(psd_
                                    ? fmt::format("'{}' does not apply to floor sensors.", row.word)
                                    : "There are no floor sensors here.");
  }
  if (device == "base") {
    if (!base_ || !applies(row, Who::Base)) {
      throw std::invalid_argument(fmt::format("'{}' does not apply to this base.", row.word));
    }
    inject(row,
           number,
           {.connection = *base_->connection,
            .line = base_->line,
            .base = base_->device.get(),
            .card = base_->card});
    return "";
  }
  for (const auto& scanner : scanners_) {
    if (scanner->thread.name() != device) continue;
    if (!applies(row, Who::Scanner)) {
      throw std::invalid_argument(fmt::format("'{}' does not apply to a scanner.", row.word));
    }
    lms200::Emulator& laser = scanner->device;
    inject(row, number, {.connection = scanner->thread, .line = &laser, .scanner = &laser});
    return "";
  }
  throw std::invalid_argument("There is no device '" + device + "' here.");
}

std::string Emulation::truth() {
  nlohmann::ordered_json out;
  out["time"] = machine_time();
  if (world_) {
    const EmulatedWorld::Truth truth = world_->truth();
    out["world_time"] = truth.time;
    out["pose"] = {truth.pose_W.x, truth.pose_W.y, truth.pose_W.heading};
    out["clearance"] = truth.clearance;
    out["collided"] = truth.collided;
    out["missed_steps"] = truth.missed;
  }
  for (const auto& scanner : scanners_) {
    const auto held = scanner->thread.lock();
    const lms200::Emulator& device = scanner->device;
    out[scanner->thread.name()] = {{"listened_to", scanner->thread.listened_to()},
                                   {"baud", device.baud()},
                                   {"mode", static_cast<int>(device.mode())},
                                   {"sent", scanner->fates[0]},
                                   {"damaged", scanner->fates[1]},
                                   {"cut", scanner->fates[2]},
                                   {"lost", scanner->fates[3]},
                                   {"muted", scanner->fates[4]},
                                   {"memory_writes", device.memory_writes()},
                                   {"bad_telegrams", device.bad_telegrams()},
                                   {"overrun", scanner->thread.overrun()}};
  }
  if (psd_) {
    const auto held = psd_->thread.lock();
    out["psd"] = {{"listened_to", psd_->thread.listened_to()},
                  {"lines", psd_->device.lines()},
                  {"overrun", psd_->thread.overrun()}};
  }
  if (base_) {
    const auto held = base_->connection->lock();
    out["base"] = {{"listened_to", base_->connection->listened_to()},
                   {"commands", base_->commands}};
    if (base_->line != nullptr) {
      const auto& thread = static_cast<const DeviceThread&>(*base_->connection);
      out["base"]["baud"] = base_->line->baud();
      out["base"]["overrun"] = thread.overrun();
    }
  }
  return out.dump();
}

}  // namespace server::emulate
