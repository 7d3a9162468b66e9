// server/serve/experiments/experiments.hpp: the experiments of the server, which take turns on a
// pool of their own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "server/experiment/pool.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/run/scenario_library.hpp"
#include "server/serve/experiments/experiment.hpp"

namespace server {

struct ExperimentRules {
  std::filesystem::path folder{};  // one folder in it per experiment; made at the first
  std::size_t most_kept = 200;
  std::uint64_t keep_bytes = 0;  // room for the files of all, beside the record; 0: the whole disk
  bool evict_oldest = false;     // ended ones may be deleted, each as a whole, to make room
  std::size_t most_running = 16;
  std::size_t most_worlds = 40'000;  // of all that run: some 4 kB of memory each
  unsigned workers = 0;              // 0: one per processor but one, which the server keeps
  /// As in RunSpec.
  std::shared_ptr<const algo::ControllerCatalogue> controllers{};
};

/// Experiments that run take turns, run by run: a short one need not wait for a long one. Their
/// runs are not in the record; record a single one by its spec. Any thread but the io thread: all
/// of it may wait for the disk.
class Experiments {
 public:
  Experiments(ExperimentRules rules, const ScenarioLibrary& library);
  /// Lets no run go on. Running experiments are `interrupted` at the next start.
  ~Experiments();
  Experiments(const Experiments&) = delete;
  Experiments& operator=(const Experiments&) = delete;

  struct Posted {
    std::shared_ptr<Experiment> experiment{};
    bool created = false;  // false: it was there, and goes on if it had been stopped
  };
  /// Checks the whole document and starts it. The same document is the same experiment. Throws
  /// DocumentError, or net::HttpError: 409 if `key` has another document, 503 if too many
  /// run or there is no room for another, or at `stop`, as the check may take a
  /// minute.
  Posted post(const nlohmann::json& document,
              const std::string& key,
              const std::string& by,
              const std::stop_token& stop = {});

  /// What the experiment of a document would cost, and its plan. Checks everything as post() does.
  /// One at a time: it takes some seconds of a core. Throws DocumentError, or net::HttpError 429.
  std::pair<sweep::Plan, sweep::Estimate> estimate(const nlohmann::json& document,
                                                   const std::stop_token& stop);

  /// The newest first.
  std::vector<ExperimentInfo> list() const;
  /// Throws net::HttpError 404.
  std::shared_ptr<Experiment> find(const std::string& id) const;

  /// Throws net::HttpError 404, 409 or 503.
  void resume(const std::string& id);
  void pause(const std::string& id);
  void cancel(const std::string& id);
  /// With its files; its runs at work are stopped.
  void remove(const std::string& id);

  /// Gives back the memory of those that are neither running nor among the last looked at.
  void looked_at(const std::shared_ptr<Experiment>& experiment);

 private:
  void read_folder();
  std::shared_ptr<Experiment> make(sweep::Plan plan, ExperimentInfo info) const;
  sweep::Document read(const nlohmann::json& document) const;
  void check_turns(std::size_t worlds) const;
  void make_room(std::uint64_t bytes);
  std::shared_ptr<Experiment> with_key(const std::string& key) const;
  struct Turn {
    std::shared_ptr<Experiment> experiment{};
    Experiment::Work work{};
  };
  std::optional<Turn> next_turn();
  experiment::Pool::Job take(const std::stop_token& stop);
  void work(const Turn& turn, const std::stop_token& stop);
  void ring();
  void drop(const std::string& id);
  void await_removed(const std::string& id);
  static void delete_files(const Experiment& experiment);

  const ExperimentRules rules_;
  const ScenarioLibrary& library_;
  std::mutex estimating_{};
  mutable std::mutex mutex_{};  // before those of the experiments
  std::condition_variable_any wake_{};
  std::map<std::string, std::shared_ptr<Experiment>> all_{};  // by id
  std::vector<std::shared_ptr<Experiment>> removed_{};        // a run is still at work
  std::vector<std::shared_ptr<Experiment>> looked_at_{};      // the last one last
  std::string last_{};                                        // id whose turn was last
  std::size_t at_work_ = 0;                                   // runs of all experiments
  bool alone_ = false;     // no run may begin beside the one at work
  experiment::Pool pool_;  // last: it uses all of the above
};

}  // namespace server
