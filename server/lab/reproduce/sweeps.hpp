// server/lab/reproduce/sweeps.hpp: one parameter at a time over all layouts, for what the sources
// say the parameters do.
#pragma once

#include <string>
#include <vector>

#include "server/experiment/batch.hpp"
#include "server/experiment/table.hpp"
#include "server/lab/reproduce/paper_file.hpp"

namespace server::reproduce {

/// One layout with one reading, once for each value.
struct SweepLine {
  std::string layout{};
  std::string reading{};
  std::vector<Row> rows{};      // a value each
  std::vector<bool> refused{};  // elsewhere this program refuses that value here
};

struct Sweep {
  std::string parameter{};  // "K_r"
  std::vector<double> values{};
  std::vector<SweepLine> lines{};
  std::string claim{};    // of the sources
  std::string rule{};     // how the verdict follows from the figures
  std::string verdict{};  // "holds", "holds only in part", "does not hold", "no claim"
  std::string because{};  // the figures behind it
  Table table{};
  std::string legend{};  // what a cell says
};

/// K_c, K_r, d_safe and N under the paper's conditions. Values that are refused elsewhere
/// (S >= K_r d_safe) are run all the same: that is where the collisions are.
std::vector<Sweep> run_sweeps(const PaperFile& file,
                              std::size_t seeds,
                              std::uint64_t first_seed,
                              unsigned threads,
                              const Progress& progress);

/// Whether `figures`, one a value, rise: none below the one before by more than `tolerance`, and
/// the last above the first by more than it.
bool rises(const std::vector<double>& figures, double tolerance);

}  // namespace server::reproduce
