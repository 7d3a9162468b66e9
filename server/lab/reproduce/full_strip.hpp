// server/lab/reproduce/full_strip.hpp: our full strip beside every reading of the papers' one: is
// it smoother, is it faster?
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/experiment/figures.hpp"
#include "server/experiment/table.hpp"
#include "server/lab/reproduce/paper_file.hpp"

namespace server::reproduce {

constexpr std::string_view kFullStrip = "strip";

/// How deep [mm] a run must come into the safety circle, by layout, because of where it begins and
/// ends: within the arrival radius of a goal that stands nearer to an obstacle than d_safe.
using Depths = std::map<std::string, double, std::less<>>;
Depths least_depths(const PaperFile& file);

/// The full strip against the rows of the readings that reach in every run.
struct StripBeside {
  std::size_t rows = 0;  // such rows; the strip must reach, too
  /// "case2 original": the rows in which the strip is not better.
  std::vector<std::string> turns_less{};
  std::vector<std::string> bends_less{};
  std::vector<std::string> faster{};
  std::vector<std::string> not_reached{};  // layouts that the strip did not reach in every run
  // "exp1 by 159 mm (127 mm at least)": into the safety circle
  std::vector<std::string> entered{};
};
StripBeside strip_beside(std::span<const Row> strip,
                         std::span<const Row> readings,
                         const Depths& least = {});

/// A layout a line, a controller a column: turning [rad] / bending [1e-3 rad2/mm] / time [s].
Table strip_table(std::span<const Row> strip, std::span<const Row> readings);

/// What the rows come to, in sentences.
std::string strip_sentences(const StripBeside& beside);

}  // namespace server::reproduce
