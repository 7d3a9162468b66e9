// db/run_reader.hpp: reads runs while others record.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "db/block_codec.hpp"
#include "db/file_lock.hpp"
#include "db/records.hpp"
#include "db/sqlite.hpp"

namespace db {

/// Reads a run store over its own read-only connection. Used by one thread at a time, of any
/// program. Reader and writer never wait for each other. A call sees the data committed before it
/// began, in the file at the path at that time; a file that was set aside or deleted is closed. All
/// calls throw StoreError if the database fails.
class RunReader {
 public:
  /// Throws StoreError if there is no run store at `path`.
  explicit RunReader(const std::string& path);
  struct Later {};
  /// Opens the store at the first call that finds one.
  RunReader(std::string path, Later /*tag*/) : path_(std::move(path)) {}

  /// Up to `limit` runs after `cursor`, without their documents. The page also ends with the run
  /// that fills `room` [bytes]. Throws std::invalid_argument for an unknown order, or a cursor of
  /// another one. A run that begins, ends or goes between two pages shifts no other run.
  RunPage list(const RunFilter& filter,
               std::size_t limit,
               const std::optional<std::string>& cursor = {},
               const RunOrder& order = {},
               std::size_t room = SIZE_MAX);
  /// The number of lines of the list, on all pages.
  std::uint64_t count(const RunFilter& filter, bool grouped = false);
  /// The number of runs by RunRow::result, whatever outcome, status and result the filter asks for.
  std::map<std::string, std::uint64_t> results(RunFilter filter);
  bool exists(RunId run);
  /// The run with its document and gaps; nothing if there is no such run.
  std::optional<RunRow> get(RunId run);

  using FrameSink = std::function<void(std::uint64_t tick, std::span<const std::byte> frame)>;
  /// Passes up to `limit` frames from tick `from` on to `sink`, in order, each valid during the
  /// call. Returns the tick to continue with, or nothing after the last. If a block is damaged,
  /// passes the frames before it and throws StoreError.
  std::optional<std::uint64_t> frames(RunId run,
                                      std::uint64_t from,
                                      std::size_t limit,
                                      const FrameSink& sink);

 private:
  struct Tables;  // a connection and its statements

  Tables& tables();
  RunGroup group_of(const RunFilter& filter, RunId batch);
  std::optional<std::uint64_t> seek(RunId run, std::uint64_t tick, bool unpack);

  std::string path_;
  std::optional<FileIdentity> opened_{};
  std::shared_ptr<Tables> tables_{};  // shared_ptr, for an incomplete type
  BlockDecoder decoder_{};
  RunId block_run_ = 0;  // the run of the decoder's block; 0: none
  std::uint64_t block_first_ = 0;
};

}  // namespace db
