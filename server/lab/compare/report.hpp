// server/lab/compare/report.hpp: a comparison as text, as JSON and as docs/comparison.md.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "server/experiment/table.hpp"
#include "server/lab/compare/comparison.hpp"

namespace server::compare {

/// One row per contestant, one column per world: mean time [s] / least clearance [m], or the
/// outcomes.
experiment::Table worlds_table(const Comparison& comparison);
/// One row per world and contestant, with all figures.
experiment::Table details_table(const Comparison& comparison);
/// One row per contestant, one column per gap.
experiment::Table bottlenecks_table(const Comparison& comparison);
/// One row per controller; and a comparison of those that reach with the original strip.
experiment::Table layouts_table(const LayoutSet& set);
experiment::Table beside_original_table(const LayoutSet& set);

/// One row per run in the worlds and at the bottlenecks, with every figure.
experiment::Table rows_table(const Comparison& comparison);

std::string to_text(const Comparison& comparison);
nlohmann::json to_json(const Comparison& comparison);
/// The complete comparison.md.
std::string to_markdown(const Comparison& comparison);
/// Writes comparison.md into `folder`, and the table of the worlds into controllers.md there, if it
/// has the marks for it. Throws std::runtime_error with the path that cannot be written.
void write_markdown(const Comparison& comparison, const std::filesystem::path& folder);

}  // namespace server::compare
