// server/experiment/sweep/sweep_report.hpp: the files of an experiment: runs, results, report.
#pragma once

#include <filesystem>
#include <string>

#include "server/experiment/sweep/sweep_results.hpp"

namespace server::sweep {

/// "INCOMPLETE: 3 of 40 runs are missing, 1 failed."; empty if the experiment is complete.
std::string incomplete_text(const Results& results);

std::string to_markdown(const Plan& plan, const Results& results);
/// A LaTeX document that compiles by itself; the tables are complete tabulars.
std::string to_latex(const Plan& plan, const Results& results);

/// Writes results.json, runs.csv, report.html, report.md, report.tex and pictures/*.svg. Throws
/// std::runtime_error.
void write_report(const Plan& plan,
                  const Rows& rows,
                  const Results& results,
                  const std::filesystem::path& folder);

}  // namespace server::sweep
