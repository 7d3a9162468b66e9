// server/lab/tune/tune_run.hpp: the search over the training scenarios.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/experiment/pool.hpp"
#include "server/experiment/trial.hpp"
#include "server/lab/tune/tune_document.hpp"

namespace server::tune {

/// One setting that was tried.
struct Attempt {
  sweep::Point point{};
  std::vector<double> goals{};  // values in the order of Document::goals; NaN: no run reached
  double loss = 0;              // smaller is better; infinite if nothing is known
};

/// The value of each goal: the rate of an outcome among all runs, or the mean of a figure over the
/// runs that reached their goal.
std::vector<double> values_of(const std::vector<Goal>& goals,
                              std::span<const experiment::Row> rows);

/// One number to be made small, of `runs` runs. With two goals, the second moves it by less than
/// one run more or less does in the rate, so that it decides only between equal rates.
double loss_of(const std::vector<Goal>& goals, const std::vector<double>& values, std::size_t runs);

/// Tries settings until the budget is spent, the first being the initial values (moved into the
/// limits), and returns all in order. Controlled random search with local mutation. Source: Kaelo
/// and Ali 2006, as in NLopt. Does not depend on the number of threads. After a stop, nothing.
/// A setting that the controller refuses is the worst. `options.progress` counts settings. Throws
/// std::runtime_error if a run breaks.
std::optional<std::vector<Attempt>> search(const Document& document,
                                           const experiment::PoolOptions& options);

/// The best of one or more attempts; the earliest of equals.
const Attempt& best_of(const std::vector<Attempt>& attempts);

/// A table of all attempts, as CSV.
std::string to_csv(const Document& document, const std::vector<Attempt>& attempts);

}  // namespace server::tune
