// server/lab/reproduce/sweeps.cpp: the runs and the rules of the verdicts.
#include "server/lab/reproduce/sweeps.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include <fmt/format.h>

#include "algo/driving.hpp"
#include "algo/filter/filter.hpp"
#include "algo/pipeline/parameter_table.hpp"
#include "algo/strip/strip_law.hpp"
#include "server/lab/reproduce/conditions.hpp"

namespace server::reproduce {
namespace {

using algo::Outcome;

/// How a sweep of one parameter is shown and judged.
struct SweptReading {
  const algo::ParameterInfo* parameter = nullptr;
  const char* name = "";
  std::string (*cell)(const Series&) = nullptr;
  const char* legend = "";
  void (*judge)(Sweep&, double tolerance_mm) = nullptr;
};

double millimetres(const Series& row, std::string_view column) {
  return figure(row, column) * kMillimetres;
}

std::string clearance_cell(const Series& row) {
  return fmt::format("{:.0f} {}", millimetres(row, "min_clearance_m"), outcome_letters(row));
}

std::string strip_cell(const Series& row) {
  return fmt::format("{:.0f} / {:.3f} {}",
                     millimetres(row, "path_m"),
                     figure(row, "strip_share_deviation"),
                     outcome_letters(row));
}

std::string turning_cell(const Series& row) {
  return fmt::format("{:.0f} / {:.2f} {}",
                     millimetres(row, "min_clearance_m"),
                     figure(row, "turning_rad"),
                     outcome_letters(row));
}

std::string verdict_of(std::size_t held, std::size_t all) {
  if (held == all && all > 0) return "holds";
  return held == 0 ? "does not hold" : "holds only in part";
}

std::vector<double> clearances(const SweepLine& line) {
  std::vector<double> out;
  out.reserve(line.rows.size());
  for (const Series& row : line.rows) out.push_back(millimetres(row, "min_clearance_m"));
  return out;
}

/// "22 of 27 lines rise (not: case2 original, case2 modified)".
struct Rising {
  std::size_t lines = 0;
  std::string text{};
};

Rising rising_lines(const Sweep& sweep, double tolerance_mm) {
  Rising out;
  std::vector<std::string> others;
  for (const SweepLine& line : sweep.lines) {
    if (rises(clearances(line), tolerance_mm)) {
      ++out.lines;
    } else {
      others.push_back(line.scenario + " " + line.reading);
    }
  }
  out.text = fmt::format("{} of {} lines rise", out.lines, sweep.lines.size());
  if (!others.empty()) out.text += fmt::format(" (not: {})", fmt::join(others, ", "));
  return out;
}

void judge_repulsion(Sweep& sweep, double tolerance_mm) {
  sweep.claim = "A larger K_r repels more.";
  sweep.rule = fmt::format(
      "A line holds if its least clearance rises with K_r: no step falls by more than {:.0f} mm, "
      "the noise, and the total rise is larger than that. The claim holds if every line does, in "
      "part if some do.",
      tolerance_mm);
  const Rising rising = rising_lines(sweep, tolerance_mm);
  sweep.verdict = verdict_of(rising.lines, sweep.lines.size());
  sweep.because = rising.text + ".";
}

/// The collided runs at each value, and their sums over values accepted and refused elsewhere.
struct Collisions {
  std::vector<std::size_t> at{};
  std::size_t accepted = 0;
  std::size_t refused = 0;
};

Collisions collisions_of(const Sweep& sweep) {
  Collisions out{.at = std::vector<std::size_t>(sweep.values.size())};
  for (const SweepLine& line : sweep.lines) {
    for (std::size_t i = 0; i < line.rows.size(); ++i) {
      const std::size_t collided = count(line.rows[i], Outcome::Collided);
      out.at[i] += collided;
      (line.refused[i] ? out.refused : out.accepted) += collided;
    }
  }
  return out;
}

void judge_safety_distance(Sweep& sweep, double tolerance_mm) {
  sweep.claim =
      "A smaller safety distance leaves more area for the avoidance, and brings more collisions.";
  sweep.rule = fmt::format(
      "Two parts. Area: a line holds when its least clearance rises with d_safe, as for K_r "
      "(tolerance {:.0f} mm), that is, when a smaller one lets the robot use more of the room. "
      "Collisions: the smallest d_safe has more collided runs than the largest, and none of the "
      "values has more than a smaller one. The claim holds when both do in full, in part when "
      "either does or some lines do.",
      tolerance_mm);
  const Rising rising = rising_lines(sweep, tolerance_mm);
  const Collisions collided = collisions_of(sweep);
  const bool more = std::ranges::is_sorted(collided.at, std::greater<>()) &&
                    collided.at.front() > collided.at.back();
  const std::size_t parts = (rising.lines == sweep.lines.size() ? 1U : 0U) + (more ? 1U : 0U);
  sweep.verdict = parts == 2                   ? "holds"
                  : rising.lines == 0 && !more ? "does not hold"
                                               : "holds only in part";
  sweep.because = fmt::format(
      "{}; collided runs by d_safe: {}. Of the collisions, {} are at settings with S >= K_r "
      "d_safe, "
      "which this program refuses, and {} at settings it takes.",
      rising.text,
      fmt::join(collided.at, ", "),
      collided.refused,
      collided.accepted);
}

/// True if F_int ever exceeds rounding.
bool acts(const SweepLine& line) {
  constexpr double kRounding = 1e-9;  // [m]
  return std::ranges::any_of(
      line.rows, [](const Series& row) { return figure(row, "internal_force_m") > kRounding; });
}

void judge_contraction(Sweep& sweep, double /*tolerance_mm*/) {
  sweep.claim = "The scaling factor K_c keeps the relative distance of the control points.";
  sweep.rule =
      "A line holds when F_int is ever above 1e-9 m and the share of the strip before its via "
      "point, |P^j - P^{j-1}| / (|P^j - P^{j-1}| + |P^{j+1} - P^j|), varies less within a run "
      "(standard deviation over the ticks with an external force) at the largest K_c than at "
      "the smallest. The claim holds when every line does, in part when some do.";
  std::size_t active = 0;
  std::size_t held = 0;
  std::size_t reached = 0;   // runs of the active lines at the largest K_c
  std::size_t collided = 0;  // likewise
  for (const SweepLine& line : sweep.lines) {
    if (!acts(line)) continue;
    ++active;
    const double first = figure(line.rows.front(), "strip_share_deviation");
    const double last = figure(line.rows.back(), "strip_share_deviation");
    if (last < first) ++held;
    reached += count(line.rows.back(), Outcome::Reached);
    collided += count(line.rows.back(), Outcome::Collided);
  }
  sweep.verdict = verdict_of(held, sweep.lines.size());
  sweep.because = fmt::format(
      "In {} of {} lines F_int is zero except for rounding: the via lies on the chord, and K_c "
      "has no effect. In {} of the other {} the share varies less at the largest K_c, where {} of "
      "their runs reach and {} collide.",
      sweep.lines.size() - active,
      sweep.lines.size(),
      held,
      active,
      reached,
      collided);
}

void judge_filter(Sweep& sweep, double /*tolerance_mm*/) {
  sweep.claim =
      "(The sources say nothing about the effect of N on the path; these are figures "
      "only.)";
  sweep.rule = "None.";
  sweep.verdict = "no claim";
  double most = 0;
  for (const SweepLine& line : sweep.lines) {
    const std::vector<double> all = clearances(line);
    const auto [low, high] = std::ranges::minmax(all);
    most = std::max(most, high - low);
  }
  sweep.because = fmt::format("N changes the least clearance by at most {:.0f} mm.", most);
}

constexpr const char* kClearance =
    "least clearance [mm] and outcome: r reached, s stuck, t out of time, C collided; * refused "
    "elsewhere, since S >= K_r d_safe";

constexpr auto kSweptReadings = std::to_array<SweptReading>({
    {&algo::kRepulsionGain, "K_r", clearance_cell, kClearance, judge_repulsion},
    {&algo::kSafetyDistance, "d_safe", clearance_cell, kClearance, judge_safety_distance},
    {&algo::kContractionGain,
     "K_c",
     strip_cell,
     "path [mm] / deviation of the share of the strip before its via point, and outcome",
     judge_contraction},
    {&algo::kFilterHalfWidth,
     "N",
     turning_cell,
     "least clearance [mm] / turning [rad], and outcome",
     judge_filter},
});

void judge_nothing(Sweep& sweep, double /*tolerance_mm*/) {
  sweep.claim = "(The sources claim nothing that is tried here.)";
  sweep.rule = "None.";
  sweep.verdict = "no claim";
  sweep.because = "These are figures only.";
}

SweptReading reading_of(const algo::ParameterInfo& parameter) {
  const auto* const found = std::ranges::find(kSweptReadings, &parameter, &SweptReading::parameter);
  if (found != kSweptReadings.end()) return *found;
  return {&parameter, parameter.key().data(), clearance_cell, kClearance, judge_nothing};
}

void tabulate(Sweep& sweep, const SweptReading& reading) {
  sweep.legend = reading.legend;
  sweep.table.words = 2;
  sweep.table.header = {"scenario", "reading"};
  for (const double each : sweep.values) {
    const bool first = sweep.table.header.size() == sweep.table.words;
    sweep.table.header.push_back(first ? fmt::format("{} = {:g}", reading.name, each)
                                       : fmt::format("{:g}", each));
  }
  for (const SweepLine& line : sweep.lines) {
    std::vector<std::string> cells{line.scenario, line.reading};
    for (std::size_t i = 0; i < line.rows.size(); ++i) {
      cells.push_back(reading.cell(line.rows[i]) + (line.refused[i] ? " *" : ""));
    }
    sweep.table.rows.push_back(std::move(cells));
  }
}

}  // namespace

bool rises(const std::vector<double>& figures, double tolerance) {
  for (std::size_t i = 1; i < figures.size(); ++i) {
    if (figures[i] < figures[i - 1] - tolerance) return false;
  }
  return !figures.empty() && figures.back() > figures.front() + tolerance;
}

std::vector<Sweep> run_sweeps(const StudyFile& file,
                              std::size_t seeds,
                              std::uint64_t first_seed,
                              const experiment::PoolOptions& pool) {
  std::vector<Sweep> sweeps;
  std::vector<experiment::SeriesPlan> plans;
  for (const SweepPlan& asked : file.sweeps) {
    Sweep& sweep = sweeps.emplace_back();
    sweep.parameter = reading_of(*asked.parameter).name;
    sweep.values = asked.values;
    for (const sim::Scenario& scenario : file.scenarios) {
      for (const std::string& reading : asked.controllers) {
        SweepLine& line = sweep.lines.emplace_back();
        line.scenario = scenario.name;
        line.reading = reading;
        for (const double each : asked.values) {
          RunSpec spec = make_run(file.conditions, scenario, reading, kPaper, first_seed);
          spec.parameters.set(*asked.parameter, each);
          line.refused.push_back(algo::refusal(spec.parameters).has_value());
          plans.push_back({scenario.name, reading, std::move(spec), seeds});
        }
      }
    }
  }
  std::vector<Series> rows = run_series(plans, experiment::common_judges(), pool);
  auto next = std::make_move_iterator(rows.begin());
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    for (SweepLine& line : sweeps[i].lines) {
      const auto end = next + static_cast<std::ptrdiff_t>(line.refused.size());
      line.rows.assign(next, end);
      next = end;
    }
    const SweptReading reading = reading_of(*file.sweeps[i].parameter);
    reading.judge(sweeps[i], file.conditions.noise * kMillimetres);
    tabulate(sweeps[i], reading);
  }
  return sweeps;
}

}  // namespace server::reproduce
