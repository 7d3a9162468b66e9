// server/lab/buildings/tour_study.cpp: runs tours, and counts how their legs ended.
#include "server/lab/buildings/tour_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace server::buildings {
namespace {

constexpr std::size_t kEarly = 20;  // legs after which the memory is read first

/// The figures of some tours.
struct TourFigures {
  std::size_t tours = 0;
  std::size_t legs = 0;
  std::array<std::size_t, kVerdicts> verdicts{};
  double drift = 0;                 // [m] the largest at the end of a leg
  double doubled = 0;               // the largest share
  double early_mb = 0, end_mb = 0;  // the largest
  std::size_t count(Verdict verdict) const {
    return verdicts.at(static_cast<std::size_t>(verdict));
  }
};

void add(const Tour& tour, TourFigures& sum) {
  ++sum.tours;
  sum.legs += tour.legs.size();
  for (const Leg& leg : tour.legs) {
    ++sum.verdicts.at(static_cast<std::size_t>(verdict_of(leg)));
    sum.drift = std::max(sum.drift, leg.drift);
  }
  sum.doubled = std::max(sum.doubled, tour.doubled);
  if (tour.legs.empty()) return;
  const std::size_t early = std::min(kEarly, tour.legs.size()) - 1;
  sum.early_mb = std::max(sum.early_mb, tour.legs[early].memory_mb);
  sum.end_mb = std::max(sum.end_mb, tour.legs.back().memory_mb);
}

const std::vector<std::string> kFigureTitles{"goals",
                                             "reached",
                                             "refused rightly",
                                             "refused wrongly",
                                             "late",
                                             "searched",
                                             "blocked",
                                             "collided",
                                             "drift m",
                                             "doubled %",
                                             "memory at goal 20 MB",
                                             "at the end MB"};

std::vector<std::string> cells_of(const TourFigures& f) {
  std::vector<std::string> cells{fmt::format("{}", f.legs)};
  for (const std::size_t count : f.verdicts) cells.push_back(fmt::format("{}", count));
  cells.push_back(fmt::format("{:.2f}", f.drift));
  cells.push_back(std::isnan(f.doubled) ? "" : fmt::format("{:.1f}", 100 * f.doubled));
  cells.push_back(fmt::format("{:.0f}", f.early_mb));
  cells.push_back(fmt::format("{:.0f}", f.end_mb));
  return cells;
}

std::vector<std::string> cells_of(const Tour& tour, std::size_t i) {
  const Leg& leg = tour.legs[i];
  return {fmt::format("{}", tour.seed),
          std::string(name(tour.building.kind)),
          std::string(name(tour.odometry)),
          std::string(name(leg.goal.place)),
          std::string(way_word(leg.goal.truth)),
          std::string(name(leg.end)),
          std::string(name(verdict_of(leg))),
          leg.reason,
          fmt::format("{}", i),
          fmt::format("{:.1f}", leg.goal.truth.time.value_or(std::nan(""))),
          fmt::format("{:.1f}", leg.seconds),
          fmt::format("{:.2f}", leg.goal.position_W.x()),
          fmt::format("{:.2f}", leg.goal.position_W.y()),
          fmt::format("{:.2f}", leg.end_W.x()),
          fmt::format("{:.2f}", leg.end_W.y()),
          fmt::format("{:.3f}", leg.drift),
          fmt::format("{:.1f}", leg.memory_mb)};
}

experiment::Table chosen_legs(const std::vector<Tour>& tours, bool (*chosen)(const Leg& leg)) {
  experiment::Table table{.header = {"seed",
                                     "kind",
                                     "odometry",
                                     "place",
                                     "way",
                                     "end",
                                     "verdict",
                                     "reason",
                                     "goal",
                                     "oracle_s",
                                     "time_s",
                                     "goal_x_m",
                                     "goal_y_m",
                                     "end_x_m",
                                     "end_y_m",
                                     "drift_m",
                                     "memory_mb"},
                          .words = 8};
  for (const Tour& tour : tours) {
    for (std::size_t i = 0; i < tour.legs.size(); ++i) {
      if (chosen(tour.legs[i])) table.rows.push_back(cells_of(tour, i));
    }
  }
  return table;
}

}  // namespace

std::vector<Tour> run_tours(const TourStudyOptions& options) {
  const std::vector<std::uint64_t> seeds = seeds_of(options.buildings);
  const std::size_t each = options.odometries.size();
  const experiment::PoolOptions& pool = options.buildings.pool;
  std::vector<Tour> tours(pool.shard.share(seeds.size() * each));
  experiment::for_each(seeds.size() * each, pool, [&](std::size_t i, const std::stop_token& stop) {
    tours[i / pool.shard.count] = drive_tour(seeds[i / each],
                                             {.goals = options.goals,
                                              .controller = options.buildings.controller,
                                              .odometry = options.odometries[i % each]},
                                             stop);
  });
  return tours;
}

experiment::Table tours_table(const std::vector<Tour>& tours) {
  experiment::Table table{.header = {"odometry", "building"}, .words = 2};
  table.header.insert(table.header.end(), kFigureTitles.begin(), kFigureTitles.end());
  const auto add_row = [&](Odometry odometry, std::string building, const TourFigures& figures) {
    std::vector<std::string> row{std::string(name(odometry)), std::move(building)};
    std::vector<std::string> cells = cells_of(figures);
    std::ranges::move(cells, std::back_inserter(row));
    table.rows.push_back(std::move(row));
  };
  for (const Odometry odometry : kOdometries) {
    TourFigures sum;
    for (const Tour& tour : tours) {
      if (tour.odometry != odometry) continue;
      TourFigures one;
      add(tour, one);
      add(tour, sum);
      add_row(
          odometry,
          fmt::format(
              "{}, {}, {:.2f} m", tour.seed, name(tour.building.kind), tour.building.door_width),
          one);
    }
    if (sum.tours > 0) add_row(odometry, "all", sum);
  }
  return table;
}

experiment::Table tour_faults_table(const std::vector<Tour>& tours) {
  return chosen_legs(tours, is_fault);
}

experiment::Table legs_table(const std::vector<Tour>& tours) {
  return chosen_legs(tours, [](const Leg&) { return true; });
}

nlohmann::json tours_json(const std::vector<Tour>& tours) {
  return {{"tours", experiment::to_json(tours_table(tours))},
          {"faults", experiment::to_json(tour_faults_table(tours))}};
}

}  // namespace server::buildings
