// server/command_filter_study.cpp: `tautline reproduce-filter`: chapter 3 of the thesis done again.
#include <memory>

#include <fmt/format.h>

#include "server/cli.hpp"
#include "server/reproduce/filter_study.hpp"

namespace server {
namespace {

struct Options {
  std::string logs{};
  std::string markdown{};
  bool as_json = false;
};

int execute(const Options& options) {
  FilterStudyOptions wanted;
  if (!options.logs.empty()) wanted.logs = options.logs;
  const FilterStudy study = study_filters(wanted);
  if (options.as_json) {
    fmt::print("{}\n", to_json(study).dump(2));
  } else if (options.markdown == "-") {
    fmt::print("{}", to_markdown(study, "pictures/reproduction"));
  } else {
    fmt::print("{}", to_text(study));
  }
  if (!options.markdown.empty() && options.markdown != "-") {
    write_markdown(study, options.markdown);
  }
  return 0;
}

}  // namespace

void add_filter_study_command(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "reproduce-filter", "Do the thesis' filter chapter again and judge its sentences");
  command->add_option("--logs", options->logs, "Folder of CARMEN logs of a real scanner")
      ->type_name("DIR");
  command
      ->add_option("--markdown",
                   options->markdown,
                   "Write the section into this file, its pictures beside it; - prints it")
      ->type_name("FILE");
  command->add_flag("--json", options->as_json, "Print JSON");
  command->footer("Exit status: 0 done, whatever the verdicts, 1 bad input or error.");
  command->callback([options, &status] { status = execute(*options); });
}

}  // namespace server
