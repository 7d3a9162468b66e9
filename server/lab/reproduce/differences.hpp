// server/lab/reproduce/differences.hpp: where the full simulator ends otherwise than the paper's
// conditions, and which of their differences alone does it.
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

/// For every scenario and reading whose outcomes differ, the run is done again with one change at a
/// time: the 26 ms tick, the base, the scanner. The explanation says which of them alone lead to
/// the full simulator's outcomes; it is a statement about these runs, nothing more.
std::vector<Difference> explain_differences(const StudyFile& file,
                                            std::span<const Series> paper,
                                            std::span<const Series> full,
                                            std::uint64_t first_seed,
                                            const experiment::PoolOptions& pool);

}  // namespace server::reproduce
