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

/// The verbs of a fault line.
enum class Verb : std::uint8_t {
  Truth,
  Drop,
  Flip,
  Damage,
  Silence,
  Restart,
  Unplug,
  Nak,
  Dazzle,
  Cone,
  Dirty,
  Health,
  Stop,
  Bumper,
  Battery,
  Faults,
  Runaway,
  Gain,
  Block,
  Encoder,
  Stick,
  Jump,
  Slow,
};
enum class Who : std::uint8_t { World, Any, Scanner, Base, Psd };

struct VerbRow {
  Verb verb = Verb::Truth;
  std::string_view word{};
  Who who = Who::Any;
  std::string_view help{};
};

constexpr std::array<VerbRow, 23> kVerbs{{
    {Verb::Truth, "truth", Who::World, "print the robot's pose and counts of scans as JSON"},
    {Verb::Drop, "drop", Who::Any, "P: lose each byte with this probability"},
    {Verb::Flip, "flip", Who::Any, "P: flip a bit of each byte with this probability"},
    {Verb::Damage, "damage", Who::Any, "P: damage one byte of each telegram with this probability"},
    {Verb::Silence, "silence", Who::Any, "SECONDS: send nothing"},
    {Verb::Restart, "restart", Who::Any, "SECONDS: restart, which takes this long"},
    {Verb::Unplug, "unplug", Who::Any, "SECONDS: remove the port for this long"},
    {Verb::Nak, "nak", Who::Scanner, "N: answer NAK to the next N telegrams"},
    {Verb::Dazzle, "dazzle", Who::Scanner, "on|off: blind all beams"},
    {Verb::Cone, "cone", Who::Scanner, "DEGREES: blind this angle about the middle; 0: none"},
    {Verb::Dirty, "dirty", Who::Scanner, "on|off: report a dirty window"},
    {Verb::Health, "health", Who::Scanner, "BYTE: the last byte of all answers"},
    {Verb::Stop, "stop", Who::Base, "on|off: press or release the stop button"},
    {Verb::Bumper, "bumper", Who::Base, "on|off: press or release a bumper"},
    {Verb::Battery, "battery", Who::Base, "VOLTS"},
    {Verb::Faults, "faults", Who::Base, "BITS: fault flags the controller reports"},
    {Verb::Runaway,
     "runaway",
     Who::Base,
     "SPEED: while powered, both wheels turn at this speed [m/s]; 0: none"},
    {Verb::Gain, "gain", Who::Base, "N: the wheels turn N times as fast as commanded"},
    {Verb::Block, "block", Who::Base, "on|off: the left wheel cannot turn"},
    {Verb::Encoder, "encoder", Who::Base, "on|off: connect or disconnect the left wheel's encoder"},
    {Verb::Stick,
     "stick",
     Who::Psd,
     "N: the count of floor sensor N stands still; 5: all; 0: none"},
    {Verb::Jump, "jump", Who::Psd, "SECONDS: move the clock of the floor sensors' adapter"},
    {Verb::Slow, "slow", Who::Psd, "N: the floor sensors' adapter sends N times as seldom"},
}};

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

/// Injects a fault that any device can have; false for any other `verb`.
bool inject(Verb verb, double value, Connection& connection, emulators::Device& device) {
  if (verb == Verb::Unplug) {
    connection.unplug(value);
    return true;
  }
  const auto held = connection.lock();
  emulators::LineFaults faults = device.faults();
  switch (verb) {
    case Verb::Drop:
      faults.drop = value;
      break;
    case Verb::Flip:
      faults.flip = value;
      break;
    case Verb::Damage:
      faults.damage = value;
      break;
    case Verb::Silence:
      device.mute(machine_time() + value);
      return true;
    default:
      return false;
  }
  device.set_faults(faults);
  return true;
}

void inject_scanner(Verb verb, double value, Connection& connection, lms200::Emulator& device) {
  constexpr std::uint8_t kGood = 0x10;
  constexpr std::uint8_t kPolluted = 0x92;
  if (inject(verb, value, connection, device)) return;
  const auto held = connection.lock();
  switch (verb) {
    case Verb::Restart:
      device.restart(machine_time(), value);
      break;
    case Verb::Nak:
      device.refuse_next(static_cast<unsigned>(value));
      break;
    case Verb::Dazzle:
      device.dazzle(value != 0);
      break;
    case Verb::Cone:
      device.dazzle(value > 0, value * algo::units::kRadiansPerDegree);
      break;
    case Verb::Dirty:
      device.set_health(value != 0 ? kPolluted : kGood);
      break;
    default:
      device.set_health(static_cast<std::uint8_t>(value));
  }
}

void inject_wheels(Verb verb, double value, emulators::Base& device) {
  switch (verb) {
    case Verb::Restart:
      device.restart(machine_time(), value);
      break;
    case Verb::Stop:
      device.press_stop_button(value != 0);
      break;
    case Verb::Bumper:
      device.press_bumper(value != 0);
      break;
    case Verb::Battery:
      device.set_battery(value);
      break;
    case Verb::Runaway:
      device.trouble.runaway = value;
      break;
    case Verb::Gain:
      device.trouble.gain = value;
      break;
    case Verb::Block:
      device.trouble.blocked = value != 0;
      break;
    case Verb::Encoder:
      device.trouble.encoder_dead = value == 0;
      break;
    default:
      device.set_faults_reported(static_cast<std::uint16_t>(value));
  }
}

/// As inject(), for the acquisition card of a base without a serial line.
bool inject_card(const VerbRow& row,
                 double value,
                 Connection& connection,
                 emulators::AnalogEmulator& device) {
  switch (row.verb) {
    case Verb::Unplug:
      connection.unplug(value);
      return true;
    case Verb::Silence: {
      const auto held = connection.lock();
      device.mute(machine_time() + value);
      return true;
    }
    case Verb::Drop:
    case Verb::Flip:
    case Verb::Damage:
      throw std::invalid_argument(
          fmt::format("'{}' needs a serial line; an acquisition card has none.", row.word));
    default:
      return false;
  }
}

/// `base`: an Emulation::Base.
template <class Base>
void inject_base(const VerbRow& row, double value, Base& base) {
  Connection& connection = *base.connection;
  const bool done = base.line != nullptr ? inject(row.verb, value, connection, *base.line)
                                         : inject_card(row, value, connection, *base.card);
  if (!done) {
    const auto held = connection.lock();
    inject_wheels(row.verb, value, *base.device);
  }
  connection.wake();
}

void inject_psd(const VerbRow& row,
                double value,
                Connection& connection,
                drivers::psd::Emulator& device) {
  if (inject(row.verb, value, connection, device)) return;
  const auto held = connection.lock();
  if (row.verb == Verb::Restart) device.restart(machine_time(), value);
  if (row.verb == Verb::Jump) device.jump(value);
  if (row.verb == Verb::Slow) device.slow(std::max(1.0, value));
  if (row.verb != Verb::Stick) return;
  constexpr double kAll = drivers::psd::kSensors + 1;
  for (std::size_t i = 0; i < drivers::psd::kSensors; ++i) {
    device.stick(i, value == kAll || value == static_cast<double>(i + 1));
  }
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
  if (row.verb == Verb::Truth) return truth();
  if (device.empty()) device = only(row, scanners_.size(), base_ != nullptr);
  const double number = value_of(value, row);
  record_.event(machine_time(), line);
  if (device == "psd" && psd_ && (row.who == Who::Any || row.who == Who::Psd)) {
    inject_psd(row, number, psd_->thread, psd_->device);
    psd_->thread.wake();
    return "";
  }
  if (device == "psd") {
    throw std::invalid_argument(psd_
                                    ? fmt::format("'{}' does not apply to floor sensors.", row.word)
                                    : "There are no floor sensors here.");
  }
  if (device == "base") {
    if (!base_ || row.who == Who::Scanner || row.who == Who::Psd) {
      throw std::invalid_argument(fmt::format("'{}' does not apply to this base.", row.word));
    }
    inject_base(row, number, *base_);
    return "";
  }
  for (const auto& scanner : scanners_) {
    if (scanner->thread.name() != device) continue;
    if (row.who == Who::Base || row.who == Who::Psd) {
      throw std::invalid_argument(fmt::format("'{}' does not apply to a scanner.", row.word));
    }
    inject_scanner(row.verb, number, scanner->thread, scanner->device);
    scanner->thread.wake();
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
