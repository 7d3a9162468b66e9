// server/lab/reproduce/differences.hpp: runs that end differently in the full simulator than under
// the paper's conditions, and which single change causes it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "server/experiment/series.hpp"
#include "server/lab/reproduce/conditions.hpp"

namespace server::reproduce {

using experiment::Series;

struct Difference {
  std::string scenario{};
  std::string controller{};
  std::string paper{};  // outcomes
  std::string full{};
  std::string explanation{};
};

/// Repeats the runs of every scenario and reading whose outcomes differ, with one change at a time:
/// the 26 ms tick, the base, the scanner. The explanation says which of them alone lead to the full
/// simulator's outcomes. It holds for these runs only.
std::vector<Difference> explain_differences(const StudyFile& file,
                                            std::span<const Series> paper,
                                            std::span<const Series> full,
                                            std::uint64_t first_seed,
                                            const experiment::PoolOptions& pool);

}  // namespace server::reproduce
