// server/lab/reproduce/full_strip.hpp: our full strip beside every reading of the papers' one: is
// it smoother, is it faster?
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

/// How deep [m] a run must come into the safety circle, by scenario, because of where it begins and
/// ends: within the arrival radius of a goal that stands nearer to an obstacle than d_safe.
using Depths = std::map<std::string, double, std::less<>>;
Depths least_depths(const StudyFile& file);

/// The full strip against the rows of the readings that reach in every run.
struct StripBeside {
  std::size_t rows = 0;  // such rows; the strip must reach, too
  /// "case2 original": the rows in which the strip is not better.
  std::vector<std::string> turns_less{};
  std::vector<std::string> bends_less{};
  std::vector<std::string> faster{};
  std::vector<std::string> not_reached{};  // scenarios that the strip did not reach in every run
  // "exp1 by 159 mm (127 mm at least)": into the safety circle
  std::vector<std::string> entered{};
};
StripBeside strip_beside(std::span<const Series> strip,
                         std::span<const Series> readings,
                         const Depths& least = {});

/// A scenario a line, a controller a column: turning [rad] / bending [1e-3 rad2/mm] / time [s].
Table strip_table(std::span<const Series> strip, std::span<const Series> readings);

/// What the rows come to, in sentences.
std::string strip_sentences(const StripBeside& beside);

}  // namespace server::reproduce
