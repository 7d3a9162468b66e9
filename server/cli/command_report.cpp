// server/cli/command_report.cpp: `tautline report`: the report of an experiment without running it.
#include <filesystem>
#include <memory>
#include <string>

#include "server/cli/cli.hpp"
#include "server/cli/sweep_files.hpp"
#include "server/experiment/sweep/sweep_run.hpp"

namespace server {
namespace {

struct ReportCommand {
  std::string folder{};
  ControllerFlags controllers{};
};

int report(const ReportCommand& command) {
  const std::string& folder = command.folder;
  const sweep::Plan plan = plan_in(folder, command.controllers.catalogue());
  return write_and_print(plan, sweep::open_log(plan, folder)->found(), folder);
}

}  // namespace

void add_report_command(Command app, int& status) {
  auto options = std::make_shared<ReportCommand>();
  const Command command = app.add_subcommand(
      "report", "Write the report of an experiment again, from its finished runs");
  command.add_option("folder", options->folder, "The folder that `tautline sweep` wrote")
      .required()
      .existing_folder()
      .type_name("DIR");
  options->controllers.add_to(command, "A controller of your own that the runs had; repeatable");
  command.footer("Exit status: 0, 1 bad input or a run failed, 4 runs are missing.");
  command.callback([options, &status] { status = report(*options); });
}

}  // namespace server
