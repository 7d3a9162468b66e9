// server/cli/main.cpp: the program: one subcommand each for serving, running, replaying, looking
// back.
#include <cstdio>
#include <exception>
#include <new>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/run/version.hpp"

namespace {

int main_of(int argc, char** argv) {
  CLI::App app{"Tautline: simulation and teleoperation of mobile robots, in the browser."};
  app.name("tautline");
  app.set_version_flag("--version", fmt::format("tautline {}", server::kVersion));
  app.require_subcommand(1);
  app.footer("Each command has its own --help. First time: tautline serve");
  int status = 0;
  try {
    server::add_serve_command(app, status);
    server::add_run_command(app, status);
    server::add_replay_command(app, status);
    server::add_export_command(app, status);
    server::add_verify_command(app, status);
    server::add_health_command(app, status);
    server::add_reproduce_command(app, status);
    server::add_barn_command(app, status);
    server::add_soak_command(app, status);
    server::add_emulate_command(app, status);
    server::add_compare_command(app, status);
    server::add_doctor_command(app, status);
    server::add_lms200_command(app, status);
    server::add_map_command(app, status);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    // CLI11's own statuses reach 100 and more; scripts read 1 as "bad input".
    return app.exit(e) == 0 ? 0 : server::kBadInput;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "tautline: There is not enough memory for this.\n");
    return server::kBadInput;
  } catch (const std::exception& e) {
    fmt::print(stderr, "tautline: {}\n", e.what());
    return server::kBadInput;
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  const int status = main_of(argc, argv);
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  fmt::print(stderr, "tautline: The output could not be written completely: is the disk full?\n");
  return status == 0 ? server::kBadInput : status;
}
