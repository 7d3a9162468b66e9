// server/cli/sweep_files.cpp: from a document to a plan, from rows to files.
#include "server/cli/sweep_files.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/experiment/sweep/sweep_report.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/experiment/sweep/sweep_tables.hpp"
#include "server/run/paths.hpp"

namespace server {

sweep::Plan plan_from(const nlohmann::json& document,
                      const std::string& file,
                      std::shared_ptr<const algo::ControllerCatalogue> controllers) {
  const ScenarioLibrary library(
      state_folder() / "scenarios", state_folder() / "logs", own_robots());
  try {
    sweep::Plan plan(sweep::document_from_json(
        document, library, std::move(controllers), sweep::Files::Allowed));
    plan.check();
    return plan;
  } catch (const DocumentError& e) {
    throw std::runtime_error(fmt::format("{}: {}", file, e.what()));
  }
}

sweep::Plan plan_in(const std::filesystem::path& folder,
                    std::shared_ptr<const algo::ControllerCatalogue> controllers) {
  const std::filesystem::path log = folder / "runs.jsonl";
  const nlohmann::json document = sweep::logged_document(log);
  try {
    std::optional<sweep::Document> kept = sweep::document_in(folder, document, controllers);
    if (kept) return sweep::Plan(std::move(*kept));
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(fmt::format("{}: {}", folder.string(), e.what()));
  }
  return plan_from(document, log.string(), std::move(controllers));  // only the log was copied
}

int write_and_print(const sweep::Plan& plan, const sweep::Rows& rows, const std::string& folder) {
  const sweep::Results results = results_of(plan, rows);
  write_report(plan, rows, results, folder);
  fmt::print("{}", to_text(sweep::rates_table(plan, results)));
  fmt::print(
      "\nWritten to {}: report.html, report.md, report.tex, results.json, runs.csv, pictures\n",
      folder);
  if (results.complete()) return kReached;
  fmt::print(stderr,
             "tautline: {} `tautline sweep` makes these runs; with --rerun failed also those that "
             "killed the program.\n",
             incomplete_text(results));
  return results.failed > 0 ? kBadInput : kIncomplete;
}

}  // namespace server
