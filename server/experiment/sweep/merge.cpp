// server/experiment/sweep/merge.cpp: checks each shard, then appends what is new.
#include "server/experiment/sweep/merge.hpp"

#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "server/experiment/sweep/origin.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/text_file.hpp"

namespace server::sweep {
namespace {

namespace fs = std::filesystem;
using experiment::Row;

/// A copy of a file for as long as it is read: opening a log cuts a torn line off.
class Copy {
 public:
  Copy(const fs::path& from, const fs::path& folder) : file_(folder / ".merging.jsonl") {
    std::error_code error;
    fs::copy_file(from, file_, fs::copy_options::overwrite_existing, error);
    if (error) {
      throw std::runtime_error(fmt::format(
          "{}: cannot be copied to {}: {}", from.string(), folder.string(), error.message()));
    }
  }
  ~Copy() {
    std::error_code ignored;
    fs::remove(file_, ignored);
  }
  Copy(const Copy&) = delete;
  Copy& operator=(const Copy&) = delete;
  const fs::path& file() const { return file_; }

 private:
  fs::path file_;
};

void check_same(const fs::path& log, const nlohmann::json& identity) {
  const nlohmann::json theirs = logged_identity(log);
  if (theirs == identity) return;
  throw std::runtime_error(fmt::format("{}: its runs cannot be merged with the others: {}",
                                       log.string(),
                                       difference(theirs, identity)));
}

bool same(std::size_t run, const Row& a, const Row& b) {
  return dump_json(row_json(run, a)) == dump_json(row_json(run, b));
}

/// Adds the rows of one shard. Returns how many runs stand in both and differ.
std::size_t fold(const Rows& shard, RunLog& log, Merged& merged) {
  Rows& own = merged.rows;
  std::size_t contradictions = 0;
  for (std::size_t i = 0; i < shard.size(); ++i) {
    if (!shard.has(i)) continue;
    const bool broken = shard.broken(i);
    if (own.has(i) && (!own.broken(i) || broken)) {
      if (!own.broken(i) && !broken && !same(i, own.row(i), shard.row(i))) ++contradictions;
      continue;
    }
    log.append(i, shard.row(i));
    own.set(i, shard.row(i));
    ++merged.added;
  }
  return contradictions;
}

}  // namespace

Rows rows_in(const Plan& plan, const fs::path& folder, const fs::path& scratch) {
  const fs::path log = folder / "runs.jsonl";
  const nlohmann::json identity = identity_of(plan.document());
  check_same(log, identity);
  const Copy copy(log, scratch);
  return RunLog(copy.file(), identity, plan.size()).found();
}

Merged merge_shards(const Plan& plan, const fs::path& out, const std::vector<fs::path>& shards) {
  for (const fs::path& shard : shards) {  // all, before anything is written
    check_same(shard / "runs.jsonl", identity_of(plan.document()));
  }
  check_is_whole(out);
  make_folder(out);
  if (fs::exists(out / "runs.jsonl")) check_same(out / "runs.jsonl", identity_of(plan.document()));
  const std::unique_ptr<RunLog> log = open_log(plan, out);
  Merged merged{.rows = log->found()};
  Origin origin = read_origin(out).value_or(Origin{});
  for (const fs::path& shard : shards) {
    const std::size_t contradictions = fold(rows_in(plan, shard, out), *log, merged);
    add_machines(origin, read_origin(shard).value_or(Origin{}).machines);
    if (contradictions > 0) {
      merged.warnings.push_back(
          fmt::format("{}: {} runs differ from the same runs merged before, which stay.",
                      shard.string(),
                      contradictions));
    }
  }
  write_origin(origin, out);
  if (std::string mixed = mixed_machines_text(origin); !mixed.empty()) {
    merged.warnings.push_back(std::move(mixed));
  }
  return merged;
}

}  // namespace server::sweep
