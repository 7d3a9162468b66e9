// server/cli/command_lms200.cpp: `tautline lms200`: one scanner without a robot.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "drivers/lms200_device.hpp"
#include "server/cli/carmen_line.hpp"
#include "server/cli/cli.hpp"
#include "server/cli/signals.hpp"

namespace server {
namespace {

using drivers::lms200::LaserSetup;
using drivers::lms200::Lms200Device;

struct Lms200Command {
  std::string port{};
  std::optional<unsigned> rate{};
  std::optional<double> step{};
  std::optional<unsigned> angle{};
  std::optional<unsigned> range{};
  std::string password{drivers::lms200::kFactoryPassword};
  double patience = 20;
  std::size_t scans = 0;
  std::string output{};

  /// Lms200Command not given keep the device's settings. Throws for settings that no device has.
  LaserSetup setup() const {
    LaserSetup out;
    out.password = password;
    out.as_it_is = !rate && !step && !angle && !range;
    out.baud = rate.value_or(out.baud);
    out.range = range.value_or(out.range);
    if (angle) out.variant.angle_degrees = static_cast<std::uint16_t>(*angle);
    if (step) out.variant.step_centidegrees = static_cast<std::uint16_t>(std::lround(*step * 100));
    if (const std::string why = refusal(out); !why.empty()) throw std::runtime_error(why + ".");
    return out;
  }
};

void nap() {
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

/// Waits until the scanner runs. Throws the reason when it does not.
void wait_for(Lms200Device& laser, double patience) {
  const bool runs = laser.comes_to_run(patience, [] { return end_requested(); });
  if (!runs && !end_requested()) throw std::runtime_error(laser.details().trouble);
}

void print_info(Lms200Device& laser) {
  const double until = drivers::steady_now() + 1.0;  // for a measured scan rate
  while (drivers::steady_now() < until && !end_requested()) nap();
  const algo::DeviceReport report = laser.report();
  fmt::print("{}: {}\n", report.port, report.sentence);
  for (const auto& [name, value] : report.facts) fmt::print("  {:<18} {}\n", name, value);
  for (const std::string& remark : report.remarks) fmt::print("  note: {}\n", remark);
}

bool next_scan(Lms200Device& laser, algo::LaserScan& scan) {
  const double until = drivers::steady_now() + 5.0;
  while (!end_requested()) {
    if (laser.take(scan)) return true;
    if (drivers::steady_now() > until) throw std::runtime_error(laser.details().trouble);
    nap();
  }
  return false;
}

/// Prints degrees and millimetres; a word for a beam without a distance.
void print_scan(Lms200Device& laser) {
  algo::LaserScan scan;
  if (!next_scan(laser, scan)) return;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double degrees = scan.angle(i) * 180 / std::numbers::pi;
    if (scan.status[i] == algo::Beam::Ok) {
      fmt::print("{:.2f} {:.0f}\n", degrees, scan.ranges[i] * 1000);
    } else {
      fmt::print("{:.2f} {}\n",
                 degrees,
                 scan.status[i] == algo::Beam::Free
                     ? "free"
                     : fmt::format("code-{:X}", static_cast<unsigned>(scan.codes[i])));
    }
  }
}

/// [s] Time of day at the end of `scan`.
double wall_now(const algo::LaserScan& scan) {
  const auto day = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(day).count() - (drivers::steady_now() - scan.stamp);
}

void write_log(Lms200Device& laser, const Lms200Command& options) {
  std::ofstream file;
  if (!options.output.empty()) {
    file.open(options.output);
    if (!file) throw std::runtime_error(options.output + " cannot be written.");
  }
  std::ostream& out = options.output.empty() ? std::cout : file;
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  algo::LaserScan scan;
  std::optional<double> first;
  for (std::size_t n = 0; options.scans == 0 || n < options.scans; ++n) {
    if (!next_scan(laser, scan)) break;
    if (!first) first = scan.stamp;
    out << carmen_line(scan, host.data(), wall_now(scan), scan.stamp - *first) << '\n';
    if (!out) break;
  }
  if (!out.flush()) throw std::runtime_error("The log cannot be written: is the disk full?");
}

void add_common(Command command, Lms200Command& options) {
  command.add_option("device", options.port, "A serial port, or tcp:HOST:PORT").required();
  command.add_option("--rate", options.rate, "Line rate to set")
      .one_of({9600U, 19200U, 38400U, 500'000U});
  command.add_option("--step", options.step, "Degrees between two beams: 1, 0.5 or 0.25")
      .one_of({1.0, 0.5, 0.25});
  command.add_option("--angle", options.angle, "Field of view: 100 or 180 degrees")
      .one_of({100U, 180U});
  command.add_option("--range", options.range, "Metres: 8, 16, 32 or 80 (in centimetres)")
      .one_of({8U, 16U, 32U, 80U});
  add_password_option(command, options.password);
  command.add_option("--patience", options.patience, "Seconds to search for the scanner")
      .range(1.0, 300.0)
      .show_default();
}

template <class Action>
Command add_action(Command parent,
                   const char* name,
                   const char* help,
                   const std::shared_ptr<Lms200Command>& options,
                   int& status,
                   Action action) {
  const Command command = parent.add_subcommand(name, help);
  add_common(command, *options);
  command.callback([options, &status, action] {
    heed_signals();
    try {
      Lms200Device laser("laser", options->port, options->setup());
      wait_for(laser, options->patience);
      action(laser, *options);
      status = 0;
    } catch (const std::runtime_error& error) {
      fmt::print(stderr, "tautline: {}\n", error.what());
      status = kNotWell;
    }
  });
  return command;
}

}  // namespace

void add_lms200_command(Command app, int& status) {
  auto options = std::make_shared<Lms200Command>();
  const Command command =
      app.add_subcommand("lms200", "One SICK LMS2xx: its state, a scan or a log of scans");
  command.require_subcommand();
  command.footer(
      "Without --rate, --step, --angle or --range the scanner keeps its own settings. At the end "
      "it "
      "is silent, at the rate at which it was found.");
  add_action(command,
             "info",
             "Print its type, settings and health",
             options,
             status,
             [](Lms200Device& laser, const Lms200Command&) { print_info(laser); });
  add_action(command,
             "scan",
             "Print one scan: degrees, millimetres",
             options,
             status,
             [](Lms200Device& laser, const Lms200Command&) { print_scan(laser); });
  const Command log =
      add_action(command,
                 "log",
                 "Write scans as CARMEN FLASER lines, until Ctrl-C",
                 options,
                 status,
                 [](Lms200Device& laser, const Lms200Command& o) { write_log(laser, o); });
  log.add_option("--scans", options->scans, "Number of scans; 0: no end").show_default();
  log.add_option("--out", options->output, "File to write instead of standard output")
      .type_name("FILE");
}

}  // namespace server
