// server/lab/reproduce/sweeps.cpp: the values, the runs and the rules of the verdicts.
#include "server/lab/reproduce/sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "algo/filter/filter.hpp"
#include "algo/pipeline/parameter_table.hpp"
#include "algo/strip/strip_law.hpp"
#include "server/lab/reproduce/conditions.hpp"

namespace server::reproduce {
namespace {

using algo::Outcome;

struct Plan {
  const algo::ParameterInfo* parameter = nullptr;
  const char* name = "";
  std::vector<double> values{};  // SI
  std::vector<const char*> readings{};
  std::function<std::string(const Row&)> cell{};
  const char* legend = "";
  void (*judge)(Sweep&, double tolerance) = nullptr;
};

double value(const Row& row, std::string_view metric) {
  return figure(row, *find_metric(metric));
}

double mean(const Row& row, double PathFigures::*member) {
  double sum = 0;
  for (const RunFigures& run : row.runs) sum += run.path.*member;
  return sum / static_cast<double>(row.runs.size());
}

std::string clearance_cell(const Row& row) {
  return fmt::format("{:.0f} {}", value(row, "min_clearance_mm"), outcome_letters(row));
}

std::string strip_cell(const Row& row) {
  return fmt::format("{:.0f} / {:.3f} {}",
                     value(row, "path_mm"),
                     mean(row, &PathFigures::share_deviation),
                     outcome_letters(row));
}

std::string turning_cell(const Row& row) {
  return fmt::format("{:.0f} / {:.2f} {}",
                     value(row, "min_clearance_mm"),
                     value(row, "turning_rad"),
                     outcome_letters(row));
}

std::string verdict_of(std::size_t held, std::size_t all) {
  if (held == all && all > 0) return "holds";
  return held == 0 ? "does not hold" : "holds only in part";
}

std::vector<double> clearances(const SweepLine& line) {
  std::vector<double> out;
  out.reserve(line.rows.size());
  for (const Row& row : line.rows) out.push_back(value(row, "min_clearance_mm"));
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
      others.push_back(line.layout + " " + line.reading);
    }
  }
  out.text = fmt::format("{} of {} lines rise", out.lines, sweep.lines.size());
  if (!others.empty()) out.text += fmt::format(" (not: {})", fmt::join(others, ", "));
  return out;
}

void judge_repulsion(Sweep& sweep, double tolerance_mm) {
  sweep.claim = "A larger K_r repels more.";
  sweep.rule = fmt::format(
      "A line holds when its least clearance rises with K_r: at no step down by more than {:.0f} "
      "mm, the noise, and up by more than that in all. The claim holds when every line does, in "
      "part when some do.",
      tolerance_mm);
  const Rising rising = rising_lines(sweep, tolerance_mm);
  sweep.verdict = verdict_of(rising.lines, sweep.lines.size());
  sweep.because = rising.text + ".";
}

/// The collided runs at each value; of those that are refused elsewhere, too.
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

/// Whether F_int is ever more than rounding.
bool acts(const SweepLine& line) {
  constexpr double kRounding = 1e-9;  // [m]
  return std::ranges::any_of(line.rows, [](const Row& row) {
    return std::ranges::any_of(
        row.runs, [](const RunFigures& run) { return run.path.largest_internal > kRounding; });
  });
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
  std::size_t collided = 0;  // the same
  for (const SweepLine& line : sweep.lines) {
    if (!acts(line)) continue;
    ++active;
    const double first = mean(line.rows.front(), &PathFigures::share_deviation);
    const double last = mean(line.rows.back(), &PathFigures::share_deviation);
    if (last < first) ++held;
    reached += count(line.rows.back(), Outcome::Reached);
    collided += count(line.rows.back(), Outcome::Collided);
  }
  sweep.verdict = verdict_of(held, sweep.lines.size());
  sweep.because = fmt::format(
      "In {} of {} lines F_int is zero but for rounding: the via is laid on the chord, and K_c "
      "acts on nothing. In {} of the other {} the share varies less at the largest K_c, where {} "
      "of their runs reach and {} collide.",
      sweep.lines.size() - active,
      sweep.lines.size(),
      held,
      active,
      reached,
      collided);
}

void judge_filter(Sweep& sweep, double /*tolerance_mm*/) {
  sweep.claim = "(The sources say nothing on what N does to the path; these are figures only.)";
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

std::vector<Plan> plans() {
  const char* clearance =
      "least clearance [mm] and outcome: r reached, s stuck, t out of time, C "
      "collided; * refused elsewhere, since S >= K_r d_safe";
  return {{&algo::kRepulsionGain,
           "K_r",
           {0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0},
           {"original", "modified_published", "modified"},
           clearance_cell,
           clearance,
           judge_repulsion},
          {&algo::kSafetyDistance,
           "d_safe",
           {0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.2},
           {"original", "modified_published", "modified"},
           clearance_cell,
           clearance,
           judge_safety_distance},
          {&algo::kContractionGain,
           "K_c",
           {0.0, 0.2, 0.4, 0.6, 0.8, 1.0},
           {"original", "modified", "via_kept"},
           strip_cell,
           "path [mm] / deviation of the share of the strip before its via point, and outcome",
           judge_contraction},
          {&algo::kFilterHalfWidth,
           "N",
           {0, 1, 2, 3, 5},
           {"original", "modified"},
           turning_cell,
           "least clearance [mm] / turning [rad], and outcome",
           judge_filter}};
}

void tabulate(Sweep& sweep, const Plan& plan) {
  sweep.legend = plan.legend;
  sweep.table.words = 2;
  sweep.table.header = {"scenario", "reading"};
  for (const double each : sweep.values) {
    const bool first = sweep.table.header.size() == sweep.table.words;
    sweep.table.header.push_back(first ? fmt::format("{} = {:g}", plan.name, each)
                                       : fmt::format("{:g}", each));
  }
  for (const SweepLine& line : sweep.lines) {
    std::vector<std::string> cells{line.layout, line.reading};
    for (std::size_t i = 0; i < line.rows.size(); ++i) {
      cells.push_back(plan.cell(line.rows[i]) + (line.refused[i] ? " *" : ""));
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

std::vector<Sweep> run_sweeps(const PaperFile& file,
                              std::size_t seeds,
                              std::uint64_t first_seed,
                              unsigned threads,
                              const Progress& progress) {
  const std::vector<Plan> all = plans();
  std::vector<Sweep> sweeps;
  std::vector<RowJob> jobs;
  for (const Plan& plan : all) {
    Sweep& sweep = sweeps.emplace_back();
    sweep.parameter = plan.name;
    sweep.values = plan.values;
    for (const Layout& layout : file.layouts) {
      for (const char* reading : plan.readings) {
        SweepLine& line = sweep.lines.emplace_back();
        line.layout = layout.name;
        line.reading = reading;
        for (const double each : plan.values) {
          RunSpec spec = make_run(file, layout, reading, kPaper, first_seed);
          spec.parameters.set(*plan.parameter, each);
          line.refused.push_back(algo::refusal(spec.parameters).has_value());
          jobs.push_back({layout.name, reading, std::move(spec), seeds});
        }
      }
    }
  }
  std::vector<Row> rows = run_rows(jobs, threads, progress);
  auto next = rows.begin();
  constexpr double kMillimetres = 1000;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (SweepLine& line : sweeps[i].lines) {
      const auto end = next + static_cast<std::ptrdiff_t>(line.refused.size());
      line.rows.assign(std::make_move_iterator(next), std::make_move_iterator(end));
      next = end;
    }
    all[i].judge(sweeps[i], file.common.noise * kMillimetres);
    tabulate(sweeps[i], all[i]);
  }
  return sweeps;
}

}  // namespace server::reproduce
