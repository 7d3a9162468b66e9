// server/lab/reproduce/full_strip.cpp: the comparison row by row.
#include "server/lab/reproduce/full_strip.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace server::reproduce {
namespace {

using algo::Outcome;

std::string cell(const Series& row) {
  if (!all_reach(row)) return outcomes_text(row);
  return fmt::format("{:.2f} / {:.2f} / {:.0f}",
                     figure(row, "turning_rad"),
                     figure(row, "bending_rad2_per_m"),
                     figure(row, "time_s"));
}

/// "turns less in 40 of 45 (not: case2 original, ...)".
std::string part(const char* words, const std::vector<std::string>& against, std::size_t rows) {
  std::string text = fmt::format("{} in {} of {}", words, rows - against.size(), rows);
  if (!against.empty()) text += fmt::format(" (not: {})", fmt::join(against, ", "));
  return text;
}

}  // namespace

Depths least_depths(const StudyFile& file) {
  const PaperConditions& paper = file.conditions;
  Depths depths;
  for (const sim::Scenario& scenario : file.scenarios) {
    double room = paper.safety_distance;
    for (const algo::Obstacle& obstacle : scenario.obstacles) {
      room =
          std::min({room,
                    signed_distance(obstacle, scenario.start.position()),
                    signed_distance(obstacle, scenario.goal->position_W) + paper.arrival_radius});
    }
    depths[scenario.name] = paper.safety_distance - room;
  }
  return depths;
}

StripBeside strip_beside(std::span<const Series> strip,
                         std::span<const Series> readings,
                         const Depths& least) {
  StripBeside out;
  for (const Series& row : strip) {
    if (!all_reach(row)) out.not_reached.push_back(row.scenario);
    const double depth = figure(row, "safety_depth_m");
    if (depth > 0) {
      const auto asked = least.find(row.scenario);
      const bool must = asked != least.end() && asked->second > 0;
      out.entered.push_back(fmt::format("{} by {:.0f} mm{}",
                                        row.scenario,
                                        depth * kMillimetres,
                                        must ? fmt::format(" ({:.0f} mm at least, because its "
                                                           "goal is that near)",
                                                           asked->second * kMillimetres)
                                             : ""));
    }
  }
  for (const Series& row : readings) {
    const Series* own = find_series(strip, row.scenario, kFullStrip);
    if (own == nullptr || !all_reach(*own) || !all_reach(row)) continue;
    ++out.rows;
    const auto compare = [&](std::string_view metric, std::vector<std::string>& against) {
      if (!(figure(*own, metric) < figure(row, metric))) {
        against.push_back(row.scenario + " " + row.controller);
      }
    };
    compare("turning_rad", out.turns_less);
    compare("bending_rad2_per_m", out.bends_less);
    compare("time_s", out.faster);
  }
  return out;
}

Table strip_table(std::span<const Series> strip, std::span<const Series> readings) {
  Table table{.header = {"scenario", std::string(kFullStrip)}, .rows = {}, .words = 1};
  for (const Series& own : strip) {
    std::vector<std::string> line{own.scenario, cell(own)};
    for (const Series& row : readings) {
      if (row.scenario != own.scenario) continue;
      if (table.rows.empty()) table.header.push_back(row.controller);
      line.push_back(cell(row));
    }
    table.rows.push_back(std::move(line));
  }
  return table;
}

std::string strip_sentences(const StripBeside& beside) {
  std::string text = beside.not_reached.empty() ? std::string("It reaches every goal in every run")
                                                : fmt::format("It does not reach in every run: {}",
                                                              fmt::join(beside.not_reached, ", "));
  text += beside.entered.empty() ? std::string(" and keeps out of the safety circle everywhere. ")
                                 : fmt::format("; it enters the safety circle in {}. ",
                                               fmt::join(beside.entered, ", "));
  const bool best = beside.turns_less.empty() && beside.bends_less.empty() && beside.faster.empty();
  text += fmt::format(
      "Of the {} rows of readings that reach, it {}; it {}; it {}. Smoother and faster than every "
      "reading: {}.",
      beside.rows,
      part("turns less", beside.turns_less, beside.rows),
      part("bends less", beside.bends_less, beside.rows),
      part("is faster", beside.faster, beside.rows),
      best ? "holds" : "holds only in part");
  return text;
}

}  // namespace server::reproduce
