// server/lab/reproduce/full_strip.hpp: compares our full strip with every reading of the papers'
// strip: is it smoother, is it faster?
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/experiment/series.hpp"
#include "server/experiment/table.hpp"
#include "server/lab/reproduce/study_file.hpp"

namespace server::reproduce {

using experiment::Series;
using experiment::Table;

constexpr std::string_view kFullStrip = "strip";

/// Depth [m] to which a run must enter the safety circle, by scenario: start or goal may be nearer
/// to an obstacle than d_safe. A run ends within the arrival radius of the goal.
using Depths = std::map<std::string, double, std::less<>>;
Depths least_depths(const StudyFile& file);

/// The full strip against the rows of the readings in which every run reaches the goal.
struct StripBeside {
  std::size_t rows = 0;  // such rows; the strip must also reach in every run
  /// "case2 original": the rows in which the strip is not better.
  std::vector<std::string> turns_less{};
  std::vector<std::string> bends_less{};
  std::vector<std::string> faster{};
  std::vector<std::string> not_reached{};  // scenarios in which a run of the strip did not reach
  // "exp1 by 159 mm (127 mm at least)": into the safety circle
  std::vector<std::string> entered{};
};
StripBeside strip_beside(std::span<const Series> strip,
                         std::span<const Series> readings,
                         const Depths& least = {});

/// One row per scenario, one column per controller: turning [rad] / bending [1e-3 rad2/mm] / time
/// [s].
Table strip_table(std::span<const Series> strip, std::span<const Series> readings);

/// The result of the comparison, in sentences.
std::string strip_sentences(const StripBeside& beside);

}  // namespace server::reproduce
