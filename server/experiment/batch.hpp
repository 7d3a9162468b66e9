// server/experiment/batch.hpp: many runs over all cores; the result does not know how many.
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "server/experiment/figures.hpp"
#include "server/run/run_spec.hpp"

namespace server::reproduce {

/// `done` of `all` runs are over. Called from the workers, one at a time.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

/// One run from start to outcome. Throws std::runtime_error when it breaks.
RunFigures run_once(const RunSpec& spec, bool keep_track);

/// The runs of one row: as `spec` with `seeds` seeds from `spec.seed` on.
struct RowJob {
  std::string layout{};
  std::string reading{};
  RunSpec spec{};
  std::size_t seeds = 1;
};

/// The rows of `jobs`, in their order, from `threads` threads (0: one a core). The track of each
/// row's first run is kept.
std::vector<Row> run_rows(const std::vector<RowJob>& jobs,
                          unsigned threads,
                          const Progress& progress);

}  // namespace server::reproduce
