// server/cli/command_record.cpp: `tautline export` and `tautline verify`: for stored runs.
#include <algorithm>
#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "db/run_reader.hpp"
#include "server/cli/cli.hpp"
#include "server/cli/output_files.hpp"
#include "server/record/run_csv.hpp"
#include "server/record/run_json.hpp"
#include "server/record/verify.hpp"
#include "server/run/paths.hpp"

namespace server {
namespace {

struct RecordCommand {
  db::RunId run = 0;
  std::string database = (state_folder() / "runs.db").string();
  std::string format = "csv";
  std::string output{};
  bool as_json = false;
  CsvOptions csv{};
};

std::shared_ptr<RecordCommand> add_common(Command command) {
  auto options = std::make_shared<RecordCommand>();
  command.add_option("RUN", options->run, "Number of the run").required();
  command.add_option("--db", options->database, "Database file (default: the server's own)")
      .type_name("FILE");
  return options;
}

int export_run(const RecordCommand& options) {
  refuse_shared_files(
      {{"--db", options.database}, {"the journal of --db", options.database + "-wal"}},
      {{"--output", options.output}});
  db::RunReader reader(options.database);
  const auto row = reader.get(options.run);
  if (!row) {
    throw std::runtime_error(
        fmt::format("There is no run {} in {}.", options.run, options.database));
  }
  std::FILE* out = stdout;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(nullptr, &std::fclose);
  if (!options.output.empty()) {
    file.reset(std::fopen(options.output.c_str(), "wb"));
    if (!file) throw std::runtime_error(fmt::format("Cannot write {}.", options.output));
    out = file.get();
  }
  ProgressLine progress;
  const RunCsv csv(reader, *row, options.csv);
  std::string text = csv.header();
  std::optional<std::uint64_t> from = 0;
  bool written = true;
  std::uint64_t ticks = 0;
  while (from && written) {
    from = csv.lines(reader, *from, 4096, text);
    ticks += static_cast<std::uint64_t>(std::ranges::count(text, '\n'));
    written = std::fwrite(text.data(), 1, text.size(), out) == text.size();
    text.clear();
    if (from && !options.output.empty()) progress.show(fmt::format("{} ticks", *from));
  }
  if (!written || std::fflush(out) != 0) {
    throw std::runtime_error("The export could not be written completely: is the disk full?");
  }
  const auto incomplete = incompleteness(reader, *row, ticks - 1);  // less the header
  if (!incomplete) return 0;
  fmt::print(
      stderr, "tautline: The export of run {} is incomplete. {}\n", options.run, *incomplete);
  return kIncomplete;
}

int verify(const RecordCommand& options) {
  db::RunReader reader(options.database);
  const Verification result = verify_run(reader, options.run);
  if (options.as_json) {
    nlohmann::json out = {{"run", options.run},
                          {"ticks", result.ticks},
                          {"compared", result.compared},
                          {"identical", !result.difference.has_value()},
                          {"complete", !result.incomplete.has_value()}};
    if (result.difference) out["difference"] = *result.difference;
    if (result.incomplete) out["incomplete"] = *result.incomplete;
    fmt::print("{}\n", out.dump(2));
  } else if (result.difference) {
    fmt::print("Run {} differs. {}\n", options.run, *result.difference);
  } else if (result.incomplete) {
    fmt::print("Run {} is incomplete: {} of {} ticks compared, identical commands. {}\n",
               options.run,
               result.compared,
               result.ticks,
               *result.incomplete);
  } else {
    fmt::print("Run {}: {} ticks, identical commands.\n", options.run, result.ticks);
  }
  if (result.difference) return kDifferent;
  return result.incomplete ? kIncomplete : 0;
}

}  // namespace

void add_export_command(Command app, int& status) {
  const Command command = app.add_subcommand("export", "Write a stored run as a table");
  auto options = add_common(command);
  command.add_option("--format", options->format, "csv").one_of({"csv"});
  command.add_option("--output,-o", options->output, "File to write (default: standard output)")
      .check(refuse_unwritable);
  command.add_flag("--units", options->csv.units, "Name the columns with their units: \"t [s]\"");
  command.add_flag("--arrays",
                   options->csv.arrays,
                   "Also the ranges of all scans, and the obstacles that move by themselves");
  command.footer(
      "Exit status: 0 the whole run, 1 bad input or error, 4 incomplete: a gap, a cut, or a run "
      "deleted meanwhile; the rest has been written.");
  command.callback([options, &status] { status = export_run(*options); });
}

void add_verify_command(Command app, int& status) {
  const Command command = app.add_subcommand(
      "verify", "Feed a stored run to a fresh pipeline and compare every command");
  auto options = add_common(command);
  command.add_flag("--json", options->as_json, "Print JSON");
  command.footer(
      "Exit status: 0 identical, 1 bad input or error, 2 different, 4 incomplete: a gap, a pause "
      "or a cut of the record, beyond which nothing can be compared.");
  command.callback([options, &status] { status = verify(*options); });
}

}  // namespace server
