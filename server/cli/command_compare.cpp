// server/cli/command_compare.cpp: `tautline compare`: compares every controller.
#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/output_files.hpp"
#include "server/cli/pool_options.hpp"
#include "server/lab/compare/report.hpp"

namespace server {
namespace {

struct CompareCommand {
  compare::Options options{};
  std::vector<std::string> parts{};
  bool as_json = false;
  std::string rows{};
  std::string markdown{};
};

int execute(CompareCommand command) {
  const auto wanted = [&](const char* part) {
    return command.parts.empty() || std::ranges::find(command.parts, part) != command.parts.end();
  };
  command.options.worlds = wanted("worlds");
  command.options.bottlenecks = wanted("bottlenecks");
  command.options.random_layouts = wanted("layouts");
  compare::Comparison comparison;
  {
    ProgressLine progress;
    command.options.progress = [&](const std::string& what, std::size_t done, std::size_t all) {
      progress.show(fmt::format("{}: {} of {} runs", what, done, all));
    };
    comparison = compare::compare(command.options);
  }
  if (command.as_json) {
    fmt::print("{}\n", compare::to_json(comparison).dump(2));
  } else {
    fmt::print("{}", compare::to_text(comparison));
  }
  if (!command.rows.empty()) write_table(rows_table(comparison), command.rows);
  if (!command.markdown.empty()) compare::write_markdown(comparison, command.markdown);
  return compare::strip_on_layouts(comparison.layouts).held() ? kReached : kNotHeld;
}

}  // namespace

void add_compare_command(Command app, int& status) {
  auto command = std::make_shared<CompareCommand>();
  const Command compare = app.add_subcommand(
      "compare", "Run every controller on the same worlds and say which published claims hold");
  compare.add_option("--part", command->parts, "worlds, bottlenecks or layouts (default: all)")
      .one_of({"worlds", "bottlenecks", "layouts"});
  compare.add_option("--controller",
                     command->options.only,
                     "Only this controller, on the worlds and the bottlenecks; repeatable");
  compare
      .add_option("--judge",
                  command->options.judges,
                  "Also this judge, with its columns in the details; repeatable")
      .check(refuse_unknown_judge);
  add_rows_option(compare, command->rows);
  compare.add_option("--seeds", command->options.seeds, "Runs per row (default 3)").range(1, 1000);
  add_first_seed_option(compare, command->options.first_seed);
  compare.add_option("--layouts", command->options.layouts, "Random ones a kind (default 150)")
      .range(1, 10'000);
  compare
      .add_option(
          "--layout-seeds", command->options.layout_seeds, "Runs per random layout (default 2)")
      .range(1, 1000);
  add_threads_option(compare, command->options.threads);
  compare
      .add_option("--markdown",
                  command->markdown,
                  "Also write comparison.md to this folder, and the table of the worlds into its "
                  "controllers.md")
      .check([](const std::string& folder) {
        return refuse_unwritable_document(folder + "/comparison.md");
      })
      .type_name("DIR");
  compare.add_flag("--json", command->as_json, "Print JSON");
  std::string footer = "Judges:\n";
  for (const experiment::JudgeInfo& judge : experiment::judge_table()) {
    footer += fmt::format("  {:<12}{}\n", judge.name, judge.help);
  }
  compare.footer(footer +
                 "Exit status: 0, 1 bad input, 3 `strip` failed on the random layouts: fewer "
                 "than 99 % of goals reached, or a collision.");
  compare.callback([command, &status] { status = execute(*command); });
}

}  // namespace server
