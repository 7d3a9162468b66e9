// server/experiment/sweep/run_log.hpp: the finished runs of an experiment in a file that only
// grows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "db/file_lock.hpp"
#include "server/experiment/sweep/rows.hpp"

namespace server::sweep {

/// A file holds the runs of another document, or of another version of the program.
class OtherExperiment : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Lines of JSON: first the identity of the experiment and its hash, then one for each run that
/// begins, {"begun": 7}, and one for its end: its row, or {"left": 7} if it was stopped. A run that
/// begins and has no end was under way when the program died. A killed program leaves at most one
/// torn line, the last, which the next opening drops. Before the first run of a machine with
/// another mathematical library there is a line with its fingerprint. The lock keeps other
/// processes out.
class RunLog {
 public:
  /// Opens or begins `file` for the runs of `plan_size`. Throws OtherExperiment, or
  /// std::runtime_error with a sentence if the file is damaged or cannot be written.
  RunLog(const std::filesystem::path& file, const nlohmann::json& identity, std::size_t plan_size);

  /// Notes that the runs under way were stopped.
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  /// The runs found in the file; of a run that stands twice, the last. One that was under way at
  /// two deaths of the program has failed.
  const Rows& found() const { return found_; }
  /// The runs that were under way at the program's last death, and not at an earlier one. One of
  /// them may have been its cause: each is to be made again with no other run beside it.
  std::set<std::size_t> lost() const;
  /// A sentence if runs were made with another mathematical library than this machine's, which may
  /// give other results; else empty.
  std::string other_arithmetic() const;

  /// Notes that a run is under way; append() or leave() ends it. Written through to the file. Any
  /// thread, as the two below. Throws std::runtime_error if the file cannot be written.
  void begin(std::size_t run);
  /// Writes one run through to the file.
  void append(std::size_t run, const experiment::Row& row);
  /// Notes that a run was stopped. If that cannot be written, the next opening takes it as lost.
  void leave(std::size_t run) noexcept;

 private:
  std::size_t read(const nlohmann::json& identity);
  void check_head(std::string_view line, const nlohmann::json& identity) const;
  void read_line(std::string_view line);
  std::size_t checked(std::size_t run) const;
  void write_line(const nlohmann::json& line);

  std::filesystem::path file_;
  db::FileLock lock_;
  Rows found_;
  std::map<std::size_t, std::size_t> deaths_{};  // found: how often a run began without an end
  std::set<std::string> arithmetics_{};          // found: the fingerprints of the machines
  std::string last_arithmetic_{};                // found: of the last of them
  std::mutex mutex_{};                           // guards all below
  bool begun_ = false;                           // a run, since the opening
  std::set<std::size_t> under_way_{};
  std::ofstream out_{};
};

/// The identity of the experiment in the first line of a log. Throws std::runtime_error with a
/// sentence.
nlohmann::json logged_identity(const std::filesystem::path& file);
/// The document in the first line of a log. Throws std::runtime_error with a sentence.
nlohmann::json logged_document(const std::filesystem::path& file);

/// The line of a run; its track must be coarse.
nlohmann::json row_json(std::size_t run, const experiment::Row& row);

/// How `theirs` differs from `ours`, as a clause: "repeats is 2 there and 3 here".
std::string difference(const nlohmann::json& theirs, const nlohmann::json& ours);

}  // namespace server::sweep
