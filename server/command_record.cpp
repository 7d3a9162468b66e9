// server/command_record.cpp: `tautline export` and `tautline verify`: looking back at stored runs.
#include <cstdio>
#include <fstream>
#include <memory>

#include <fmt/format.h>

#include "db/run_reader.hpp"
#include "server/cli.hpp"
#include "server/paths.hpp"
#include "server/run_json.hpp"
#include "server/verify.hpp"

namespace server {
namespace {

struct Options {
  db::RunId run = 0;
  std::string database = (state_folder() / "runs.db").string();
  std::string format = "csv";
  std::string output{};
  bool as_json = false;
};

std::shared_ptr<Options> add_common(CLI::App& command) {
  auto options = std::make_shared<Options>();
  command.add_option("RUN", options->run, "Number of the run")->required();
  command.add_option("--db", options->database, "Database file (default: the server's own)")
      ->type_name("FILE");
  return options;
}

void export_run(const Options& options) {
  db::RunReader reader(options.database);
  std::FILE* out = stdout;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(nullptr, &std::fclose);
  if (!options.output.empty()) {
    file.reset(std::fopen(options.output.c_str(), "wb"));
    if (!file) throw std::runtime_error(fmt::format("Cannot write {}.", options.output));
    out = file.get();
  }
  if (!reader.get(options.run)) {
    throw std::runtime_error(
        fmt::format("There is no run {} in {}.", options.run, options.database));
  }
  ProgressLine progress;
  std::string text(db::RunReader::csv_header());
  std::optional<std::uint64_t> from = 0;
  bool written = true;
  while (from && written) {
    from = reader.csv(options.run, *from, 4096, text, csv_names());
    written = std::fwrite(text.data(), 1, text.size(), out) == text.size();
    text.clear();
    if (from && !options.output.empty()) progress.show(fmt::format("{} ticks", *from));
  }
  if (!written || std::fflush(out) != 0) {
    throw std::runtime_error("The export could not be written completely: is the disk full?");
  }
}

int verify(const Options& options) {
  db::RunReader reader(options.database);
  const Verification result = verify_run(reader, options.run);
  if (options.as_json) {
    nlohmann::json out = {{"run", options.run},
                          {"ticks", result.ticks},
                          {"identical", !result.difference.has_value()}};
    if (result.difference) out["difference"] = *result.difference;
    fmt::print("{}\n", out.dump(2));
  } else if (result.difference) {
    fmt::print("Run {} differs. {}\n", options.run, *result.difference);
  } else {
    fmt::print("Run {}: {} ticks, identical commands.\n", options.run, result.ticks);
  }
  return result.difference ? 2 : 0;
}

}  // namespace

void add_export_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("export", "Write a stored run as a table");
  auto options = add_common(*command);
  command->add_option("--format", options->format, "csv")->check(CLI::IsMember({"csv"}));
  command->add_option("--output,-o", options->output, "File to write (default: standard output)");
  command->callback([options, &status] {
    export_run(*options);
    status = 0;
  });
}

void add_verify_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "verify", "Feed a stored run to a fresh pipeline and compare every command");
  auto options = add_common(*command);
  command->add_flag("--json", options->as_json, "Print JSON");
  command->footer("Exit status: 0 identical, 1 bad input or error, 2 different.");
  command->callback([options, &status] { status = verify(*options); });
}

}  // namespace server
