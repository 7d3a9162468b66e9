// server/cli/program.cpp: runs a command by its arguments; every error is a sentence.
#include "server/cli/program.hpp"

#include <cstdio>
#include <exception>
#include <new>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "server/run/version.hpp"

namespace server {
namespace {

int carry_out(int argc,
              char** argv,
              const std::vector<AddCommand>& commands,
              const std::string& footer) {
  CLI::App app{"Tautline: simulation and teleoperation of mobile robots, in the browser."};
  app.name("tautline");
  app.set_version_flag("--version", fmt::format("tautline {}", kVersion));
  app.require_subcommand(1);
  app.footer(footer);
  int status = 0;
  try {
    for (const AddCommand& add : commands) add(Command(app), status);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    // CLI11's own statuses reach 100 and more; scripts read 1 as "bad input".
    if (app.exit(e) == 0) return 0;
    fmt::print(stderr, "{}\n", footer);
    return kBadInput;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "tautline: There is not enough memory for this.\n");
    return kBadInput;
  } catch (const std::exception& e) {
    fmt::print(stderr, "tautline: {}\n", e.what());
    return kBadInput;
  }
  return status;
}

}  // namespace

std::vector<AddCommand> serving_commands() {
  return {add_serve_command,
          add_run_command,
          add_replay_command,
          add_export_command,
          add_verify_command,
          add_health_command,
          add_doctor_command,
          add_lms200_command};
}

int run_program(int argc,
                char** argv,
                const std::vector<AddCommand>& commands,
                const std::string& footer) {
  const int status = carry_out(argc, argv, commands, footer);
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  fmt::print(stderr, "tautline: The output could not be written completely: is the disk full?\n");
  return status == 0 ? kBadInput : status;
}

}  // namespace server
