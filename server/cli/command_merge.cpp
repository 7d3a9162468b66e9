// server/cli/command_merge.cpp: `tautline merge`: folds the shards of an experiment into one
// folder.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/sweep_files.hpp"
#include "server/experiment/sweep/merge.hpp"
#include "server/experiment/sweep/sweep_run.hpp"

namespace server {
namespace {

struct MergeCommand {
  std::string out{};
  std::vector<std::string> shards{};
  ControllerFlags controllers{};
};

int merge(const MergeCommand& command) {
  const sweep::Plan plan = plan_in(command.shards.front(), command.controllers.catalogue());
  const sweep::Merged merged =
      merge_shards(plan, command.out, {command.shards.begin(), command.shards.end()});
  write_scenarios(plan.document(), command.out);
  for (const std::string& warning : merged.warnings) fmt::print(stderr, "tautline: {}\n", warning);
  fmt::print("{} runs are new, from {} shards\n\n", merged.added, command.shards.size());
  return write_and_print(plan, merged.rows, command.out);
}

}  // namespace

void add_merge_command(Command app, int& status) {
  auto options = std::make_shared<MergeCommand>();
  const Command command = app.add_subcommand(
      "merge", "Fold the shards of an experiment into one folder, and write its report");
  command.add_option("out", options->out, "The folder to fold into; it may hold runs already")
      .required()
      .type_name("OUT");
  command.add_option("shards", options->shards, "The folders of `tautline sweep --shard`")
      .required()
      .existing_folder()
      .type_name("SHARD...");
  options->controllers.add_to(command, "A controller of your own that the runs had; repeatable");
  command.footer(
      "The shards are only read; merging again changes nothing. Exit status: 0, 1 bad input or a "
      "run failed, 4 runs are missing.");
  command.callback([options, &status] { status = merge(*options); });
}

}  // namespace server
