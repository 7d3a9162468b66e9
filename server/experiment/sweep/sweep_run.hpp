// server/experiment/sweep/sweep_run.hpp: runs an experiment, or the part of it that is missing, and
// estimates its cost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "server/experiment/pool.hpp"
#include "server/experiment/sweep/run_log.hpp"
#include "server/experiment/sweep/sweep_plan.hpp"
#include "server/record/recorder.hpp"

namespace server::sweep {

/// Writes each scenario to `folder`, with its robot and its map, and their order: `tautline run`
/// can repeat a run from there, and document_in() reads them. Throws std::runtime_error with a
/// sentence.
void write_scenarios(const Document& document, const std::filesystem::path& folder);
/// The experiment `source` with the scenarios that write_scenarios() left in `folder`, whatever has
/// become of the scenarios and robots that it names. Nothing if they or their order are missing.
/// Throws std::runtime_error with a sentence.
std::optional<Document> document_in(
    const std::filesystem::path& folder,
    const nlohmann::json& source,
    std::shared_ptr<const algo::ControllerCatalogue> controllers = {});
/// The finished runs of `plan` in `folder`. Throws as RunLog's constructor.
std::unique_ptr<RunLog> open_log(const Plan& plan, const std::filesystem::path& folder);
/// Which runs a sweep makes.
enum class Wanted : std::uint8_t {
  Missing,  // and those that broke, but not those that killed the program twice
  Failed,   // only those that broke, and those that killed the program twice
  Lost,     // only those that were under way when the program died the last time
};
/// The numbers of the runs of `shard` to be made, those that `wanted` names. `lost`: as RunLog has
/// them.
std::vector<std::size_t> runs_to_make(const Rows& rows,
                                      Wanted wanted = Wanted::Missing,
                                      const std::set<std::size_t>& lost = {},
                                      const experiment::Shard& shard = {});
/// Where whole runs are stored, with every tick; nowhere without a recorder.
struct Recording {
  Recorder* recorder = nullptr;
  bool failures_only = false;  // those that do not reach; each is made once more with its record
};
/// The row of a run: Failed with the reason if it breaks or its record is incomplete, Stopped after
/// a stop. Its record is stored when this returns.
experiment::Row run_one(const Plan& plan,
                        std::size_t i,
                        const std::stop_token& stop,
                        const Recording& recording = {});

/// Writes the scenarios to `folder`, then makes the runs that are `wanted`: first, one by one,
/// those that may have killed the program, then the others. Returns all runs by number; after a
/// stop, some are missing. A run that breaks is kept as failed with its reason and the others go
/// on. The result does not depend on the number of threads. `options.progress` counts the runs to
/// be made. A shard makes only its own runs, and after a stop it finishes those under way. `warn`
/// gets a sentence if the log has runs of another machine that may differ from this one's. Throws
/// std::runtime_error with a sentence.
Rows run_sweep(const Plan& plan,
               const std::filesystem::path& folder,
               const experiment::PoolOptions& options,
               Wanted wanted = Wanted::Missing,
               const std::function<void(const std::string&)>& warn = {},
               const Recording& recording = {});

struct Estimate {
  double cpu_time = 0;  // [s] if every run lasts until its time limit
  double bytes = 0;     // of the files
  /// True if the time for measuring was over before each controller had driven its seconds: what is
  /// missing is taken from those that had.
  bool extrapolated = false;
};
struct EstimateOptions {
  /// [s] wall time for the runs that are measured; a world under construction is finished.
  double most_time = 10;
  std::stop_token stop{};  // ends it at once; the sums are then too small
};
/// Measured by the first seconds of one run of each controller, in its first scenario, whatever
/// its labels and parameters.
Estimate estimate(const Plan& plan, const EstimateOptions& options = {});

}  // namespace server::sweep
