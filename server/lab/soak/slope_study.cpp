// server/lab/soak/slope_study.cpp: worlds, each driven twice with the same stick.
#include "server/lab/soak/slope_study.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "algo/units.hpp"
#include "server/lab/soak/drive_hash.hpp"
#include "server/lab/soak/hand_drive.hpp"

namespace server::soak {
namespace {

using algo::units::kRadiansPerDegree;

constexpr std::uint64_t kFullStickPurpose = 0xF011;

double in_degrees(double radians) {
  return radians / kRadiansPerDegree;
}

using Choice = std::function<bool(const SlopeRow&)>;

void add_line(experiment::Table& table,
              const std::string& title,
              const std::vector<SlopeRow>& rows,
              const Choice& chosen) {
  int worlds = 0;
  int with = 0;
  int without = 0;
  std::vector<SlopeRow> mine;
  for (const SlopeRow& row : rows) {
    if (!chosen(row)) continue;
    ++worlds;
    if (row.guarded.overturned) ++with;
    if (row.unguarded.overturned) ++without;
    mine.push_back(row);
  }
  const double share = way_share(mine);
  table.rows.push_back({title,
                        fmt::format("{}", worlds),
                        fmt::format("{}", with),
                        fmt::format("{}", without),
                        std::isfinite(share) ? fmt::format("{:.0f}", 100 * share) : "-"});
}

}  // namespace

FullStick::FullStick(std::uint64_t seed) : random_(seed, kFullStickPurpose) {}

algo::Joystick FullStick::at(double stamp) {
  if (stamp < until_) return stick_;
  until_ = stamp + random_.uniform(0.4, 2.5);
  const double kind = random_.uniform();
  const double side = random_.uniform() < 0.5 ? -1 : 1;
  if (kind < 0.35) {
    stick_.forward = 1;
    stick_.turn = 0;
  } else if (kind < 0.80) {
    stick_.forward = 1;
    stick_.turn = side;
  } else if (kind < 0.90) {
    stick_.forward = 0;
    stick_.turn = side;
  } else {
    stick_.forward = -1;
    stick_.turn = kind < 0.95 ? 0 : side;
  }
  return stick_;
}

SlopeDrive drive_on_slopes(const SlopeWorld& world,
                           std::uint64_t seed,
                           double seconds,
                           bool with_guard) {
  HandDrive robot(world.scenario, seed, with_guard ? std::optional(world.believed) : std::nullopt);
  FullStick stick(seed);
  SlopeDrive drive{.hash = 0xcbf29ce484222325ULL};
  algo::Pose2 before_W = robot.truth().pose;
  while (robot.observation().stamp < seconds && !robot.overturned()) {
    robot.tick(stick.at(robot.observation().stamp));
    const sim::VehicleState& state = robot.state();
    drive.way += (state.pose_W.position() - before_W.position()).norm();
    before_W = state.pose_W;
    if (!robot.overturned()) {
      drive.steepest = std::max({drive.steepest, std::abs(state.roll), std::abs(state.pitch)});
    }
    for (const double value :
         {state.pose_W.x, state.pose_W.y, state.pose_W.heading, state.roll, state.pitch}) {
      mix(drive.hash, value);
    }
  }
  drive.seconds = robot.observation().stamp;
  drive.overturned = robot.overturned();
  return drive;
}

std::vector<SlopeRow> run_slopes(const SlopeOptions& options) {
  std::vector<SlopeRow> rows(options.pool.shard.share(options.worlds));
  experiment::for_each(
      options.worlds, options.pool, [&](std::size_t i, const std::stop_token& stop) {
        SlopeRow& row = rows[i / options.pool.shard.count];
        row.seed = options.first_seed + i;
        const SlopeWorld world = slope_world(row.seed);
        row.kind = world.kind;
        row.slope = world.steepest;
        row.friction = world.friction;
        row.mass_height = world.scenario.robot.mass_height;
        row.margin = world.margin;
        row.guarded = drive_on_slopes(world, row.seed, options.seconds, true);
        if (stop.stop_requested()) return;
        row.unguarded = drive_on_slopes(world, row.seed, options.seconds, false);
      });
  return rows;
}

int turned_over(const std::vector<SlopeRow>& rows) {
  return static_cast<int>(std::ranges::count_if(
      rows, [](const SlopeRow& row) { return row.counts() && row.guarded.overturned; }));
}

double way_share(const std::vector<SlopeRow>& rows) {
  double with = 0;
  double without = 0;
  for (const SlopeRow& row : rows) {
    if (row.unguarded.overturned) continue;
    with += row.guarded.way;
    without += row.unguarded.way;
  }
  return without > 0 ? with / without : std::numeric_limits<double>::quiet_NaN();
}

experiment::Table slopes_table(const std::vector<SlopeRow>& rows) {
  experiment::Table table{
      .header = {
          "", "worlds", "overturned with the guard", "without", "way with, % of that without"}};
  for (const SlopeKind kind : {SlopeKind::Slope, SlopeKind::Bank, SlopeKind::Crest}) {
    add_line(table, std::string(name(kind)), rows, [kind](const SlopeRow& row) {
      return row.kind == kind && row.counts();
    });
  }
  add_line(table, "all", rows, [](const SlopeRow& row) { return row.counts(); });
  add_line(table, "standing margin 3 degrees or less", rows, [](const SlopeRow& row) {
    return !row.counts();
  });
  return table;
}

experiment::Table slope_rows(const std::vector<SlopeRow>& rows) {
  experiment::Table table{.header = {"world",
                                     "kind",
                                     "slope_deg",
                                     "friction",
                                     "mass_height_m",
                                     "margin_deg",
                                     "overturned_with",
                                     "overturned_without",
                                     "seconds_with",
                                     "seconds_without",
                                     "way_with_m",
                                     "way_without_m",
                                     "steepest_with_deg",
                                     "steepest_without_deg"}};
  for (const SlopeRow& row : rows) {
    std::vector<std::string>& line = table.rows.emplace_back();
    line = {fmt::format("{}", row.seed), std::string(name(row.kind))};
    for (const double value :
         {in_degrees(row.slope), row.friction, row.mass_height, in_degrees(row.margin)}) {
      line.push_back(fmt::format("{:.3f}", value));
    }
    for (const bool over : {row.guarded.overturned, row.unguarded.overturned}) {
      line.push_back(over ? "1" : "0");
    }
    for (const double value : {row.guarded.seconds,
                               row.unguarded.seconds,
                               row.guarded.way,
                               row.unguarded.way,
                               in_degrees(row.guarded.steepest),
                               in_degrees(row.unguarded.steepest)}) {
      line.push_back(fmt::format("{:.1f}", value));
    }
  }
  return table;
}

}  // namespace server::soak
