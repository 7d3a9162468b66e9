// server/command_reproduce.cpp: `tautline reproduce`: the sources' scenarios, and what holds.
#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "server/cli.hpp"
#include "server/reproduce/report.hpp"

namespace server {
namespace {

struct Options {
  std::string scenarios{};
  bool as_json = false;
  bool paper_only = false;
  reproduce::StudyOptions study{};
};

int execute(Options options) {
  const reproduce::PaperFile file = options.scenarios.empty()
                                        ? reproduce::embedded_paper_file()
                                        : reproduce::read_paper_file(options.scenarios);
  options.study.full_simulator = !options.paper_only;
  reproduce::Study study;
  {
    ProgressLine progress;
    options.study.progress = [&](const std::string& what, std::size_t done, std::size_t all) {
      progress.show(fmt::format("{}: {} of {} runs", what, done, all));
    };
    study = reproduce::run_study(file, options.study);
  }
  if (options.as_json) {
    fmt::print("{}\n", reproduce::to_json(study).dump(2));
  } else {
    fmt::print("{}", reproduce::to_text(study));
  }
  return reproduce::all_held(study.checks) ? kReached : kNotHeld;
}

}  // namespace

void add_reproduce_command(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "reproduce", "Run the papers' scenarios with every reading and say which claims hold");
  command->add_option("--scenarios", options->scenarios, "Another file of layouts and limits")
      ->type_name("FILE");
  command->add_option("--seeds", options->study.seeds, "Runs of each row (default 10)")
      ->check(CLI::Range(1, 1000));
  command->add_option("--first-seed", options->study.first_seed, "The first of them (default 1)")
      ->check(CLI::Range(0, 1'000'000'000));
  command->add_option("--threads", options->study.threads, "0 (default): one a core")
      ->check(CLI::Range(0, 256));
  command->add_flag("--paper-only", options->paper_only, "Leave out the full simulator");
  command->add_flag("--json", options->as_json, "Print JSON");
  command->footer("Exit status: 0 every limit of the file held, 1 bad input, 3 some did not.");
  command->callback([options, &status] { status = execute(*options); });
}

}  // namespace server
