// server/experiment/sweep/sweep_figures.cpp: which figure is drawn how.
#include "server/experiment/sweep/sweep_figures.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "algo/driving.hpp"
#include "algo/pipeline/parameter_table.hpp"
#include "server/experiment/path_picture.hpp"
#include "server/experiment/row_chart.hpp"

namespace server::sweep {
namespace {

using experiment::RowChart;
using experiment::Summary;

struct Boxes {
  std::string_view column{};
  const char* title = "";
  const char* axis = "";
};
constexpr Boxes kBoxes[] = {
    {"time_s", "Time of the runs that reached their goal", "time [s]"},
    {"path_m", "Path of the runs that reached their goal", "path [m]"},
    {"min_clearance_m", "Least clearance of each run", "least clearance [m]"},
};

std::vector<std::string> labels_of(const Plan& plan) {
  std::vector<std::string> labels;
  for (const Arm& arm : plan.arms()) labels.push_back(arm.label);
  return labels;
}

Picture success(const Plan& plan, const Results& results) {
  const char* const title = "Rate of success, with 95 % intervals";
  RowChart chart(labels_of(plan), "runs that reached their goal / runs that ended", {0, 1});
  for (std::size_t row = 0; row < results.arms.size(); ++row) {
    const Rate& rate = results.arms[row].rates.front();
    if (rate.interval) chart.bar(row, rate.value(), rate.interval->bounds);
    if (!rate.interval) chart.words(row, "no runs");
  }
  return {"success.svg", title, chart.document(title)};
}

/// Nothing drawn if no arm has the figure.
std::optional<Picture> boxes(const Plan& plan, const Results& results, const Boxes& what) {
  const auto found = std::ranges::find(figures(), what.column, &Figure::column);
  const auto index = static_cast<std::size_t>(found - figures().begin());
  std::optional<experiment::Interval> range;
  for (const Group& group : results.arms) {
    const std::optional<Summary>& summary = group.figures[index];
    if (!summary) continue;
    if (!range) range = {summary->least, summary->largest};
    range->low = std::min(range->low, summary->least);
    range->high = std::max(range->high, summary->largest);
  }
  if (!range) return std::nullopt;
  RowChart chart(labels_of(plan), what.axis, *range);
  for (std::size_t row = 0; row < results.arms.size(); ++row) {
    const std::optional<Summary>& summary = results.arms[row].figures[index];
    if (summary) chart.box(row, *summary);
    if (!summary) chart.words(row, "no such run");
  }
  const std::string title = fmt::format("{}: quartiles, median, least and largest", what.title);
  return Picture{fmt::format("{}.svg", what.column), title, chart.document(title)};
}

/// The values of each swept parameter, in order; empty unless all their pairs are swept.
std::map<std::string, std::set<double>> grid_of(const Plan& plan) {
  std::map<std::string, std::set<double>> axes;
  for (const Point& point : plan.document().points) {
    for (const auto& [key, value] : point) axes[key].insert(value);
  }
  std::size_t cells = 1;
  for (const auto& [key, values] : axes) cells *= values.size();
  if (axes.size() != 2 || cells != plan.document().points.size()) return {};
  return axes;
}

std::vector<std::string> texts_of(const std::set<double>& values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double each : values) texts.push_back(fmt::format("{:.6g}", each));
  return texts;
}

/// "v_max [m/s]"; the key alone for a bare number.
std::string axis_of(const std::string& key) {
  const algo::ParameterInfo* const parameter = algo::find_parameter(key);
  const bool bare = parameter == nullptr || parameter->unit.empty();
  return bare ? key : fmt::format("{} [{}]", key, parameter->unit);
}

Picture heat_map_of(const Plan& plan,
                    const Results& results,
                    std::size_t controller,
                    const std::map<std::string, std::set<double>>& axes) {
  const auto& [row_key, row_values] = *axes.begin();
  const auto& [column_key, column_values] = *axes.rbegin();
  const auto place = [](const std::set<double>& values, double value) {
    return static_cast<std::size_t>(std::distance(values.begin(), values.find(value)));
  };
  std::vector<std::vector<double>> cells(row_values.size(),
                                         std::vector<double>(column_values.size(), std::nan("")));
  for (const Group& group : results.arms) {
    const Arm& arm = plan.arms()[group.arm];
    const Rate& rate = group.rates.front();
    if (arm.controller != controller || rate.runs == 0) continue;
    const Point& point = plan.document().points[arm.point];
    cells[place(row_values, point.at(row_key))][place(column_values, point.at(column_key))] =
        rate.value();
  }
  const std::string title =
      fmt::format("Rate of success of {}", plan.document().controllers[controller].label);
  return {fmt::format("heat_map_{}.svg", controller + 1),
          title,
          experiment::heat_map(title,
                               axis_of(row_key),
                               texts_of(row_values),
                               axis_of(column_key),
                               texts_of(column_values),
                               cells)};
}

/// Nothing while no run has a path.
std::optional<Picture> paths_in(const Plan& plan, const Rows& rows, std::size_t scenario) {
  std::vector<experiment::DrawnPath> paths;
  for (const std::size_t run : runs_with_path(plan, rows, scenario)) {
    const std::size_t arm = plan.place(run).arm;
    paths.push_back({fmt::format("{}: {}", plan.arms()[arm].label, algo::name(rows.outcome(run))),
                     rows.track_W(run),
                     arm});
  }
  if (paths.empty()) return std::nullopt;
  const sim::Scenario& drawn = plan.document().scenarios[scenario];
  const std::string title = fmt::format("{}: paths with seed {}", drawn.name, plan.document().seed);
  return Picture{fmt::format("paths_{}.svg", drawn.name),
                 title,
                 experiment::draw_paths(title, drawn, drawn.parameters[algo::kGoalReach], paths)};
}

}  // namespace

std::vector<std::size_t> runs_with_path(const Plan& plan, const Rows& rows, std::size_t scenario) {
  std::vector<std::size_t> runs;
  for (std::size_t arm = 0; arm < plan.arms().size(); ++arm) {
    if (plan.repeats(scenario, arm) == 0) continue;
    const std::size_t run = plan.number({scenario, arm, 0});
    if (!rows.track_W(run).empty()) runs.push_back(run);
  }
  return runs;
}

std::vector<Picture> pictures_of(const Plan& plan, const Rows& rows, const Results& results) {
  std::vector<Picture> all;
  if (plan.arms().size() <= kMostDrawn) {
    all.push_back(success(plan, results));
    for (const Boxes& each : kBoxes) {
      if (std::optional<Picture> picture = boxes(plan, results, each)) {
        all.push_back(std::move(*picture));
      }
    }
  }
  const std::map<std::string, std::set<double>> axes = grid_of(plan);
  const bool fits = std::ranges::all_of(
      axes, [](const auto& axis) { return axis.second.size() <= kMostDrawn / 2; });
  const std::size_t controllers = std::min(kMostMaps, plan.document().controllers.size());
  for (std::size_t c = 0; !axes.empty() && fits && c < controllers; ++c) {
    all.push_back(heat_map_of(plan, results, c, axes));
  }
  const std::size_t scenarios = std::min(kMostPathPictures, plan.document().scenarios.size());
  for (std::size_t s = 0; s < scenarios; ++s) {
    if (std::optional<Picture> picture = paths_in(plan, rows, s))
      all.push_back(std::move(*picture));
  }
  return all;
}

}  // namespace server::sweep
