// server/lab/tune/tune_run.cpp: NLopt proposes settings, the pool runs them.
#include "server/lab/tune/tune_run.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <nlopt.hpp>

#include "server/experiment/sweep/sweep_run.hpp"

namespace server::tune {
namespace {

using experiment::Row;

double rate_of(const std::string& outcome, std::span<const Row> rows) {
  const auto count = std::ranges::count_if(
      rows, [&](const Row& row) { return algo::name(row.outcome) == outcome; });
  return static_cast<double>(count) / static_cast<double>(rows.size());
}

double mean_where_reached(const std::string& column, std::span<const Row> rows) {
  double sum = 0;
  int n = 0;
  for (const Row& row : rows) {
    if (row.outcome != algo::Outcome::Reached || !std::isfinite(row[column])) continue;
    sum += row[column];
    ++n;
  }
  return sum / n;  // NaN if there is none
}

/// One search in progress; NLopt calls tried() for each setting.
class Search {
 public:
  Search(const Document& document, const experiment::PoolOptions& options)
      : document_(document), options_(options) {}

  std::optional<std::vector<Attempt>> run();

 private:
  double tried(const std::vector<double>& x);
  Attempt attempt(const std::vector<double>& x) const;
  std::vector<Row> rows_of(const sweep::Plan& plan) const;

  const Document& document_;
  const experiment::PoolOptions& options_;
  std::vector<Attempt> attempts_{};
  std::exception_ptr problem_{};
};

/// False if the controller refuses the setting, as one whose parameters do not go together.
bool accepted(const sweep::Plan& plan) {
  try {
    plan.check();
    return true;
  } catch (const DocumentError&) {
    return false;
  }
}

std::vector<Row> Search::rows_of(const sweep::Plan& plan) const {
  std::vector<Row> rows(plan.size());
  const experiment::PoolOptions pool{.threads = options_.threads, .stop = options_.stop};
  for_each(plan.size(), pool, [&](std::size_t i, const std::stop_token& stop) {
    rows[i] = run_one(plan, i, stop);
    if (rows[i].broken) throw std::runtime_error(plan.trial(i).name + ": " + rows[i].reason);
  });
  return rows;
}

Attempt Search::attempt(const std::vector<double>& x) const {
  Attempt made;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const algo::ParameterInfo& parameter = *document_.axes[i].parameter;
    made.point.emplace(parameter.key(), parameter.step == 1 ? std::round(x[i]) : x[i]);
  }
  sweep::Document part = document_.training;
  part.points = {made.point};
  const sweep::Plan plan(std::move(part));
  if (!accepted(plan)) {
    made.goals.assign(document_.goals.size(), std::nan(""));
    made.loss = HUGE_VAL;
    return made;
  }
  const std::vector<Row> rows = rows_of(plan);
  if (options_.stop.stop_requested()) throw nlopt::forced_stop();
  made.goals = values_of(document_.goals, rows);
  made.loss = loss_of(document_.goals, made.goals, rows.size());
  return made;
}

double Search::tried(const std::vector<double>& x) {
  try {
    attempts_.push_back(attempt(x));
  } catch (const nlopt::forced_stop&) {
    throw;
  } catch (...) {  // NLopt would lose its sentence
    problem_ = std::current_exception();
    throw nlopt::forced_stop();
  }
  if (options_.progress) options_.progress(attempts_.size(), document_.settings);
  return attempts_.back().loss;
}

std::optional<std::vector<Attempt>> Search::run() {
  const auto n = static_cast<unsigned>(document_.axes.size());
  std::vector<double> x;
  std::vector<double> low;
  std::vector<double> high;
  for (const sweep::Design::Axis& axis : document_.axes) {
    low.push_back(axis.values.front());
    high.push_back(axis.values.back());
    x.push_back(std::clamp(axis.parameter->initial, low.back(), high.back()));
  }
  nlopt::srand(static_cast<unsigned long>(document_.training.seed));
  nlopt::opt method(nlopt::GN_CRS2_LM, n);
  method.set_lower_bounds(low);
  method.set_upper_bounds(high);
  method.set_maxeval(static_cast<int>(document_.settings));
  // A third of the budget spreads over the whole range, at most NLopt's own choice.
  const auto third = static_cast<unsigned>(document_.settings / 3);
  method.set_population(std::clamp(third, n + 2, 10 * (n + 1)));
  method.set_min_objective(
      [](const std::vector<double>& at, std::vector<double>&, void* self) {
        return static_cast<Search*>(self)->tried(at);
      },
      this);
  double loss = 0;
  try {
    method.optimize(x, loss);
  } catch (const nlopt::forced_stop&) {
    if (problem_) std::rethrow_exception(problem_);
    return std::nullopt;
  }
  return attempts_;
}

}  // namespace

std::vector<double> values_of(const std::vector<Goal>& goals, std::span<const Row> rows) {
  std::vector<double> values;
  values.reserve(goals.size());
  for (const Goal& goal : goals) {
    values.push_back(goal.is_rate ? rate_of(goal.metric, rows)
                                  : mean_where_reached(goal.metric, rows));
  }
  return values;
}

double loss_of(const std::vector<Goal>& goals,
               const std::vector<double>& values,
               std::size_t runs) {
  const auto part = [&](std::size_t i) { return goals[i].maximize ? -values[i] : values[i]; };
  if (goals.size() == 1) return std::isnan(values[0]) ? HUGE_VAL : part(0);
  const double second = part(1);
  // In -1 to 1, growing with `second`; the worst if it is not known.
  const double squashed = std::isnan(second) ? 1 : second / (1 + std::abs(second));
  return part(0) + squashed / (2.01 * static_cast<double>(runs));
}

std::optional<std::vector<Attempt>> search(const Document& document,
                                           const experiment::PoolOptions& options) {
  return Search(document, options).run();
}

const Attempt& best_of(const std::vector<Attempt>& attempts) {
  return *std::ranges::min_element(attempts, {}, &Attempt::loss);
}

std::string to_csv(const Document& document, const std::vector<Attempt>& attempts) {
  std::string text = "setting";
  for (const auto& [key, unused] : attempts.front().point) text += fmt::format(",{}", key);
  for (const Goal& goal : document.goals) text += "," + goal.metric;
  text += ",loss\n";
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    text += fmt::format("{}", i);
    for (const auto& [unused, value] : attempts[i].point) text += fmt::format(",{}", value);
    for (const double value : attempts[i].goals) text += fmt::format(",{}", value);
    text += fmt::format(",{}\n", attempts[i].loss);
  }
  return text;
}

}  // namespace server::tune
