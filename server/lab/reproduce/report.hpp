// server/lab/reproduce/report.hpp: a study as tables and as JSON.
#pragma once

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "server/experiment/table.hpp"
#include "server/lab/reproduce/study.hpp"
#include "server/lab/reproduce/sweeps.hpp"

namespace server::reproduce {

/// One row per scenario and reading: outcomes, path, clearance, intrusion, turning, via points,
/// time.
Table rows_table(std::span<const Series> rows);
Table checks_table(std::span<const Check> checks);
/// Verdict and readings by table A, and by table B if it exists.
Table claims_table(const Study& study);
Table differences_table(std::span<const Difference> differences);

std::size_t collisions(std::span<const Series> rows);
std::size_t runs(std::span<const Series> rows);

/// "117 of 118 limits held."
std::string checks_sentence(std::span<const Check> checks);

/// The output of `tautline reproduce`, without its last sentence.
std::string to_text(const Study& study);
/// Every metric of every row.
nlohmann::json to_json(const Study& study);

std::string to_text(std::span<const Sweep> sweeps);
nlohmann::json to_json(std::span<const Sweep> sweeps);

}  // namespace server::reproduce
