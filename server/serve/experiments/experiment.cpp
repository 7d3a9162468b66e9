// server/serve/experiments/experiment.cpp: the states of an experiment, and its files.
#include "server/serve/experiments/experiment.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "server/experiment/sweep/sweep_report.hpp"
#include "server/experiment/sweep/sweep_results.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/experiment/sweep/sweep_tables.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/paths.hpp"
#include "server/run/text_file.hpp"
#include "server/serve/net/http.hpp"

namespace server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view kStates[] = {
    "running", "paused", "interrupted", "cancelled", "finished"};
/// The report of a running experiment is at most this old.
constexpr std::chrono::seconds kReportAge{5};

ExperimentState state_named(const std::string& name) {
  const auto* const it = std::ranges::find(kStates, name);
  if (it == std::end(kStates)) throw std::runtime_error("no state is called " + name);
  return static_cast<ExperimentState>(it - std::begin(kStates));
}

ExperimentInfo info_from_json(const json& state) {
  ExperimentInfo info;
  state.at("id").get_to(info.id);
  state.at("name").get_to(info.name);
  state.at("by").get_to(info.by);
  state.at("key").get_to(info.key);
  state.at("created").get_to(info.created);
  state.at("problem").get_to(info.problem);
  info.state = state_named(state.at("state").get<std::string>());
  state.at("runs").get_to(info.runs);
  state.at("done").get_to(info.done);
  state.at("failed").get_to(info.failed);
  return info;
}

}  // namespace

std::string_view name(ExperimentState state) {
  return kStates[static_cast<std::size_t>(state)];
}

json to_json(const ExperimentInfo& info) {
  const bool going = info.rate > 0 && info.state == ExperimentState::Running;
  return {{"id", info.id},
          {"name", info.name},
          {"by", info.by},
          {"created", info.created},
          {"state", name(info.state)},
          {"problem", info.problem},
          {"runs", info.runs},
          {"done", info.done},
          {"failed", info.failed},
          {"rate", going ? json(info.rate) : json(nullptr)},
          {"time_left",
           going ? json(static_cast<double>(info.runs - info.done) / info.rate) : json(nullptr)}};
}

Experiment::Experiment(fs::path folder, sweep::Plan plan, ExperimentInfo info)
    : folder_(std::move(folder)),
      controllers_(plan.document().catalogue),
      info_(std::move(info)),
      plan_(std::make_shared<const sweep::Plan>(std::move(plan))) {
  make_folder(folder_);
  sweep::write_scenarios(plan_->document(), folder_);
  write_text(folder_ / "document.json", dump_json(plan_->document().source) + '\n');
  open_log();
  rows_ = log_->found();
  count();
  enter(ExperimentState::Running);
  write_state();  // throws where that did not
}

Experiment::Experiment(fs::path folder,
                       RobotLibrary robots,
                       std::shared_ptr<const algo::ControllerCatalogue> controllers)
    : folder_(std::move(folder)), robots_(std::move(robots)), controllers_(std::move(controllers)) {
  info_ = info_from_json(parse_json(read_text(folder_ / "state.json"), kOwnDocument));
  if (info_.state == ExperimentState::Running) info_.state = ExperimentState::Interrupted;
}

ExperimentInfo Experiment::info() const {
  const std::lock_guard lock(mutex_);
  ExperimentInfo info = info_;
  const std::chrono::duration<double> time = Clock::now() - began_;
  if (info.state == ExperimentState::Running && info.done > done_before_) {
    info.rate = static_cast<double>(info.done - done_before_) / time.count();
  }
  return info;
}

/// Reads the plan and the finished runs. The scenarios and robots are those of the folder: the
/// library's may be others by now.
void Experiment::load() {
  const std::lock_guard loading(loading_);
  {
    const std::lock_guard lock(mutex_);
    if (plan_) return;
  }
  std::shared_ptr<const sweep::Plan> plan;
  sweep::Rows rows;
  try {
    const json source = parse_json(read_text(folder_ / "document.json"), kOwnDocument);
    std::optional<sweep::Document> document = sweep::document_in(folder_, source, controllers_);
    if (!document) {  // begun before the order of the copies was kept
      const ScenarioLibrary library(folder_ / "scenarios", {}, robots_);
      document = sweep::document_from_json(source, library, controllers_);
    }
    plan = std::make_shared<const sweep::Plan>(std::move(*document));
    rows = sweep::open_log(*plan, folder_)->found();
  } catch (const std::exception& e) {
    throw net::HttpError(409, without_folders(e.what()));
  }
  const std::lock_guard lock(mutex_);
  plan_ = plan;
  rows_ = std::move(rows);
  ++changes_;
  count();
}

/// Holds mutex_ with plan and rows in memory: somebody may unload() them after a load().
std::unique_lock<std::mutex> Experiment::loaded() {
  while (true) {
    load();
    std::unique_lock lock(mutex_);
    if (plan_) return lock;
  }
}

/// Holds mutex_.
void Experiment::open_log() {
  log_ = sweep::open_log(*plan_, folder_);
  lost_ = log_->lost();
  const std::string other = log_->other_arithmetic();
  if (!other.empty()) spdlog::warn("{}", other);
}

/// Counts the finished runs and lists the missing ones. Holds mutex_.
void Experiment::count() {
  missing_ = sweep::runs_to_make(rows_);
  std::ranges::reverse(missing_);
  std::ranges::stable_partition(missing_, [&](std::size_t i) { return !lost_.contains(i); });
  info_.runs = rows_.size();
  info_.done = info_.failed = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    info_.done += rows_.has(i) ? 1U : 0U;
    info_.failed += rows_.has(i) && rows_.broken(i) ? 1U : 0U;
  }
}

/// Also if the state cannot be written: a run must be stopped on a full disk too. After a restart
/// it is then in its state before. Holds mutex_.
void Experiment::enter(ExperimentState state) {
  info_.state = state;
  if (state == ExperimentState::Running) {
    info_.problem.clear();
    began_ = Clock::now();
    done_before_ = info_.done;
  }
  try {
    write_state();
  } catch (const std::exception& e) {
    info_.problem = without_folders(e.what());
  }
}

void Experiment::write_state() const {
  json state = to_json(info_);
  state["key"] = info_.key;
  replace_text(folder_ / "state.json", dump_json(state) + '\n');
}

void Experiment::resume() {
  const std::unique_lock lock = loaded();
  if (info_.state == ExperimentState::Running) return;
  if (!log_) open_log();
  if (stop_.stop_requested()) stop_ = std::stop_source();
  if (at_work_ == 0) {
    for (const std::size_t i : sweep::runs_to_make(rows_)) rows_.erase(i);
    count();
  }
  enter(missing_.empty() && at_work_ == 0 ? ExperimentState::Finished : ExperimentState::Running);
  close_log_if_idle();
}

bool Experiment::pause() {
  const std::lock_guard lock(mutex_);
  if (info_.state != ExperimentState::Running) return false;
  enter(ExperimentState::Paused);
  close_log_if_idle();
  return true;
}

bool Experiment::cancel() {
  const std::lock_guard lock(mutex_);
  if (info_.state == ExperimentState::Finished || info_.state == ExperimentState::Cancelled) {
    return false;
  }
  enter(ExperimentState::Cancelled);
  stop_.request_stop();
  close_log_if_idle();
  return true;
}

std::optional<Experiment::Work> Experiment::next() {
  const std::lock_guard lock(mutex_);
  if (info_.state != ExperimentState::Running || missing_.empty()) return std::nullopt;
  const std::size_t run = missing_.back();
  try {
    log_->begin(run);
  } catch (const std::exception& e) {  // a full disk
    info_.state = ExperimentState::Paused;
    info_.problem = without_folders(e.what());
    close_log_if_idle();
    return std::nullopt;
  }
  missing_.pop_back();
  ++at_work_;
  return Work{plan_, run, stop_.get_token(), lost_.contains(run)};
}

bool Experiment::next_is_alone() const {
  const std::lock_guard lock(mutex_);
  return info_.state == ExperimentState::Running && !missing_.empty() &&
         lost_.contains(missing_.back());
}

void Experiment::take(std::size_t run, const experiment::Row& row) {
  const std::lock_guard lock(mutex_);
  --at_work_;
  try {
    log_->append(run, row);
    ++info_.done;
    if (row.broken) ++info_.failed;
    rows_.set(run, row);
    lost_.erase(run);
    ++changes_;
    if (missing_.empty() && at_work_ == 0) enter(ExperimentState::Finished);
  } catch (const std::exception& e) {
    // A full disk: nothing is lost that a later start does not make again.
    if (!rows_.has(run)) missing_.push_back(run);
    info_.state = ExperimentState::Paused;
    info_.problem = without_folders(e.what());
  }
  close_log_if_idle();
}

void Experiment::put_back(std::size_t run) {
  const std::lock_guard lock(mutex_);
  --at_work_;
  log_->leave(run);
  missing_.push_back(run);
  close_log_if_idle();
}

bool Experiment::at_work() const {
  const std::lock_guard lock(mutex_);
  return at_work_ > 0;
}

std::size_t Experiment::worlds() const {
  const std::lock_guard lock(mutex_);
  return plan_ ? plan_->document().scenarios.size() : 0;
}

/// Others may then open the file. Holds mutex_.
void Experiment::close_log_if_idle() {
  if (info_.state != ExperimentState::Running && at_work_ == 0) log_.reset();
}

std::shared_ptr<const sweep::Plan> Experiment::plan() {
  const std::unique_lock lock = loaded();
  return plan_;
}

void Experiment::look(
    const std::function<void(const sweep::Plan& plan, const sweep::Rows& rows)>& see) {
  const std::unique_lock lock = loaded();
  see(*plan_, rows_);
}

Experiment::Report Experiment::write_report() {
  const std::lock_guard reporting(reporting_);
  std::unique_lock now = loaded();
  const bool young = info_.state == ExperimentState::Running && reported_.has_value() &&
                     Clock::now() - reported_at_ < kReportAge;
  if (results_ && (reported_ == changes_ || young)) return {results_};
  const std::shared_ptr<const sweep::Plan> plan = plan_;
  const std::uint64_t changes = changes_;
  const sweep::Rows rows = rows_;
  now.unlock();
  const sweep::Results results = results_of(*plan, rows);
  auto document = std::make_shared<const json>(results_json(*plan, results));
  try {
    sweep::write_report(*plan, rows, results, folder_);
  } catch (const std::exception& e) {
    return {document, without_folders(e.what())};
  }
  const std::lock_guard lock(mutex_);
  reported_ = changes;
  reported_at_ = Clock::now();
  results_ = document;
  return {document};
}

void Experiment::unload() {
  const std::lock_guard lock(mutex_);
  if (info_.state == ExperimentState::Running || at_work_ > 0) return;
  plan_.reset();
  rows_ = {};
  missing_ = {};
  results_.reset();
}

}  // namespace server
