// server/experiment/sweep/report_sections.hpp: the parts of a report, the same in all its formats.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/experiment/sweep/sweep_results.hpp"
#include "server/experiment/table.hpp"

namespace server::sweep {

struct Section {
  std::string_view title{};
  std::string text{};  // what the table holds and how it was computed; may be empty
  experiment::Table table{};
};

/// Outcomes, figures, comparisons, robustness and, up to 500 lines of it, the table by scenario.
std::vector<Section> sections_of(const Plan& plan, const Results& results);

/// Size, version and hash of the experiment in two sentences.
std::string summary_of(const Plan& plan);

}  // namespace server::sweep
