// server/lab/buildings/building_kinds.cpp: draws walls and doors.
#include "server/lab/buildings/building_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace server::buildings {
namespace {

constexpr std::array<std::string_view, kKinds.size()> kNames{
    "maze", "flat", "office", "hall", "dead_ends", "spiral"};
constexpr int kMostCells = 24;     // of a maze along an edge
constexpr double kDoorRoom = 0.4;  // [m] by which a corridor is wider than a door in it
constexpr double kLeast = 10.0;    // [m] edge of a building
constexpr double kMost = 60.0;
constexpr std::array<CellPlace, 4> kAround{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

CellPlace beside(CellPlace c, CellPlace step) {
  return {c.column + step.column, c.row + step.row};
}

/// A length on the raster.
double length_of(sim::Random& random, double low, double high) {
  return kRaster * std::round(random.uniform(low, high) / kRaster);
}

/// Lines with distances between `low` and `high` [m], until `length` is reached.
std::vector<double> lines(sim::Random& random, double low, double high, double length) {
  std::vector<double> out{0};
  while (out.back() < length) out.push_back(out.back() + length_of(random, low, high));
  return out;
}

/// Joins all cells by a random tree. `join(a, b)` is called for each pair that it joins. A depth
/// first tree has long ways without branches.
template <typename Join>
void join_all(const FloorPlan& plan, sim::Random& random, Join&& join) {
  const auto count =
      static_cast<std::size_t>(plan.columns()) * static_cast<std::size_t>(plan.rows());
  std::vector<bool> joined(count);
  const auto index = [&](CellPlace c) {
    return static_cast<std::size_t>(c.row) * static_cast<std::size_t>(plan.columns()) +
           static_cast<std::size_t>(c.column);
  };
  std::vector<CellPlace> way{{0, 0}};
  joined[0] = true;
  while (!way.empty()) {
    std::vector<CellPlace> next;
    for (const CellPlace& step : kAround) {
      const CellPlace c = beside(way.back(), step);
      if (plan.holds(c) && !joined[index(c)]) next.push_back(c);
    }
    if (next.empty()) {
      way.pop_back();
      continue;
    }
    const CellPlace c = next[random.below(next.size())];
    joined[index(c)] = true;
    join(way.back(), c);
    way.push_back(c);
  }
}

/// Calls `visit(a, b)` for each pair of neighbouring cells with a wall between them.
template <typename Visit>
void each_wall(const FloorPlan& plan, Visit&& visit) {
  for (int j = 0; j < plan.rows(); ++j) {
    for (int i = 0; i < plan.columns(); ++i) {
      for (const CellPlace& step : {CellPlace{1, 0}, CellPlace{0, 1}}) {
        const CellPlace b = beside({i, j}, step);
        if (plan.holds(b) && plan.between({i, j}, b).kind == Edge::Kind::Wall)
          visit(CellPlace{i, j}, b);
      }
    }
  }
}

/// A pitch of corridors: their width is a door's, or more.
double pitch_of(double door_width, sim::Random& random) {
  const std::array pitches{door_width + kWall, 1.4, 1.8, 2.2};
  return pitches.at(random.below(pitches.size()));
}

int cells_of(double length, double pitch) {
  return std::clamp(static_cast<int>(length / pitch), 5, kMostCells);
}

/// Opens an edge, or puts a door there with the probability `share` if the corridor is wide enough.
void pass(FloorPlan& plan, sim::Random& random, CellPlace a, CellPlace b, double share) {
  const algo::Vec2 size = plan.high(a) - plan.low(a);
  const bool wide = size.minCoeff() > plan.door_width() + kDoorRoom;
  const bool door = random.uniform() < share;
  const double at = random.uniform();
  if (door && wide) {
    plan.put_door(a, b, at);
  } else {
    plan.open(a, b);
  }
}

FloorPlan maze(double door_width, sim::Random& random) {
  constexpr double kLoops = 0.05;
  constexpr double kDoors = 0.12;
  const double pitch = pitch_of(door_width, random);
  const int columns = cells_of(random.uniform(kLeast, kMost), pitch);
  const int rows = std::max(4, static_cast<int>(columns * random.uniform(0.5, 1)));
  FloorPlan plan = FloorPlan::uniform(columns, rows, pitch, door_width);
  join_all(plan, random, [&](CellPlace a, CellPlace b) { pass(plan, random, a, b, kDoors); });
  each_wall(plan, [&](CellPlace a, CellPlace b) {
    if (random.uniform() < kLoops) pass(plan, random, a, b, kDoors);
  });
  return plan;
}

FloorPlan flat(double door_width, sim::Random& random) {
  constexpr double kExtraDoors = 0.25;
  constexpr double kNoDoor = 0.1;
  std::vector<double> xs = lines(random, 2.6, 4.6, random.uniform(kLeast, 20));
  std::vector<double> ys = lines(random, 2.6, 4.6, random.uniform(6, 14));
  FloorPlan plan(std::move(xs), std::move(ys), door_width);
  join_all(plan, random, [&](CellPlace a, CellPlace b) {
    const bool open = random.uniform() < kNoDoor;
    const double at = random.uniform();
    if (open) {
      plan.open(a, b);
    } else {
      plan.put_door(a, b, at);
    }
  });
  each_wall(plan, [&](CellPlace a, CellPlace b) {
    const bool door = random.uniform() < kExtraDoors;
    const double at = random.uniform();
    if (door) plan.put_door(a, b, at);
  });
  return plan;
}

FloorPlan office(double door_width, sim::Random& random) {
  constexpr double kJoined = 0.2;
  constexpr double kAcross = 0.15;  // doors across the corridor
  constexpr int kCorridor = 1;
  const double depth = length_of(random, 3, 6);
  const double corridor = length_of(random, 1.6, 2.4);
  std::vector<double> ys{0, depth, depth + corridor, depth + corridor + length_of(random, 3, 6)};
  FloorPlan plan(lines(random, 2.8, 5, random.uniform(20, kMost - 5)), std::move(ys), door_width);
  for (int i = 0; i < plan.columns(); ++i) {
    for (const int row : {kCorridor - 1, kCorridor + 1}) {
      plan.put_door({i, row}, {i, kCorridor}, random.uniform());
      const bool joined = random.uniform() < kJoined;
      const double at = random.uniform();
      if (joined && i > 0) plan.put_door({i - 1, row}, {i, row}, at);
    }
    if (i > 0) pass(plan, random, {i - 1, kCorridor}, {i, kCorridor}, kAcross);
  }
  return plan;
}

FloorPlan hall(double door_width, sim::Random& random) {
  const auto halls = static_cast<int>(1 + random.below(3));
  std::vector<double> xs{0};
  for (int k = 0; k < halls; ++k) {
    xs.push_back(xs.back() + length_of(random, kLeast, (kMost - 2) / halls));
  }
  FloorPlan plan(std::move(xs), {0, length_of(random, kLeast, 30)}, door_width);
  for (int k = 1; k < halls; ++k) plan.put_door({k - 1, 0}, {k, 0}, random.uniform());
  return plan;
}

/// A lobby, lanes that lead up from it, and a corridor above them.
FloorPlan dead_ends(double door_width, sim::Random& random) {
  constexpr int kLobby = 0;
  constexpr int kLane = 1;
  constexpr int kBeyond = 2;
  const double width = std::max(length_of(random, 1.2, 2.4), door_width + kDoorRoom + 2 * kWall);
  const auto lanes = static_cast<int>(4 + random.below(9));
  std::vector<double> xs{0};
  for (int k = 0; k < lanes; ++k) xs.push_back(xs.back() + width);
  const double lobby = length_of(random, 1.8, 4);
  const double lane = length_of(random, 8, 25);
  FloorPlan plan(std::move(xs),
                 {0, lobby, lobby + lane, lobby + lane + length_of(random, 1.8, 4)},
                 door_width);
  const auto through = static_cast<int>(random.below(static_cast<std::size_t>(lanes)));
  for (int k = 0; k < lanes; ++k) {
    if (k > 0) plan.open({k - 1, kLobby}, {k, kLobby});
    if (k > 0) plan.open({k - 1, kBeyond}, {k, kBeyond});
    plan.open({k, kLobby}, {k, kLane});
    if (k == through) plan.put_door({k, kLane}, {k, kBeyond}, random.uniform());
  }
  return plan;
}

FloorPlan spiral(double door_width, sim::Random& random) {
  constexpr double kDoors = 0.06;
  const double pitch = pitch_of(door_width, random);
  const int side = std::min(cells_of(random.uniform(kLeast, 30), pitch), 15);
  FloorPlan plan = FloorPlan::uniform(side, side, pitch, door_width);
  std::vector<bool> passed(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  const auto index = [&](CellPlace c) {
    return static_cast<std::size_t>(c.row) * static_cast<std::size_t>(side) +
           static_cast<std::size_t>(c.column);
  };
  CellPlace at{0, 0};
  passed[0] = true;
  std::size_t turn = 0;
  for (int k = 1; k < side * side; ++k) {
    CellPlace next = beside(at, kAround.at(turn));
    if (!plan.holds(next) || passed[index(next)]) {
      turn = (turn + 1) % kAround.size();
      next = beside(at, kAround.at(turn));
    }
    pass(plan, random, at, next, kDoors);
    passed[index(next)] = true;
    at = next;
  }
  return plan;
}

}  // namespace

std::string_view name(Kind kind) {
  return kNames.at(static_cast<std::size_t>(kind));
}

Kind kind_named(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) {
    throw std::invalid_argument(fmt::format(
        "No kind of building is called '{}'; there are {}.", name, fmt::join(kNames, ", ")));
  }
  return kKinds.at(static_cast<std::size_t>(found - kNames.begin()));
}

FloorPlan draw_plan(Kind kind, double door_width, sim::Random& random) {
  switch (kind) {
    case Kind::Maze:
      return maze(door_width, random);
    case Kind::Flat:
      return flat(door_width, random);
    case Kind::Office:
      return office(door_width, random);
    case Kind::Hall:
      return hall(door_width, random);
    case Kind::DeadEnds:
      return dead_ends(door_width, random);
    default:
      return spiral(door_width, random);
  }
}

}  // namespace server::buildings
