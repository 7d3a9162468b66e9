// server/serve/experiments/experiment.hpp: one experiment of the server: its folder, its state and
// the runs that are left.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "server/experiment/sweep/run_log.hpp"
#include "server/experiment/sweep/sweep_plan.hpp"

namespace server {

enum class ExperimentState : std::uint8_t {
  Running,
  Paused,
  Interrupted,  // the server ended while it was running
  Cancelled,
  Finished,
};
/// "running", as REST spells it.
std::string_view name(ExperimentState state);

/// What a list of experiments shows.
struct ExperimentInfo {
  std::string id{};  // hash of document, scenarios and version: 16 hexadecimal digits
  std::string name{};
  std::string by{};       // the person who posted it; may be empty
  std::string key{};      // the request's Idempotency-Key; may be empty
  std::string created{};  // ISO 8601, UTC
  std::string problem{};  // why it does not go on, as a sentence
  ExperimentState state = ExperimentState::Running;
  std::size_t runs = 0;
  std::size_t done = 0;
  std::size_t failed = 0;  // of `done`: broken; made again when it is resumed
  double rate = 0;         // [runs/s] since it was last started; 0 while it does not run
};
nlohmann::json to_json(const ExperimentInfo& info);

/// The folder holds document.json, state.json and the files of the sweep. Any thread but the io
/// thread.
class Experiment {
 public:
  /// A new one, running; writes its folder. Throws std::runtime_error with a sentence.
  Experiment(std::filesystem::path folder, sweep::Plan plan, ExperimentInfo info);
  /// An earlier one, from its folder. Throws std::exception if that holds none.
  Experiment(std::filesystem::path folder,
             RobotLibrary robots,
             std::shared_ptr<const algo::ControllerCatalogue> controllers);

  ExperimentInfo info() const;
  const std::filesystem::path& folder() const { return folder_; }

  /// Makes the missing runs and those that failed. Throws net::HttpError 409 if its files belong to
  /// another version, or cannot be read.
  void resume();
  /// Begins no further runs; those at work end. False if it does not run.
  bool pause();
  /// As pause(), but stops those at work, which a later resume() makes again. False if it has
  /// ended.
  bool cancel();

  /// A run to be made, which the caller then gives to take() or put_back().
  struct Work {
    std::shared_ptr<const sweep::Plan> plan{};
    std::size_t run = 0;
    std::stop_token stop{};  // of a cancel()
    bool alone = false;      // it may have killed the program: no other run may be under way
  };
  /// next() would give a run that must be alone.
  bool next_is_alone() const;
  std::optional<Work> next();
  void take(std::size_t run, const experiment::Row& row);
  void put_back(std::size_t run);
  bool at_work() const;
  /// Of its plan, while that is in memory.
  std::size_t worlds() const;

  /// The plan and the rows so far, read from the folder if need be. Throws as resume().
  std::shared_ptr<const sweep::Plan> plan();
  /// Shows the rows so far, which do not change meanwhile: `see` must be quick.
  void look(const std::function<void(const sweep::Plan& plan, const sweep::Rows& rows)>& see);
  struct Report {
    std::shared_ptr<const nlohmann::json> results{};  // results.json
    std::string problem{};  // why the files cannot be written, such as on a full disk; or empty
  };
  /// Writes the report of the runs so far, unless it is new enough. Throws as resume().
  Report write_report();
  /// Gives the memory of plan and rows back while it does not run.
  void unload();

 private:
  using Clock = std::chrono::steady_clock;
  void load();
  std::unique_lock<std::mutex> loaded();
  void open_log();
  void count();
  void enter(ExperimentState state);
  void write_state() const;
  void close_log_if_idle();

  const std::filesystem::path folder_;
  const RobotLibrary robots_;
  const std::shared_ptr<const algo::ControllerCatalogue> controllers_;
  std::mutex loading_{};  // before mutex_
  std::mutex reporting_{};
  mutable std::mutex mutex_{};  // guards all below
  ExperimentInfo info_{};
  std::shared_ptr<const sweep::Plan> plan_{};
  sweep::Rows rows_{};
  std::unique_ptr<sweep::RunLog> log_{};  // open while it runs
  std::vector<std::size_t> missing_{};    // runs to be made, the last one first
  std::set<std::size_t> lost_{};          // of these, as RunLog has them; at the end of missing_
  std::size_t at_work_ = 0;
  std::stop_source stop_{};                  // of the runs at work
  Clock::time_point began_{};                // when it was last started,
  std::size_t done_before_ = 0;              // and the runs done by then
  std::uint64_t changes_ = 0;                // of rows_
  std::optional<std::uint64_t> reported_{};  // changes_, when the report was written
  Clock::time_point reported_at_{};
  std::shared_ptr<const nlohmann::json> results_{};  // results.json
};

}  // namespace server
