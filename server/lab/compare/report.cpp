// server/lab/compare/report.cpp: tables and JSON.
#include "server/lab/compare/report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "server/lab/reproduce/report.hpp"

namespace server::compare {
namespace {

using algo::Outcome;
using experiment::all_reach;
using experiment::count;
using experiment::figure;
using experiment::find_series;
using experiment::Table;
using nlohmann::json;
using reproduce::kMillimetres;

bool keeps_circle(const Series& row) {
  return figure(row, "safety_depth_m") <= 0;
}

/// The names of the scenes, each once, in the order of the rows.
std::vector<std::string> scenes_of(const std::vector<Series>& rows) {
  std::vector<std::string> names;
  for (const Series& row : rows) {
    if (row.controller != rows.front().controller) break;
    names.push_back(row.scenario);
  }
  return names;
}

/// The contestants of the rows, each once, in their order.
std::vector<std::string> readings_of(const std::vector<Series>& rows) {
  std::vector<std::string> names;
  for (const Series& row : rows) {
    if (names.empty() || names.back() != row.controller) names.push_back(row.controller);
  }
  return names;
}

std::string number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

/// "65 / 0.34", or "2 reached, 1 stuck".
std::string world_cell(const Series& row) {
  if (!all_reach(row)) return outcomes_text(row);
  return fmt::format(
      "{:.0f} / {}", figure(row, "time_s"), number(figure(row, "min_clearance_m"), 2));
}

std::vector<std::string> layouts_line(const std::vector<const Series*>& rows, std::string name) {
  std::size_t runs = 0, reached = 0, stuck = 0, late = 0, collided = 0, always = 0, kept = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Series* row : rows) {
    runs += row->runs.size();
    reached += count(*row, Outcome::Reached);
    stuck += count(*row, Outcome::Stuck);
    late += count(*row, Outcome::OutOfTime);
    collided += count(*row, Outcome::Collided);
    nearest = std::min(nearest, figure(*row, "min_clearance_m") * kMillimetres);
    if (!all_reach(*row)) continue;
    ++always;
    kept += keeps_circle(*row) ? 1U : 0U;
  }
  return {std::move(name),
          fmt::format("{} of {}", always, rows.size()),
          fmt::format("{} of {}", reached, runs),
          std::to_string(stuck),
          std::to_string(late),
          std::to_string(collided),
          std::to_string(kept),
          number(nearest, 0)};
}

json rows_json(const std::vector<Series>& rows) {
  json all = json::array();
  for (const Series& row : rows) {
    all.push_back({{"scenario", row.scenario},
                   {"controller", row.controller},
                   {"metrics", experiment::figures_json(row)}});
  }
  return all;
}

}  // namespace

Table worlds_table(const Comparison& comparison) {
  Table table{.header = {""}, .rows = {}, .words = 1};
  for (const std::string& scene : scenes_of(comparison.worlds)) table.header.push_back(scene);
  for (const std::string& contestant : comparison.labels) {
    std::vector<std::string> line{contestant};
    for (const Series* row : rows_of(comparison.worlds, contestant))
      line.push_back(world_cell(*row));
    table.rows.push_back(std::move(line));
  }
  return table;
}

Table details_table(const Comparison& comparison) {
  Table table{.header = {"scenario",
                         "controller",
                         "outcome",
                         "time s",
                         "clearance mm",
                         "path mm",
                         "standing s",
                         "pauses",
                         "in pauses s"},
              .rows = {},
              .words = 3};
  std::vector<experiment::Column> more;  // of the further judges
  for (const std::string& judge : comparison.options.judges) {
    const auto columns = experiment::find_judge(judge).columns;
    more.insert(more.end(), columns.begin(), columns.end());
  }
  for (const experiment::Column& column : more) table.header.emplace_back(column.name);
  for (const std::string& scene : scenes_of(comparison.worlds)) {
    for (const std::string& contestant : comparison.labels) {
      const Series& row = *find_series(comparison.worlds, scene, contestant);
      table.rows.push_back({scene,
                            contestant,
                            outcomes_text(row),
                            number(figure(row, "time_s"), 1),
                            number(figure(row, "min_clearance_m") * kMillimetres, 0),
                            number(figure(row, "path_m") * kMillimetres, 0),
                            number(figure(row, "standing_s"), 1),
                            number(figure(row, "pauses"), 1),
                            number(figure(row, "pause_s"), 2)});
      for (const experiment::Column& column : more) {
        table.rows.back().push_back(number(figure(row, column.name), column.digits));
      }
    }
  }
  return table;
}

Table bottlenecks_table(const Comparison& comparison) {
  Table table{.header = {"gap m"}, .rows = {}, .words = 1};
  for (const double gap : bottleneck_gaps()) table.header.push_back(fmt::format("{:.1f}", gap));
  for (const char* title : {"passes from m", "passed", "stuck", "out of time", "collided"}) {
    table.header.emplace_back(title);
  }
  for (const std::string& contestant : comparison.labels) {
    std::vector<std::string> line{contestant};
    for (const Series* row : rows_of(comparison.bottlenecks, contestant)) {
      line.push_back(outcome_letters(*row));
    }
    const Passage passage = passage_of(comparison.bottlenecks, contestant);
    line.push_back(passage.smallest ? fmt::format("{:.1f}", *passage.smallest) : "-");
    line.push_back(fmt::format("{} of {}", passage.passed, passage.runs));
    for (const std::size_t runs : {passage.stuck, passage.out_of_time, passage.collided}) {
      line.push_back(std::to_string(runs));
    }
    table.rows.push_back(std::move(line));
  }
  return table;
}

Table layouts_table(const LayoutSet& set) {
  Table table{.header = {"controller",
                         "layouts reached by every seed",
                         "runs reached",
                         "stuck",
                         "out of time",
                         "collided",
                         "of the first, circle kept",
                         "least clearance mm"},
              .rows = {},
              .words = 1};
  for (const std::string& controller : readings_of(set.paper)) {
    table.rows.push_back(layouts_line(rows_of(set.paper, controller), controller));
  }
  for (const std::string& controller : readings_of(set.full)) {
    table.rows.push_back(
        layouts_line(rows_of(set.full, controller), controller + ", full simulator"));
  }
  return table;
}

Table beside_original_table(const LayoutSet& set) {
  Table table{.header = {"controller",
                         "both reach",
                         "original enters the circle",
                         "it keeps the circle",
                         "it turns less",
                         "it is faster"},
              .rows = {},
              .words = 1};
  for (const std::string& controller : readings_of(set.paper)) {
    if (controller == "original") continue;
    std::size_t both = 0, entered = 0, kept = 0, less = 0, faster = 0;
    for (const Series* row : rows_of(set.paper, controller)) {
      const Series& original = *find_series(set.paper, row->scenario, "original");
      if (!all_reach(*row) || !all_reach(original)) continue;
      ++both;
      entered += keeps_circle(original) ? 0U : 1U;
      kept += keeps_circle(*row) ? 1U : 0U;
      less += figure(*row, "turning_rad") < figure(original, "turning_rad") ? 1U : 0U;
      faster += figure(*row, "time_s") < figure(original, "time_s") ? 1U : 0U;
    }
    std::vector<std::string> line{controller};
    for (const std::size_t layouts : {both, entered, kept, less, faster}) {
      line.push_back(std::to_string(layouts));
    }
    table.rows.push_back(std::move(line));
  }
  return table;
}

Table rows_table(const Comparison& comparison) {
  Table table;
  for (const std::vector<Series>* all : {&comparison.worlds, &comparison.bottlenecks}) {
    for (const Series& series : *all) {
      for (std::size_t i = 0; i < series.runs.size(); ++i) {
        add_run(table,
                {"scenario", "controller", "seed"},
                {series.scenario,
                 series.controller,
                 fmt::format("{}", comparison.options.first_seed + i)},
                series.runs[i]);
      }
    }
  }
  return table;
}

json to_json(const Comparison& comparison) {
  json findings = json::array();
  for (const Finding& each : comparison.findings) {
    findings.push_back({{"claim", each.claim},
                        {"verdict", name(each.verdict)},
                        {"because", each.because},
                        {"rule", each.rule}});
  }
  json sets = json::array();
  for (const LayoutSet& set : comparison.layouts) {
    sets.push_back({{"obstacles", set.obstacles},
                    {"k_r", set.repulsion_gain},
                    {"paper_conditions", rows_json(set.paper)},
                    {"full_simulator", rows_json(set.full)}});
  }
  json out = {{"seeds", comparison.options.seeds},
              {"first_seed", comparison.options.first_seed},
              {"worlds", rows_json(comparison.worlds)},
              {"bottlenecks", rows_json(comparison.bottlenecks)},
              {"claims", findings},
              {"random_layouts", sets}};
  if (!comparison.layouts.empty()) {
    const LayoutResult strip = strip_on_layouts(comparison.layouts);
    out["strip_on_random_layouts"] = {{"runs", strip.runs},
                                      {"reached", strip.reached},
                                      {"collided", strip.collided},
                                      {"held", strip.held()}};
  }
  return out;
}

}  // namespace server::compare
