// server/lab/reproduce/accept.cpp: one Check for every limit of the file.
#include "server/lab/reproduce/accept.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace server::reproduce {
namespace {

/// A figure in the unit of the papers' tables: lengths in millimetres.
struct PaperUnit {
  std::string name{};
  double factor = 1;
};
PaperUnit paper_unit(const std::string& figure) {
  const bool length = figure.ends_with("_m") && !figure.ends_with("_per_m");
  return length ? PaperUnit{figure.substr(0, figure.size() - 1) + "mm", kMillimetres}
                : PaperUnit{figure, 1};
}

std::string number(double value) {
  return fmt::format("{:.6g}", value);
}

void check_bound(const Limit& limit, const Series& series, Check& check) {
  const PaperUnit unit = paper_unit(limit.figure);
  const bool at_least = limit.at_least.has_value();
  const double bound = at_least ? *limit.at_least : *limit.at_most;
  const double value = figure_against(series, limit.figure, at_least);
  check.asked = fmt::format(
      "{} at {} {}", unit.name, at_least ? "least" : "most", number(bound * unit.factor));
  check.figure = number(value * unit.factor);
  check.held = at_least ? value >= bound : value <= bound;
}

void check_below(const Limit& limit, const Series& lower, const Series* higher, Check& check) {
  const PaperUnit unit = paper_unit(limit.figure);
  check.asked = unit.name;
  if (higher == nullptr) {
    check.figure = "none";
    return;
  }
  const double a = figure(lower, limit.figure);
  const double b = figure(*higher, limit.figure);
  check.figure = fmt::format("{} < {}", number(a * unit.factor), number(b * unit.factor));
  check.held = a < b;
}

Check check_limit(const Limit& limit, std::span<const Series> all) {
  Check check{.scenario = limit.scenario, .subject = limit.controller, .figure = "none"};
  if (!limit.below.empty()) check.subject += " < " + limit.below;
  if (limit.noise_free) check.subject += ", noise-free";
  const Series* const series = find_series(all, limit.scenario, limit.controller);
  if (series == nullptr) {
    check.asked = "a run";
  } else if (limit.outcome) {
    check.asked = fmt::format("all {}", algo::name(*limit.outcome));
    check.figure = outcomes_text(*series);
    check.held = common_outcome(*series) == limit.outcome;
  } else if (limit.collisions) {
    const std::size_t collided = count(*series, algo::Outcome::Collided);
    check.asked = fmt::format("collisions {}", *limit.collisions);
    check.figure = fmt::format("{}", collided);
    check.held = collided == *limit.collisions;
  } else if (!limit.below.empty()) {
    check_below(limit, *series, find_series(all, limit.scenario, limit.below), check);
  } else {
    check_bound(limit, *series, check);
  }
  return check;
}

}  // namespace

std::vector<Check> evaluate(const StudyFile& file,
                            std::span<const Series> paper,
                            std::span<const Series> noise_free) {
  std::vector<Check> checks;
  checks.reserve(file.limits.size());
  for (const Limit& limit : file.limits) {
    checks.push_back(check_limit(limit, limit.noise_free ? noise_free : paper));
  }
  return checks;
}

bool all_held(std::span<const Check> checks) {
  return std::ranges::all_of(checks, &Check::held);
}

}  // namespace server::reproduce
