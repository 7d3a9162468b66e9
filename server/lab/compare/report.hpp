// server/lab/compare/report.hpp: a comparison as text, as JSON and as docs/comparison.md.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "server/experiment/table.hpp"
#include "server/lab/compare/comparison.hpp"

namespace server::compare {

/// A contestant a line, a world a column: mean seconds / least clearance [m], or how it ended.
experiment::Table worlds_table(const Comparison& comparison);
/// A world and a contestant a line, with all figures.
experiment::Table details_table(const Comparison& comparison);
/// A contestant a line, a gap a column.
experiment::Table bottlenecks_table(const Comparison& comparison);
/// A controller a line; then how those that reach fare beside the original strip.
experiment::Table layouts_table(const LayoutSet& set);
experiment::Table beside_original_table(const LayoutSet& set);

/// A run of the worlds and the bottlenecks a line, with every figure.
experiment::Table rows_table(const Comparison& comparison);

std::string to_text(const Comparison& comparison);
nlohmann::json to_json(const Comparison& comparison);
/// The whole document.
std::string to_markdown(const Comparison& comparison);
/// Writes comparison.md into `folder`, and the table of the worlds into the controllers.md there,
/// where that has a place for it. Throws std::runtime_error with the path that cannot be
/// written.
void write_markdown(const Comparison& comparison, const std::filesystem::path& folder);

}  // namespace server::compare
