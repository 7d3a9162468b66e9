// server/experiment/sweep/sweep_tables.hpp: the tables of an experiment, and its results as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "server/experiment/sweep/sweep_results.hpp"
#include "server/experiment/table.hpp"

namespace server::sweep {

/// One line per run, missing ones included, with every figure and the command that repeats it.
experiment::Table runs_table(const Plan& plan, const Rows& rows);
/// The same of the runs from `first` to before `last`.
experiment::Table runs_table(const Plan& plan,
                             const Rows& rows,
                             std::size_t first,
                             std::size_t last);
/// Rates of the outcomes of each arm.
experiment::Table rates_table(const Plan& plan, const Results& results);
/// Median, quartiles and mean of each figure of each arm.
experiment::Table figures_table(const Plan& plan, const Results& results);
/// Rate of success and time of each arm in each scenario.
experiment::Table scenarios_table(const Plan& plan, const Results& results);
/// The order of the arms by other rules, and whether it is the same.
experiment::Table rankings_table(const Plan& plan, const Results& results);
/// The paired tests.
experiment::Table pairings_table(const Plan& plan, const Results& results);

nlohmann::json results_json(const Plan& plan, const Results& results);

}  // namespace server::sweep
