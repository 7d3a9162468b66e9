// server/experiment/sweep/sweep_run.cpp: the runs on the pool.
#include "server/experiment/sweep/sweep_run.hpp"

#include <algorithm>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "server/experiment/track.hpp"
#include "server/record/run_json.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/map_file.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/text_file.hpp"

namespace server::sweep {
namespace {

namespace fs = std::filesystem;
using experiment::Row;

constexpr const char* kOrder = "scenarios/order.txt";  // names in the document's order, one a line

/// Throws std::runtime_error if ticks of the run are not stored. Null: it was not to be recorded.
void check_record(const RunChannel* record) {
  if (record == nullptr) return;
  const std::string problem = record->incomplete();
  if (problem.empty()) return;
  throw std::runtime_error("The record of this run is incomplete. " + problem);
}

}  // namespace

void write_scenarios(const Document& document, const fs::path& folder) {
  make_folder(folder / "scenarios");
  std::string order;
  for (const sim::Scenario& scenario : document.scenarios) {
    write_text(folder / scenario_file(scenario), to_json(scenario).dump(1) + "\n");
    order += scenario.name + '\n';
    const fs::path map(scenario.map);
    if (map.has_parent_path()) write_map(read_map(map), folder / "scenarios" / map.filename());
  }
  replace_text(folder / kOrder, order);
}

std::optional<Document> document_in(const fs::path& folder,
                                    const nlohmann::json& source,
                                    std::shared_ptr<const algo::ControllerCatalogue> controllers) {
  std::error_code missing;
  if (!fs::exists(folder / kOrder, missing)) return std::nullopt;
  std::vector<sim::Scenario> scenarios;
  std::istringstream names(read_text(folder / kOrder));
  for (std::string name; std::getline(names, name);) {
    const fs::path file = folder / scenario_file({.name = name});
    if (!fs::exists(file, missing)) return std::nullopt;
    scenarios.push_back(ScenarioLibrary::from_file(file));
  }
  return document_with(source, std::move(scenarios), std::move(controllers));
}

std::unique_ptr<RunLog> open_log(const Plan& plan, const fs::path& folder) {
  return std::make_unique<RunLog>(folder / "runs.jsonl", identity_of(plan.document()), plan.size());
}

std::vector<std::size_t> runs_to_make(const Rows& rows,
                                      Wanted wanted,
                                      const std::set<std::size_t>& lost,
                                      const experiment::Shard& shard) {
  std::vector<std::size_t> runs;
  for (std::size_t i = shard.index; i < rows.size(); i += shard.count) {
    bool chosen = !rows.has(i) || (rows.broken(i) && !rows.killed_twice(i));
    if (wanted == Wanted::Failed) chosen = rows.has(i) && rows.broken(i);
    if (wanted == Wanted::Lost) chosen = lost.contains(i);
    if (chosen) runs.push_back(i);
  }
  return runs;
}

Row run_one(const Plan& plan,
            std::size_t i,
            const std::stop_token& stop,
            const Recording& recording) {
  try {
    const experiment::Trial trial = plan.trial(i);
    std::shared_ptr<RunChannel> record;
    const experiment::TrialOptions recorded{
        .stop = stop, .record = [&](const algo::RobotSpec& robot) {
          if (!recording.recorder->takes_more()) {
            throw std::runtime_error("The run cannot be recorded. " +
                                     recording.recorder->status().sentence);
          }
          return record = recording.recorder->open(headless_run(trial.spec, robot, 0));
        }};
    const bool all = recording.recorder != nullptr && !recording.failures_only;
    Row row = run_trial(trial, all ? recorded : experiment::TrialOptions{.stop = stop});
    const bool failed = row.outcome != algo::Outcome::Reached && !stop.stop_requested();
    if (recording.recorder != nullptr && recording.failures_only && failed) {
      run_trial(trial, recorded);
    }
    while (recording.recorder != nullptr && !recording.recorder->flush() &&
           !stop.stop_requested()) {  // waits for a store that is locked, or without room
    }
    if (row.outcome != algo::Outcome::Stopped) check_record(record.get());
    row.track_W = experiment::coarse(row.track_W);
    return row;
  } catch (const std::exception& e) {
    return {.outcome = algo::Outcome::Failed, .reason = e.what(), .broken = true};
  }
}

Rows run_sweep(const Plan& plan,
               const fs::path& folder,
               const experiment::PoolOptions& options,
               Wanted wanted,
               const std::function<void(const std::string&)>& warn,
               const Recording& recording) {
  make_folder(folder);
  const std::unique_ptr<RunLog> log = open_log(plan, folder);
  write_scenarios(plan.document(), folder);
  Rows rows = log->found();
  const std::string other = log->other_arithmetic();
  if (warn && !other.empty()) warn(other);
  const std::set<std::size_t> lost = log->lost();
  std::vector<std::size_t> runs = runs_to_make(rows, wanted, lost, options.shard);
  const auto others = std::ranges::stable_partition(
      runs, [&](std::size_t i) { return lost.contains(i) || rows.killed_twice(i); });
  const std::size_t alone = runs.size() - others.size();
  for (const std::size_t i : runs) rows.erase(i);
  const bool finish = options.shard.count > 1;  // a shard finishes the runs under way after a stop
  const auto make = [&](std::size_t first, std::size_t count, unsigned threads) {
    experiment::PoolOptions pool{.threads = threads, .stop = options.stop};
    pool.progress = [&](std::size_t done, std::size_t) {
      if (options.progress) options.progress(first + done, runs.size());
    };
    for_each(count, pool, [&](std::size_t k, const std::stop_token& stop) {
      const std::size_t i = runs[first + k];
      log->begin(i);
      const Row row = run_one(plan, i, finish ? std::stop_token() : stop, recording);
      if (row.outcome == algo::Outcome::Stopped) return log->leave(i);
      log->append(i, row);
      rows.set(i, row);
    });
  };
  make(0, alone, 1);
  if (!options.stop.stop_requested()) make(alone, others.size(), options.threads);
  return rows;
}

}  // namespace server::sweep
