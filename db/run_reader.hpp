// db/run_reader.hpp: reading runs while others record.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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

/// Reads a run store over its own read-only connection. One thread at a time owns it, any thread
/// and any program; it never waits for the writer and the writer never for it. A call sees what
/// was committed when it began, in the file that is then at the path: one that was set aside or
/// deleted is let go. All of them throw StoreError when the database fails.
class RunReader {
 public:
  /// Throws StoreError when there is no run store at `path`.
  explicit RunReader(const std::string& path);
  struct Later {};
  /// One whose first call looks for the store, and the next when there is none yet.
  RunReader(std::string path, Later /*tag*/) : path_(std::move(path)) {}

  /// Newest first: up to `limit` runs older than `cursor`. Their documents are left out.
  RunPage list(const RunFilter& filter, std::size_t limit, std::optional<RunId> cursor = {});
  std::uint64_t count(const RunFilter& filter);
  bool exists(RunId run);
  /// With its document and gaps; nothing when there is no such run.
  std::optional<RunRow> get(RunId run);

  using FrameSink = std::function<void(std::uint64_t tick, std::span<const std::byte> frame)>;
  /// Hands up to `limit` frames from tick `from` on to `sink`, in order, each valid during the
  /// call. Returns the tick to go on with, or nothing after the last. Throws StoreError when a
  /// block is damaged, after the frames before it.
  std::optional<std::uint64_t> frames(RunId run,
                                      std::uint64_t from,
                                      std::size_t limit,
                                      const FrameSink& sink);

 private:
  struct Tables;  // a connection and its statements

  Tables& tables();
  std::optional<std::uint64_t> seek(RunId run, std::uint64_t tick, bool unpack);

  std::string path_;
  std::optional<FileIdentity> opened_{};
  std::shared_ptr<Tables> tables_{};  // as in a unique_ptr, whose type need not be known here
  BlockDecoder decoder_{};
  RunId block_run_ = 0;  // whose block the decoder holds; 0: none
  std::uint64_t block_first_ = 0;
};

}  // namespace db
