// server/lab/reproduce/differences.hpp: where the full simulator ends otherwise than the paper's
// conditions, and which of their differences alone does it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "server/experiment/batch.hpp"
#include "server/lab/reproduce/conditions.hpp"

namespace server::reproduce {

struct Difference {
  std::string layout{};
  std::string reading{};
  std::string paper{};  // outcomes
  std::string full{};
  std::string explanation{};
};

/// For every layout and reading whose outcomes differ, the run is done again with one change at a
/// time: the 26 ms tick, the base, the scanner. The explanation says which of them alone lead to
/// the full simulator's outcomes; it is a statement about these runs, nothing more.
std::vector<Difference> explain_differences(const PaperFile& file,
                                            std::span<const Row> paper,
                                            std::span<const Row> full,
                                            std::uint64_t first_seed,
                                            unsigned threads,
                                            const Progress& progress);

}  // namespace server::reproduce
