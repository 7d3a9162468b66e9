// server/experiment/sweep/merge.hpp: folds the logs of shards into one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "server/experiment/sweep/run_log.hpp"
#include "server/experiment/sweep/sweep_plan.hpp"

namespace server::sweep {

struct Merged {
  Rows rows{};                          // of the whole experiment; some may be missing
  std::size_t added = 0;                // runs that `out` did not hold before
  std::vector<std::string> warnings{};  // sentences
};

/// Adds the finished runs of every shard to the log in `out`, and notes their machines. The shards
/// are only read, so that they may be of a read-only disk or still running. Doing it again adds
/// nothing. A run that `out` holds already stays. Throws std::runtime_error with a sentence that
/// names the difference if a shard is of another document, other scenarios or another version.
Merged merge_shards(const Plan& plan,
                    const std::filesystem::path& out,
                    const std::vector<std::filesystem::path>& shards);

/// The runs in `folder`, which is only read: as RunLog::found(). `scratch` is a folder for a copy.
Rows rows_in(const Plan& plan,
             const std::filesystem::path& folder,
             const std::filesystem::path& scratch);

}  // namespace server::sweep
