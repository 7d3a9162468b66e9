// server/cli/command_emulate.cpp: `tautline emulate`: emulated devices on pseudo-terminals, for
// users without hardware.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include "server/cli/cli.hpp"
#include "server/cli/output_files.hpp"
#include "server/cli/signals.hpp"
#include "server/emulate/emulation.hpp"
#include "server/emulate/robot_toml.hpp"
#include "server/run/scenario_library.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

using emulate::BaseKind;
using emulate::Emulation;
using emulate::EmulationOptions;

struct BaseRow {
  BaseKind kind = BaseKind::None;
  std::string_view name{};
  std::string_view words{};
};
constexpr std::array<BaseRow, 3> kBases{
    {{BaseKind::P2os, "p2os", "Pioneer base"},
     {BaseKind::Roboteq, "roboteq", "Roboteq"},
     {BaseKind::Analog, "analog", "Analog base, an acquisition card"}}};

const BaseRow& row_of(BaseKind kind) {
  return *std::ranges::find(kBases, kind, &BaseRow::kind);
}

struct EmulateCommand {
  EmulationOptions emulation{};
  std::string scenario = "demo";
  std::filesystem::path link{};
  std::filesystem::path links{};
  std::string base = "roboteq";
  double boot = 0;
  bool rs232 = false;
  unsigned address = 0;
  bool psd = false;
  std::filesystem::path robot_file{};  // to write; empty: none
};

/// SIGINT, SIGTERM and SIGHUP as a file to read. It blocks them in all later threads, so make it
/// first.
class Signals {
 public:
  Signals() {
    sigset_t set{};
    ::sigemptyset(&set);
    ::sigaddset(&set, SIGINT);
    ::sigaddset(&set, SIGTERM);
    ::sigaddset(&set, SIGHUP);
    ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
    fd_ = ::signalfd(-1, &set, SFD_CLOEXEC);
    heed_signals();  // handles the signals that are not blocked
  }
  ~Signals() { ::close(fd_); }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  int descriptor() const { return fd_; }

 private:
  int fd_ = -1;
};

void obey(Emulation& emulation, const std::string& line) {
  try {
    const std::string answer = emulation.command(line);
    if (!answer.empty()) fmt::print("{}\n", answer);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
  }
  std::fflush(stdout);
}

/// Executes the lines of standard input until a signal. The end of the input does not end the
/// program, which may run in the background.
void attend(Emulation& emulation, const Signals& signals) {
  std::string pending;
  std::array<pollfd, 2> sources{{{.fd = signals.descriptor(), .events = POLLIN, .revents = 0},
                                 {.fd = STDIN_FILENO, .events = POLLIN, .revents = 0}}};
  for (;;) {
    if (::poll(sources.data(), sources.size(), -1) < 0) continue;
    if (sources[0].revents != 0) return;
    std::array<char, 1024> bytes{};
    const ssize_t got = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (got <= 0) {
      sources[1].fd = -1;
      continue;
    }
    pending.append(bytes.data(), static_cast<std::size_t>(got));
    for (std::size_t end = pending.find('\n'); end != std::string::npos; end = pending.find('\n')) {
      const std::string line = pending.substr(0, end);
      pending.erase(0, end + 1);
      if (line == "quit") return;
      obey(emulation, line);
    }
  }
}

/// Writes the robot's file for `serve --robot`.
void show_robot_file(const EmulationOptions& emulation, const std::filesystem::path& file) {
  const std::filesystem::path library =
      emulation.base == BaseKind::Analog ? emulate::emulated_comedi() : std::filesystem::path();
  if (emulate::write_robot_toml(emulation, library, file)) {
    fmt::print("Its robot's file: {0}. Drive it: tautline serve --robot {0}\n", file.string());
  } else {
    fmt::print("{} is yours and stays as it is.\n", file.string());
  }
}

void emulate_devices(EmulateCommand& options) {
  EmulationOptions& emulation = options.emulation;
  refuse_shared_files({{"--log", emulation.log}, {"--scenario", options.scenario}},
                      {{"--record", emulation.record}});
  emulation.scenario = find_scenario(options.scenario);
  if (!emulation.scenario.log.empty()) emulation.log = emulation.scenario.log;
  emulation.scanner.rs422 = !options.rs232;
  emulation.scanner.address = static_cast<std::uint8_t>(options.address);
  if (options.boot > 0) {
    emulation.scanner.powered = false;
    emulation.scanner.boot_time = options.boot;
  }
  const Signals signals;
  Emulation running(emulation);
  running.start();
  for (const auto& link : emulation.scanner_links) fmt::print("LMS200 at {}\n", link.string());
  if (emulation.base != BaseKind::None) {
    fmt::print("{} at {}\n", row_of(emulation.base).words, emulation.base_link.string());
  }
  if (!emulation.psd_link.empty()) {
    fmt::print("Floor sensors at {}\n", emulation.psd_link.string());
  }
  if (emulation.base == BaseKind::Analog) {
    fmt::print("library = \"{}\"\n", emulate::emulated_comedi().string());
  }
  if (!options.robot_file.empty()) show_robot_file(emulation, options.robot_file);
  std::fflush(stdout);
  attend(running, signals);
}

void add_common_flags(Command command, EmulateCommand& options) {
  command.add_option("--scenario", options.scenario, "The world: a scenario's name or .json file")
      .show_default();
  command.add_option("--seed", options.emulation.seed, "Seed of noise and faults").show_default();
  command
      .add_option("--record",
                  options.emulation.record,
                  "Write every scan sent, every wheel command and the true poses to this file")
      .type_name("FILE");
  drivers::emulators::LineFaults& faults = options.emulation.faults;
  command.add_option("--drop", faults.drop, "Probability that a byte is lost").range(0.0, 1.0);
  command.add_option("--flip", faults.flip, "Probability that a byte has a bit flipped")
      .range(0.0, 1.0);
  command.add_option("--damage", faults.damage, "Probability that a telegram is damaged")
      .range(0.0, 1.0);
  command.footer("Faults while it runs, one per line on standard input, such as 'silence 2':\n" +
                 emulate::command_help() + "  quit     end");
}

void add_scanner_flags(Command command, EmulateCommand& options) {
  command.add_option("--address", options.address, "The scanner's own address").range(0, 127);
  command.add_option("--boot", options.boot, "Power comes now: the start-up time [s]")
      .range(0.0, 120.0);
  command.add_option("--rate", options.emulation.scanner.start_rate, "Stored start-up rate [bit/s]")
      .one_of({9600, 19200, 38400, 500000})
      .show_default();
  drivers::lms200::EmulatorOptions& scanner = options.emulation.scanner;
  command.add_option("--mode-time", scanner.times.mode, "Duration of a mode switch [s]")
      .range(0.0, 60.0);
  command
      .add_option("--deaf",
                  scanner.times.deaf,
                  "The scanner ignores all bytes and sends none for this time [s] after a mode "
                  "switch and power-on")
      .range(0.0, 60.0);
  command.add_option("--refuse", scanner.refusals, "Number of telegrams it answers with NAK");
  add_password_option(command, scanner.password);
  command.add_flag("--rs232", options.rs232, "The plug's jumper is set to RS-232: no 500000");
  command.add_flag("--interlaced",
                   options.emulation.scanner.interlaced,
                   "Partial scans of 180 degrees in steps of 0.25 degrees");
  command
      .add_option("--field-a",
                  options.emulation.scanner.field_a,
                  "Values nearer than this [m] get the flag of field A")
      .range(0.0, 100.0);
}

void add_base_flags(Command command, EmulateCommand& options) {
  command.add_flag("--near-wrap",
                   options.emulation.near_wrap,
                   "The base's counters start shortly before they wrap");
  command.add_option("--watchdog", options.emulation.watchdog, "The base's own watchdog [s]")
      .range(0.0, 60.0);
  drivers::emulators::CardChannels& card = options.emulation.card;
  command.add_option("--card-outputs", card.outputs, "Analog outputs of an acquisition card")
      .range(0, 2)
      .show_default();
  command.add_option("--card-counters", card.counters, "Counters of an acquisition card")
      .range(0, 2)
      .show_default();
  command.add_option("--card-lines", card.lines, "Digital lines of an acquisition card")
      .range(0, 32)
      .show_default();
}

}  // namespace

void add_emulate_command(Command app, int& status) {
  const Command command = app.add_subcommand(
      "emulate", "Emulate devices on pseudo-terminals, in a simulated world or from a log");
  command.require_subcommand();

  const auto single = [&](const char* name, const char* help, BaseKind kind) {
    auto options = std::make_shared<EmulateCommand>();
    const Command device = command.add_subcommand(name, help);
    device.add_option("--link", options->link, "Path of the port").type_name("PATH").required();
    add_common_flags(device, *options);
    if (kind == BaseKind::None) {
      add_scanner_flags(device, *options);
      device.add_option("--log", options->emulation.log, "A CARMEN log instead of a world")
          .type_name("FILE")
          .existing_file();
    } else {
      add_base_flags(device, *options);
    }
    device.callback([options, kind, &status] {
      options->emulation.base = kind;
      if (kind == BaseKind::None) {
        options->emulation.scanner_links = {options->link};
      } else {
        options->emulation.base_link = options->link;
      }
      emulate_devices(*options);
      status = 0;
    });
  };
  single("lms200", "A SICK LMS200", BaseKind::None);
  single("p2os", "A Pioneer base", BaseKind::P2os);
  single("roboteq", "A Roboteq motor controller with two motors", BaseKind::Roboteq);
  single("analog", "An acquisition card wired to two motor amplifiers", BaseKind::Analog);

  auto floor = std::make_shared<EmulateCommand>();
  const Command psd = command.add_subcommand(
      "psd", "The adapter of four distance sensors that look at the floor, of a robot that stands");
  psd.add_option("--link", floor->link, "Path of the port").type_name("PATH").required();
  add_common_flags(psd, *floor);
  psd.callback([floor, &status] {
    floor->emulation.psd_link = floor->link;
    emulate_devices(*floor);
    status = 0;
  });

  auto options = std::make_shared<EmulateCommand>();
  const Command robot = command.add_subcommand("robot",
                                               "A base and the scenario's scanners in one world: "
                                               "DIR/base, DIR/scanner, ..., and DIR/robot.toml "
                                               "for serve --robot");
  robot.add_option("--links", options->links, "Folder of the ports").type_name("DIR").required();
  robot.add_option("--base", options->base, "p2os, roboteq or analog")
      .one_of({"p2os", "roboteq", "analog"})
      .show_default();
  robot.add_flag(
      "--psd", options->psd, "Also four distance sensors that look at the floor: DIR/psd");
  add_common_flags(robot, *options);
  add_scanner_flags(robot, *options);
  add_base_flags(robot, *options);
  robot.callback([options, &status] {
    EmulationOptions& emulation = options->emulation;
    make_folder(options->links);
    const std::size_t scanners = find_scenario(options->scenario).robot.sensors.lasers.size();
    for (std::size_t i = 0; i < scanners; ++i) {
      emulation.scanner_links.push_back(options->links /
                                        (i == 0 ? "scanner" : fmt::format("scanner{}", i + 1)));
    }
    emulation.base = std::ranges::find(kBases, options->base, &BaseRow::name)->kind;
    emulation.base_link = options->links / "base";
    if (options->psd) emulation.psd_link = options->links / "psd";
    options->robot_file = options->links / "robot.toml";
    emulate_devices(*options);
    status = 0;
  });
}

}  // namespace server
