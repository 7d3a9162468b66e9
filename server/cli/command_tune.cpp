// server/cli/command_tune.cpp: `tautline tune`: searches parameters on training scenarios, and
// reports them on test scenarios.
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/interrupt_watch.hpp"
#include "server/cli/pool_options.hpp"
#include "server/cli/sweep_files.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/lab/tune/tune_run.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/paths.hpp"
#include "server/run/text_file.hpp"
#include "server/run/version.hpp"

namespace server {
namespace {

using nlohmann::json;

struct TuneCommand {
  std::string file{};
  std::string out{};
  unsigned workers = 0;
  ControllerFlags controllers{};
};

tune::Document read_document(const TuneCommand& command) {
  const ScenarioLibrary library(
      state_folder() / "scenarios", state_folder() / "logs", own_robots());
  try {
    tune::Document document =
        tune::document_from_json(parse_json(read_text(command.file), kOwnDocument),
                                 library,
                                 command.controllers.catalogue());
    sweep::Plan(document.training).check();
    return document;
  } catch (const JsonError& e) {
    throw std::runtime_error(fmt::format("{}: {}", command.file, e.what()));
  } catch (const DocumentError& e) {
    throw std::runtime_error(fmt::format("{}: {}", command.file, e.what()));
  }
}

/// Refuses a folder with another search before hours of work.
void claim(const tune::Document& document, const std::filesystem::path& out) {
  const std::filesystem::path file = out / "tune.json";
  const json ours = {{"tautline", kVersion}, {"document", document.source}};
  if (!std::filesystem::exists(file)) {
    if (std::filesystem::exists(out / "runs.jsonl")) {
      throw std::runtime_error(out.string() +
                               ": holds an experiment. Choose another folder with --out.");
    }
    make_folder(out);
    replace_text(file, ours.dump(1) + "\n");
    return;
  }
  if (json::parse(read_text(file), nullptr, false) != ours) {
    throw std::runtime_error(file.string() +
                             ": is of another document or version. Choose another folder with "
                             "--out, or remove this one.");
  }
}

std::string setting_text(const sweep::Point& point) {
  std::string text;
  for (const auto& [key, value] : point) text += fmt::format(" --set {}={}", key, value);
  return text;
}

int execute(TuneCommand command) {
  const tune::Document document = read_document(command);
  if (command.out.empty()) command.out = document.training.name;
  claim(document, command.out);
  std::stop_source stop;
  const InterruptWatch watch(stop);
  experiment::PoolOptions pool{.threads = command.workers, .stop = stop.get_token()};
  const std::optional<std::vector<tune::Attempt>> attempts =
      with_progress(pool, "settings", [&] { return search(document, pool); });
  if (!attempts) {
    fmt::print(stderr, "tautline: The search was interrupted; it begins anew next time.\n");
    return kIncomplete;
  }
  const std::filesystem::path out = command.out;
  write_text(out / "search.csv", to_csv(document, *attempts));
  const tune::Attempt& best = best_of(*attempts);
  if (!std::isfinite(best.loss)) {
    throw std::runtime_error(
        "of all settings tried, the controller refused each or none reached a goal; see " +
        (out / "search.csv").string());
  }
  const sweep::Plan plan =
      plan_from(document.test_of(best.point), command.file, command.controllers.catalogue());
  const sweep::Rows rows = run_sweep(plan, out, pool);
  fmt::print("{} settings tried; the best:{}\n\nOn the test scenarios:\n",
             attempts->size(),
             setting_text(best.point));
  return write_and_print(plan, rows, command.out);
}

}  // namespace

void add_tune_command(Command app, int& status) {
  auto command = std::make_shared<TuneCommand>();
  const Command tune = app.add_subcommand(
      "tune", "Search parameters on training scenarios, and report them on test scenarios");
  tune.add_option("file", command->file, "The document, as JSON (docs/experiments.md)")
      .required()
      .existing_file()
      .type_name("FILE");
  add_threads_option(tune, command->workers, "--workers");
  command->controllers.add_to(
      tune, "A controller of your own for the document to name, as NAME=COMMAND; repeatable");
  tune.add_option("--out", command->out, "Folder of the results (default: the document's name)")
      .type_name("DIR");
  tune.footer(
      "The same document gives the same result. Exit status: 0, 1 bad input or a run failed, 4 "
      "interrupted.");
  tune.callback([command, &status] { status = execute(*command); });
}

}  // namespace server
