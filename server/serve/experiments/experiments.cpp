// server/serve/experiments/experiments.cpp: the list of experiments, and their turns.
#include "server/serve/experiments/experiments.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "server/experiment/sweep/scenario_entries.hpp"
#include "server/record/run_json.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/paths.hpp"
#include "server/serve/net/http.hpp"
#include "server/serve/workers.hpp"

namespace server {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kRemoval{5};  // a run is stopped between two ticks
constexpr double kMostWorlds = 10'000;       // of a document: each is a file
constexpr std::size_t kMostLoaded = 3;  // experiments that do not run, with plan and rows in memory

unsigned workers_of(unsigned wanted) {
  if (wanted > 0) return wanted;
  return std::max(2U, std::thread::hardware_concurrency()) - 1;
}

/// Of all files below `folder`.
std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t sum = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; it != end; it.increment(error)) {
    std::error_code gone;  // it may be deleted meanwhile
    const std::uint64_t size = it->is_regular_file(gone) ? it->file_size(gone) : 0;
    if (!gone) sum += size;
  }
  return sum;
}

[[noreturn]] void not_found(const std::string& id) {
  throw net::HttpError(404, fmt::format("There is no experiment '{}'.", id));
}

}  // namespace

Experiments::Experiments(ExperimentRules rules, const ScenarioLibrary& library)
    : rules_(std::move(rules)),
      library_(library),
      pool_((read_folder(), workers_of(rules_.workers)),
            [this](const std::stop_token& stop) { return take(stop); }) {}

Experiments::~Experiments() {
  pool_.request_stop();
}

void Experiments::read_folder() {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(rules_.folder, error)) {
    if (!entry.is_directory(error)) continue;
    try {
      all_[entry.path().filename().string()] =
          std::make_shared<Experiment>(entry.path(), library_.robots(), rules_.controllers);
    } catch (const std::exception& e) {
      spdlog::warn("The experiment in {} cannot be read: {}", entry.path().string(), e.what());
    }
  }
}

/// Whether another one may run, of so many worlds. Holds mutex_.
void Experiments::check_turns(std::size_t worlds) const {
  std::size_t running = 0;
  for (const auto& [id, each] : all_) {
    if (each->info().state != ExperimentState::Running) continue;
    ++running;
    worlds += each->worlds();
  }
  if (running >= rules_.most_running) {
    throw net::HttpError(
        503, fmt::format("{} experiments are running, as many as may. Try again later.", running));
  }
  if (worlds > rules_.most_worlds) {
    throw net::HttpError(
        503,
        fmt::format("With this one the running experiments would have {} worlds; at most {} are "
                    "allowed. Try again later.",
                    worlds,
                    rules_.most_worlds));
  }
}

/// Deletes the oldest that have ended, if it may and must. `bytes`: of the files of all, counted
/// without the lock, since that visits every file. Holds mutex_.
void Experiments::make_room(std::uint64_t bytes) {
  const auto full = [&]() -> std::string {
    if (all_.size() >= rules_.most_kept) {
      return fmt::format("{} experiments are kept, as many as may.", all_.size());
    }
    if (rules_.keep_bytes == 0 || bytes < rules_.keep_bytes) return {};
    return fmt::format("The experiments take the {:.3g} GB that --keep gives them.",
                       static_cast<double>(rules_.keep_bytes) / (1 << 30));
  };
  for (std::string reason = full(); !reason.empty(); reason = full()) {
    std::shared_ptr<Experiment> oldest;
    for (const auto& [id, each] : all_) {
      const ExperimentState state = each->info().state;
      const bool ended = state == ExperimentState::Finished || state == ExperimentState::Cancelled;
      if (ended && (!oldest || each->info().created < oldest->info().created)) oldest = each;
    }
    if (!rules_.evict_oldest || !oldest) throw net::HttpError(503, reason + " Delete one.");
    spdlog::info("{} The oldest that has ended is deleted: {}.", reason, oldest->info().name);
    bytes -= std::min(bytes, bytes_in(oldest->folder()));
    drop(oldest->info().id);
  }
}

/// Null without one. Holds mutex_.
std::shared_ptr<Experiment> Experiments::with_key(const std::string& key) const {
  if (key.empty()) return nullptr;
  const auto it =
      std::ranges::find_if(all_, [&](const auto& e) { return e.second->info().key == key; });
  return it == all_.end() ? nullptr : it->second;
}

/// Leaves no folder without an experiment. Holds mutex_.
std::shared_ptr<Experiment> Experiments::make(sweep::Plan plan, ExperimentInfo info) const {
  const fs::path folder = rules_.folder / info.id;
  std::error_code error;
  const bool was_there = fs::exists(folder, error);
  try {
    return std::make_shared<Experiment>(folder, std::move(plan), std::move(info));
  } catch (const std::exception& e) {
    if (!was_there) fs::remove_all(folder, error);
    throw net::HttpError(503, without_folders(e.what()));
  }
}

/// Refuses more worlds than it may have before it makes any.
sweep::Document Experiments::read(const nlohmann::json& document) const {
  const JsonReader in(document, "");
  const double worlds = sweep::count_scenarios(in, sweep::Files::Refused);
  if (worlds > kMostWorlds) {
    in.fail("scenarios",
            fmt::format("are {:.0f}; a server takes at most {:.0f}, `tautline sweep` takes more",
                        worlds,
                        kMostWorlds));
  }
  return sweep::document_from_json(document, library_, rules_.controllers);
}

Experiments::Posted Experiments::post(const nlohmann::json& document,
                                      const std::string& key,
                                      const std::string& by,
                                      const std::stop_token& stop) {
  sweep::Plan plan(read(document));
  plan.check(stop);
  if (stop.stop_requested()) throw net::HttpError(503, "The server is stopping.");
  ExperimentInfo info{.id = sweep::hash_of(sweep::identity_of(plan.document())),
                      .name = plan.document().name,
                      .by = by,
                      .key = key,
                      .created = wall_time()};
  Posted posted;
  await_removed(info.id);
  const std::uint64_t bytes = rules_.keep_bytes > 0 ? bytes_in(rules_.folder) : 0;
  {
    const std::lock_guard lock(mutex_);
    const std::shared_ptr<Experiment> same_key = with_key(key);
    if (same_key && same_key->info().id != info.id) {
      throw net::HttpError(
          409, "Idempotency-Key: an experiment with another document has this key already.");
    }
    const auto it = all_.find(info.id);
    if (it != all_.end()) {
      posted.experiment = it->second;
    } else {
      check_turns(plan.document().scenarios.size());
      make_room(bytes);
      posted.experiment = make(std::move(plan), std::move(info));
      posted.created = true;
      all_[posted.experiment->info().id] = posted.experiment;
    }
  }
  if (!posted.created) resume(posted.experiment->info().id);
  ring();
  return posted;
}

std::pair<sweep::Plan, sweep::Estimate> Experiments::estimate(const nlohmann::json& document,
                                                              const std::stop_token& stop) {
  const std::unique_lock alone(estimating_, std::try_to_lock);
  if (!alone) {
    throw net::HttpError(429, "Another estimate is being made. Try again in some seconds.");
  }
  sweep::Plan plan(read(document));
  plan.check(stop);
  const sweep::Estimate cost = sweep::estimate(plan, {.stop = stop});
  return {std::move(plan), cost};
}

std::vector<ExperimentInfo> Experiments::list() const {
  std::vector<ExperimentInfo> list;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, experiment] : all_) list.push_back(experiment->info());
  }
  std::ranges::sort(list, [](const ExperimentInfo& a, const ExperimentInfo& b) {
    return std::tie(a.created, a.id) > std::tie(b.created, b.id);
  });
  return list;
}

std::shared_ptr<Experiment> Experiments::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto it = all_.find(id);
  if (it == all_.end()) not_found(id);
  return it->second;
}

void Experiments::resume(const std::string& id) {
  const std::shared_ptr<Experiment> experiment = find(id);
  if (experiment->info().state == ExperimentState::Running) return;
  const std::size_t worlds = experiment->plan()->document().scenarios.size();
  {
    const std::lock_guard lock(mutex_);
    check_turns(worlds);
  }
  experiment->resume();
  ring();
}

void Experiments::pause(const std::string& id) {
  if (!find(id)->pause()) throw net::HttpError(409, "The experiment is not running.");
}

void Experiments::cancel(const std::string& id) {
  if (!find(id)->cancel()) throw net::HttpError(409, "The experiment has ended already.");
}

/// The stopped runs of a deleted experiment still hold its files.
void Experiments::await_removed(const std::string& id) {
  std::unique_lock lock(mutex_);
  const bool gone = wake_.wait_for(lock, kRemoval, [&] {
    return std::ranges::none_of(removed_, [&](const auto& each) { return each->info().id == id; });
  });
  if (gone) return;
  throw net::HttpError(
      503, "The experiment was deleted, and its last run is still being stopped. Try again later.");
}

void Experiments::remove(const std::string& id) {
  const std::lock_guard lock(mutex_);
  drop(id);
}

/// Holds mutex_.
void Experiments::drop(const std::string& id) {
  const auto found = all_.find(id);
  if (found == all_.end()) not_found(id);
  const std::shared_ptr<Experiment> experiment = std::move(found->second);
  all_.erase(found);
  experiment->cancel();
  std::erase(looked_at_, experiment);
  if (experiment->at_work()) {
    removed_.push_back(experiment);
  } else {
    delete_files(*experiment);
  }
}

void Experiments::delete_files(const Experiment& experiment) {
  std::error_code error;
  fs::remove_all(experiment.folder(), error);
  if (error) {
    spdlog::warn("{} cannot be deleted: {}", experiment.folder().string(), error.message());
  }
}

void Experiments::looked_at(const std::shared_ptr<Experiment>& experiment) {
  const std::lock_guard lock(mutex_);
  std::erase(looked_at_, experiment);
  looked_at_.push_back(experiment);
  if (looked_at_.size() <= kMostLoaded) return;
  looked_at_.front()->unload();
  looked_at_.erase(looked_at_.begin());
}

/// The next run of the experiment whose turn it is; nothing if none has one. Holds mutex_.
std::optional<Experiments::Turn> Experiments::next_turn() {
  if (alone_) return std::nullopt;
  auto it = all_.upper_bound(last_);
  for (std::size_t looked = 0; looked < all_.size(); ++looked, ++it) {
    if (it == all_.end()) it = all_.begin();
    if (at_work_ > 0 && it->second->next_is_alone()) return std::nullopt;  // those end first
    if (const std::optional<Experiment::Work> work = it->second->next()) {
      last_ = it->first;
      ++at_work_;
      alone_ = work->alone;
      return Turn{it->second, *work};
    }
  }
  return std::nullopt;
}

experiment::Pool::Job Experiments::take(const std::stop_token& stop) {
  give_way();
  std::unique_lock lock(mutex_);
  std::optional<Turn> turn;
  wake_.wait(lock, stop, [&] {
    turn = next_turn();
    return turn.has_value();
  });
  if (!turn) return {};
  return [this, turn = *turn, stop] { work(turn, stop); };
}

/// Something has been started.
void Experiments::ring() {
  { const std::lock_guard lock(mutex_); }  // no worker is between its look and its wait
  wake_.notify_all();
}

void Experiments::work(const Turn& turn, const std::stop_token& stop) {
  const auto& [experiment, work] = turn;
  std::stop_source over;  // by the end of the server, or of the experiment
  const auto end = [&] { over.request_stop(); };
  const std::stop_callback by_server(stop, end);
  const std::stop_callback by_person(work.stop, end);
  const experiment::Row row = sweep::run_one(*work.plan, work.run, over.get_token());
  if (row.outcome == algo::Outcome::Stopped) {
    experiment->put_back(work.run);
  } else {
    experiment->take(work.run, row);
  }
  const std::lock_guard lock(mutex_);
  --at_work_;
  if (alone_) wake_.notify_all();
  alone_ = false;
  if (experiment->at_work() || std::ranges::count(removed_, experiment) == 0) return;
  delete_files(*experiment);
  std::erase(removed_, experiment);
  wake_.notify_all();
}

}  // namespace server
