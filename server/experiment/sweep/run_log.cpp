// server/experiment/sweep/run_log.cpp: reads the file back, and appends to it.
#include "server/experiment/sweep/run_log.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "db/network_disk.hpp"
#include "db/sqlite.hpp"
#include "server/experiment/arithmetic.hpp"
#include "server/experiment/sweep/sweep_plan.hpp"
#include "server/run/json_limits.hpp"

namespace server::sweep {
namespace {

namespace fs = std::filesystem;
using experiment::Row;
using nlohmann::json;

constexpr algo::Outcome kLoggedOutcomes[] = {algo::Outcome::Reached,
                                             algo::Outcome::Stuck,
                                             algo::Outcome::OutOfTime,
                                             algo::Outcome::Collided,
                                             algo::Outcome::Failed,
                                             algo::Outcome::Overturned,
                                             algo::Outcome::Fallen};

algo::Outcome outcome_named(const std::string& name) {
  for (const algo::Outcome outcome : kLoggedOutcomes) {
    if (algo::name(outcome) == name) return outcome;
  }
  throw std::runtime_error("no outcome is called " + name);
}

/// [x, y, x, y ...] in centimetres.
json track_json(const std::vector<algo::Vec2>& track_W) {
  json track = json::array();
  for (const algo::Vec2& p_W : track_W) {
    track.push_back(std::llround(100 * p_W.x()));
    track.push_back(std::llround(100 * p_W.y()));
  }
  return track;
}

std::vector<algo::Vec2> track_from_json(const json& track) {
  std::vector<algo::Vec2> track_W;
  for (std::size_t i = 0; i + 1 < track.size(); i += 2) {
    track_W.emplace_back(track[i].get<double>() / 100, track[i + 1].get<double>() / 100);
  }
  return track_W;
}

Row row_from_json(const json& line) {
  Row row{.outcome = outcome_named(line.at("outcome").get<std::string>()),
          .reason = line.at("reason").get<std::string>(),
          .broken = line.at("broken").get<bool>()};
  for (const auto& figure : line.at("figures")) {
    const experiment::Column* const column =
        experiment::find_column(figure.at(0).get<std::string>());
    if (column == nullptr) throw std::runtime_error("no judge has this figure");
    const json& value = figure.at(1);
    row.figures.emplace_back(column->name, value.is_null() ? std::nan("") : value.get<double>());
  }
  if (line.contains("track")) row.track_W = track_from_json(line["track"]);
  return row;
}

std::string short_text(const json& value) {
  const std::string text = dump_json(value);
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

json head_of(const json& identity) {
  return {{"sweep", hash_of(identity)}, {"identity", identity}};
}

/// The first line of a log. Throws std::runtime_error if it is none.
json head_from(std::string_view line, const fs::path& file) {
  json head = json::parse(line, nullptr, false);
  if (!head.is_object() || !head.contains("sweep") || !head.contains("identity")) {
    throw std::runtime_error(file.string() + ": is no file of finished runs of a sweep");
  }
  return head;
}

db::FileLock locked(const fs::path& file) {
  if (const auto refusal = db::refusal_on_network(file.string())) {
    throw std::runtime_error(*refusal);
  }
  try {
    return db::FileLock(file.string());
  } catch (const db::DatabaseError&) {
    throw std::runtime_error(
        file.string() +
        ": cannot be locked: another sweep writes there, or the folder may not be "
        "written");
  }
}

}  // namespace

json logged_identity(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string line;  // of a file that may have 100 MB
  if (!std::getline(in, line) && !in.eof()) {
    throw std::runtime_error(file.string() + ": cannot be read");
  }
  return head_from(line, file)["identity"];
}

json logged_document(const fs::path& file) {
  const json identity = logged_identity(file);
  if (!identity.is_object() || !identity.contains("document")) {
    throw std::runtime_error(file.string() + ": its first line has no document");
  }
  return identity["document"];
}

json row_json(std::size_t run, const Row& row) {
  json figures = json::array();
  for (const auto& [column, value] : row.figures) {
    figures.push_back({column, std::isfinite(value) ? json(value) : json(nullptr)});
  }
  json line = {{"run", run},
               {"outcome", algo::name(row.outcome)},
               {"reason", row.reason},
               {"broken", row.broken},
               {"figures", std::move(figures)}};
  if (!row.track_W.empty()) line["track"] = track_json(row.track_W);
  return line;
}

std::string difference(const json& theirs, const json& ours) {
  const json patch = json::diff(theirs, ours);
  if (patch.empty()) return "nothing differs";
  const json::json_pointer at(patch[0].at("path").get<std::string>());
  const std::string path = at.to_string().substr(1);
  constexpr std::string_view kScenarios = "scenarios/";
  constexpr std::string_view kDocument = "document/";
  if (path.starts_with(kScenarios)) {
    return fmt::format("the scenario '{}' is another", path.substr(kScenarios.size()));
  }
  if (path.starts_with("figures")) return "its runs have other figures";
  const std::string field =
      path.starts_with(kDocument) ? path.substr(kDocument.size()) : path + " (the version)";
  if (!ours.contains(at))
    return fmt::format("{} is {} there and not here", field, short_text(theirs.at(at)));
  if (!theirs.contains(at))
    return fmt::format("{} is {} here and not there", field, short_text(ours.at(at)));
  return fmt::format(
      "{} is {} there and {} here", field, short_text(theirs.at(at)), short_text(ours.at(at)));
}

RunLog::RunLog(const fs::path& file, const json& identity, std::size_t plan_size)
    : file_(file), lock_(locked(file)), found_(plan_size) {
  const std::size_t whole = read(identity);
  for (const auto& [run, times] : deaths_) {
    if (times >= 2) found_.set_killed_twice(run);
  }
  fs::resize_file(file_, whole);  // drops a torn line
  out_.open(file_, std::ios::binary | std::ios::app);
  if (whole == 0) write_line(head_of(identity));
}

/// Reads all whole lines, one at a time, and returns their length in bytes.
std::size_t RunLog::read(const json& identity) {
  std::ifstream in(file_, std::ios::binary);
  const auto check = [&](bool good) {  // what cannot be read must not be cut off
    if (!good) throw std::runtime_error(file_.string() + ": cannot be read");
  };
  check(in.is_open());
  std::string line;
  const auto next = [&] { return std::getline(in, line) && !in.eof(); };  // false for a torn line
  // New, or killed before the first line was whole.
  const bool begun = next();
  check(!in.bad());
  if (!begun && dump_json(head_of(identity)).starts_with(line)) return 0;
  check_head(line, identity);
  std::size_t whole = line.size() + 1;
  for (std::size_t number = 2; next(); ++number) {
    try {
      read_line(line);
    } catch (const std::exception& e) {
      if (in.peek() == std::ifstream::traits_type::eof()) break;  // torn by a crash of the machine
      throw std::runtime_error(
          fmt::format("{}: line {} is damaged: {}", file_.string(), number, e.what()));
    }
    whole += line.size() + 1;
  }
  check(!in.bad());
  return whole;
}

void RunLog::check_head(std::string_view line, const json& identity) const {
  const json head = head_from(line, file_);
  if (head["sweep"] == hash_of(identity)) return;
  throw OtherExperiment(fmt::format("{}: holds the runs of another experiment: {}.",
                                    file_.string(),
                                    difference(head["identity"], identity)));
}

void RunLog::read_line(std::string_view line) {
  const json read = parse_json(line, kOwnDocument);
  if (read.contains("begun")) {
    ++deaths_[checked(read["begun"].get<std::size_t>())];
  } else if (read.contains("left")) {
    const auto begun = deaths_.find(read["left"].get<std::size_t>());
    if (begun == deaths_.end()) throw std::runtime_error("a run was stopped that had not begun");
    if (--begun->second == 0) deaths_.erase(begun);
  } else if (read.contains("arithmetic")) {
    last_arithmetic_ = read["arithmetic"].get<std::string>();
    arithmetics_.insert(last_arithmetic_);
  } else {
    const std::size_t run = checked(read.at("run").get<std::size_t>());
    found_.set(run, row_from_json(read));
    deaths_.erase(run);
  }
}

std::size_t RunLog::checked(std::size_t run) const {
  if (run < found_.size()) return run;
  throw std::runtime_error(fmt::format("the experiment has no run {}", run));
}

RunLog::~RunLog() {
  while (!under_way_.empty()) leave(*under_way_.begin());
}

std::set<std::size_t> RunLog::lost() const {
  std::set<std::size_t> runs;
  for (const auto& [run, times] : deaths_) {
    if (times == 1) runs.insert(run);
  }
  return runs;
}

std::string RunLog::other_arithmetic() const {
  const bool other = std::ranges::any_of(
      arithmetics_, [](const std::string& each) { return each != experiment::arithmetic(); });
  if (!other) return {};
  return fmt::format(
      "{}: some of its runs were made on a machine with another mathematical library: the same run "
      "may end otherwise here. For results that repeat bit by bit, make all runs on one machine.",
      file_.string());
}

void RunLog::begin(std::size_t run) {
  const std::lock_guard lock(mutex_);
  if (!begun_ && last_arithmetic_ != experiment::arithmetic()) {
    write_line({{"arithmetic", experiment::arithmetic()}});
  }
  begun_ = true;
  if (under_way_.insert(run).second) write_line({{"begun", run}});
}

void RunLog::append(std::size_t run, const Row& row) {
  const std::lock_guard lock(mutex_);
  write_line(row_json(run, row));
  under_way_.erase(run);
}

void RunLog::leave(std::size_t run) noexcept {
  const std::lock_guard lock(mutex_);
  if (under_way_.erase(run) == 0) return;
  try {
    write_line({{"left", run}});
  } catch (const std::exception&) {  // a full disk: the run is made alone, which does no harm
    return;
  }
}

void RunLog::write_line(const json& line) {
  out_ << dump_json(line) + '\n';
  if (!out_.flush()) {
    throw std::runtime_error(file_.string() + ": cannot be written; is the disk full?");
  }
}

}  // namespace server::sweep
