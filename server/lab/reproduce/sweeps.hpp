// server/lab/reproduce/sweeps.hpp: one parameter at a time over all scenarios, for what the sources
// say the parameters do.
#pragma once

#include <string>
#include <vector>

#include "server/experiment/series.hpp"
#include "server/experiment/table.hpp"
#include "server/lab/reproduce/study_file.hpp"

namespace server::reproduce {

using experiment::Series;
using experiment::Table;

/// One scenario with one reading, once for each value.
struct SweepLine {
  std::string scenario{};
  std::string reading{};
  std::vector<Series> rows{};   // a value each
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

/// The sweeps of the file under the papers' conditions; those of K_c, K_r, d_safe and N are held
/// against what the sources say of them. Values that are refused elsewhere
/// (S >= K_r d_safe) are run all the same: that is where the collisions are.
std::vector<Sweep> run_sweeps(const StudyFile& file,
                              std::size_t seeds,
                              std::uint64_t first_seed,
                              const experiment::PoolOptions& pool);

/// Whether `figures`, one a value, rise: none below the one before by more than `tolerance`, and
/// the last above the first by more than it.
bool rises(const std::vector<double>& figures, double tolerance);

}  // namespace server::reproduce
