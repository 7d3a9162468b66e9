// server/lab/reproduce/sweeps.hpp: varies one parameter at a time over all scenarios, to test the
// sources' claims about the parameters.
#pragma once

#include <string>
#include <vector>

#include "server/experiment/series.hpp"
#include "server/experiment/table.hpp"
#include "server/lab/reproduce/study_file.hpp"

namespace server::reproduce {

using experiment::Series;
using experiment::Table;

/// One scenario with one reading, for all values.
struct SweepLine {
  std::string scenario{};
  std::string reading{};
  std::vector<Series> rows{};   // one per value
  std::vector<bool> refused{};  // one per value: the product refuses it here
};

struct Sweep {
  std::string parameter{};  // "K_r"
  std::vector<double> values{};
  std::vector<SweepLine> lines{};
  std::string claim{};    // the sources' claim
  std::string rule{};     // how the verdict follows from the figures
  std::string verdict{};  // "holds", "holds only in part", "does not hold", "no claim"
  std::string because{};  // the figures behind it
  Table table{};
  std::string legend{};  // meaning of a cell
};

/// The sweeps of the file under the papers' conditions; those of K_c, K_r, d_safe and N are tested
/// against the sources' claims. Values that the program refuses elsewhere (S >= K_r d_safe) are run
/// here, because they cause the collisions.
std::vector<Sweep> run_sweeps(const StudyFile& file,
                              std::size_t seeds,
                              std::uint64_t first_seed,
                              const experiment::PoolOptions& pool);

/// True if `figures`, one per value, rise: none is below the one before by more than `tolerance`,
/// and the last is above the first by more than `tolerance`.
bool rises(const std::vector<double>& figures, double tolerance);

}  // namespace server::reproduce
