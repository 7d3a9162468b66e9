// server/lab/reproduce/full_strip.cpp: the comparison row by row.
#include "server/lab/reproduce/full_strip.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace server::reproduce {
namespace {

using algo::Outcome;

double value(const Row& row, std::string_view metric) {
  return figure(row, *find_metric(metric));
}

bool reaches(const Row& row) {
  return common_outcome(row) == Outcome::Reached;
}

std::string cell(const Row& row) {
  if (!reaches(row)) return outcomes_text(row);
  return fmt::format("{:.2f} / {:.2f} / {:.0f}",
                     value(row, "turning_rad"),
                     value(row, "curv2_e-3_rad2_per_mm"),
                     value(row, "time_s"));
}

/// "turns less in 40 of 45 (not: case2 original, ...)".
std::string part(const char* words, const std::vector<std::string>& against, std::size_t rows) {
  std::string text = fmt::format("{} in {} of {}", words, rows - against.size(), rows);
  if (!against.empty()) text += fmt::format(" (not: {})", fmt::join(against, ", "));
  return text;
}

}  // namespace

Depths least_depths(const PaperFile& file) {
  Depths depths;
  for (const Layout& layout : file.layouts) {
    double room = file.common.safety_distance;
    for (const algo::Obstacle& obstacle : layout.obstacles) {
      room = std::min({room,
                       signed_distance(obstacle, file.common.start.position()),
                       signed_distance(obstacle, layout.goal_W) + file.common.arrival_radius});
    }
    depths[layout.name] = (file.common.safety_distance - room) * 1000;
  }
  return depths;
}

StripBeside strip_beside(std::span<const Row> strip,
                         std::span<const Row> readings,
                         const Depths& least) {
  StripBeside out;
  for (const Row& row : strip) {
    if (!reaches(row)) out.not_reached.push_back(row.layout);
    const double depth = value(row, "safety_depth_mm");
    if (depth > 0) {
      const auto asked = least.find(row.layout);
      const bool must = asked != least.end() && asked->second > 0;
      out.entered.push_back(fmt::format("{} by {:.0f} mm{}",
                                        row.layout,
                                        depth,
                                        must ? fmt::format(" ({:.0f} mm at least, its goal being "
                                                           "that near)",
                                                           asked->second)
                                             : ""));
    }
  }
  for (const Row& row : readings) {
    const Row* own = find_row(strip, row.layout, kFullStrip);
    if (own == nullptr || !reaches(*own) || !reaches(row)) continue;
    ++out.rows;
    const auto compare = [&](std::string_view metric, std::vector<std::string>& against) {
      if (!(value(*own, metric) < value(row, metric))) {
        against.push_back(row.layout + " " + row.reading);
      }
    };
    compare("turning_rad", out.turns_less);
    compare("curv2_e-3_rad2_per_mm", out.bends_less);
    compare("time_s", out.faster);
  }
  return out;
}

Table strip_table(std::span<const Row> strip, std::span<const Row> readings) {
  Table table{.header = {"scenario", std::string(kFullStrip)}, .rows = {}, .words = 1};
  for (const Row& own : strip) {
    std::vector<std::string> line{own.layout, cell(own)};
    for (const Row& row : readings) {
      if (row.layout != own.layout) continue;
      if (table.rows.empty()) table.header.push_back(row.reading);
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
                                 : fmt::format("; into the safety circle it comes in {}. ",
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
