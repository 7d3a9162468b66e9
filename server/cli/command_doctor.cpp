// server/cli/command_doctor.cpp: `tautline doctor`.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/doctor.hpp"
#include "server/cli/signals.hpp"

namespace server {
namespace {

struct DoctorCommand {
  std::string robot{};
  DoctorOptions doctor{};
};

void print(const Finding& finding) {
  const char* word = "ok  ";
  if (finding.verdict == Finding::Verdict::Note) word = "note";
  if (finding.verdict == Finding::Verdict::Bad) word = "BAD ";
  fmt::print("{}  {}: {}\n", word, finding.device, finding.sentence);
  if (!finding.advice.empty()) fmt::print("      -> {}\n", finding.advice);
  std::fflush(stdout);
}

}  // namespace

void add_doctor_command(Command app, int& status) {
  auto options = std::make_shared<DoctorCommand>();
  const Command command =
      app.add_subcommand("doctor", "Check each device of a robot and print advice");
  command.add_option("--robot", options->robot, "The robot's TOML file")
      .type_name("FILE")
      .required();
  command.add_flag("--move",
                   options->doctor.move,
                   "Turn the wheels slowly for two seconds; lift them off the floor first");
  command.add_option("--patience", options->doctor.patience, "Longest search for each device")
      .type_name("SECONDS")
      .range(1.0, 300.0)
      .show_default();
  command.footer(
      "Exit status: 0 no fault, 2 a device has a fault, 1 the file is invalid, or interrupted.");
  command.callback([options, &status] {
    const drivers::RobotFile file = drivers::read_robot_file(options->robot);
    heed_signals();
    options->doctor.interrupted = end_requested;
    const bool well = examine(file, options->doctor, print);
    fmt::print("{}\n", well ? "All is well." : "There are faults; see BAD above.");
    status = well ? 0 : kNotWell;
  });
}

}  // namespace server
