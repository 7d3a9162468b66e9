// server/lab/buildings/building_world.cpp: start, goal, and the door on the way.
#include "server/lab/buildings/building_world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "algo/driving.hpp"
#include "server/lab/buildings/furniture.hpp"
#include "server/lab/buildings/grid_oracle.hpp"

namespace server::buildings {
namespace {

using algo::Vec2;

constexpr double kHull = 0.35;         // [m] radius of the Silvermate
constexpr double kRoomAtStart = 0.40;  // [m] from the middle to a surface
constexpr double kRoomAtGoal = 0.45;   // [m]
constexpr double kNoseOn = 0.025;      // [m]
constexpr double kNear = 8.0;          // [m] a near goal is within it
constexpr int kPlaces = 400;           // places tried
constexpr int kFarPlaces = 12;         // of which a far goal is the farthest
constexpr double kGap = 0.79;          // [m] a way is nowhere narrower
constexpr double kUnderDoor = 0.01;    // [m] narrower than the doors, where those are narrower
constexpr double kNoGap = 0.69;        // [m] gaps narrower than this are none
constexpr double kGoalReach = 0.1;     // [m] algo::kGoalReach's initial value
constexpr double kLeaf = 0.06;         // [m] thickness of a sliding door
constexpr double kLeastWay = 3.0;      // [m] from the start to a timed door
constexpr double kEndOfTime = 36'000;  // [s]
constexpr std::uint64_t kBuildingPurpose = 0xB51D;

constexpr std::array<std::string_view, 4> kGoalNames{"near", "far", "shut_in", "inside"};

CellPlace cell_at(const FloorPlan& plan, const Vec2& p_W) {
  CellPlace c;
  while (c.column + 1 < plan.columns() && p_W.x() > plan.high(c).x() + kWall / 2) ++c.column;
  while (c.row + 1 < plan.rows() && p_W.y() > plan.high(c).y() + kWall / 2) ++c.row;
  return c;
}

/// Adds to a building, step by step.
class Builder {
 public:
  Builder(Building& building, std::uint64_t seed)
      : building_(building),
        random_(seed, kBuildingPurpose),
        plan_(draw_plan(building.kind, building.door_width, random_)) {}

  void build() {
    const double share = random_.uniform();
    building_.goal_place = share < 0.30   ? GoalPlace::Near
                           : share < 0.70 ? GoalPlace::Far
                           : share < 0.85 ? GoalPlace::ShutIn
                                          : GoalPlace::Inside;
    obstacles() = plan_.walls();
    furnish(plan_, random_, obstacles());
    const Vec2 start_W = place_start();
    const Vec2 goal_W = place_goal(start_W);
    if (building_.goal_place == GoalPlace::ShutIn) shut_in(goal_W, start_W);
    if (building_.goal_place == GoalPlace::Inside) bury(goal_W, start_W);
    building_.scenario.goal = algo::SetGoal{goal_W, std::nullopt};
    const bool timed = random_.uniform() < 0.5;
    const double wait = random_.uniform(15, 45);
    if (timed) add_timed_door(start_W, goal_W, wait);
  }

 private:
  std::vector<algo::Obstacle>& obstacles() { return building_.scenario.obstacles; }
  void add(const algo::Pose2& pose_W, algo::Shape shape) {
    algo::Obstacle obstacle;
    obstacle.id = static_cast<std::uint32_t>(obstacles().size() + 1);
    obstacle.pose_W = pose_W;
    obstacle.shape = std::move(shape);
    obstacles().push_back(obstacle);
  }

  /// A place in any cell with `room` [m] around it; the middle of a cell if narrow cells have no
  /// such place.
  Vec2 anywhere(const GridOracle& oracle, double room) {
    Vec2 p_W{0, 0};
    for (int k = 0; k < kPlaces; ++k) {
      const auto column =
          static_cast<int>(random_.below(static_cast<std::size_t>(plan_.columns())));
      const auto row = static_cast<int>(random_.below(static_cast<std::size_t>(plan_.rows())));
      const Vec2 size = plan_.high({column, row}) - plan_.low({column, row});
      const double u = random_.uniform();
      const double v = random_.uniform();
      const Vec2 at_W = plan_.low({column, row}) + size.cwiseProduct(Vec2(u, v));
      p_W = plan_.middle({column, row});
      if (oracle.distance(at_W) < room) continue;
      p_W = at_W;
      break;
    }
    return p_W;
  }

  Vec2 place_start() {
    const GridOracle oracle(obstacles());
    Vec2 start_W = anywhere(oracle, kRoomAtStart);
    const auto quarter = static_cast<double>(random_.below(4));
    double heading = random_.uniform(-std::numbers::pi, std::numbers::pi);
    building_.nose_on = random_.uniform() < 0.15;
    if (building_.nose_on) {
      heading = algo::wrap_angle(quarter * std::numbers::pi / 2);
      start_W = drive_up(start_W, heading);
    }
    building_.scenario.start = {start_W.x(), start_W.y(), heading};
    return start_W;
  }

  /// The place straight ahead where the hull is kNoseOn from something.
  Vec2 drive_up(Vec2 p_W, double heading) {
    const Vec2 ahead = algo::direction(heading);
    const auto room = [&] {
      double least = GridOracle::kFarthest;
      for (const algo::Obstacle& obstacle : obstacles()) {
        least = std::min(least, signed_distance(obstacle, p_W));
      }
      return least - kHull - kNoseOn;
    };
    constexpr double kClose = 1e-4;  // [m]
    for (double way = room(); way > kClose; way = room()) p_W += way * ahead;
    return p_W;
  }

  Vec2 place_goal(const Vec2& start_W) {
    const GridOracle oracle(obstacles());
    const bool near = building_.goal_place == GoalPlace::Near;
    Vec2 goal_W = anywhere(oracle, kRoomAtGoal);
    const auto far = [&](const Vec2& p_W) { return (p_W - start_W).norm(); };
    for (int k = 0; k < (near ? kPlaces : kFarPlaces); ++k) {
      if (near && far(goal_W) < kNear && far(goal_W) > 1.5) break;
      const Vec2 other_W = anywhere(oracle, kRoomAtGoal);
      const bool better =
          near ? far(other_W) < far(goal_W) && far(other_W) > 1.5 : far(other_W) > far(goal_W);
      if (better) goal_W = other_W;
    }
    return goal_W;
  }

  /// Shuts the goal's cell, or in a large cell and in the start's own one puts a pen about it.
  void shut_in(const Vec2& goal_W, const Vec2& start_W) {
    constexpr double kLarge = 8;  // [m]
    const CellPlace cell = cell_at(plan_, goal_W);
    const Vec2 size = plan_.high(cell) - plan_.low(cell);
    if (size.maxCoeff() > kLarge || cell == cell_at(plan_, start_W)) {
      const double most = ((goal_W - start_W).norm() - 0.5) / 1.5;  // the start stays outside
      const double half = std::min(random_.uniform(0.6, 1.5), most);
      for (int side = 0; side < 4; ++side) {
        const double turn = side * std::numbers::pi / 2;
        const Vec2 at_W = goal_W + half * algo::direction(turn);
        add({at_W.x(), at_W.y(), algo::wrap_angle(turn + std::numbers::pi / 2)},
            algo::Wall{2 * half + kWall, kWall});
      }
      return;
    }
    for (const CellPlace& step :
         {CellPlace{1, 0}, CellPlace{0, 1}, CellPlace{-1, 0}, CellPlace{0, -1}}) {
      plan_.shut(cell, {cell.column + step.column, cell.row + step.row});
    }
    // The walls come first in the list; the furniture keeps its place.
    const std::vector<algo::Obstacle> all = std::exchange(obstacles(), plan_.walls());
    for (const algo::Obstacle& obstacle : all) {
      if (!std::holds_alternative<algo::Wall>(obstacle.shape)) add(obstacle.pose_W, obstacle.shape);
    }
  }

  /// Puts a thing over the goal that leaves the start free.
  void bury(const Vec2& goal_W, const Vec2& start_W) {
    constexpr double kLeastHalf = 0.3;  // [m]
    const double most = (goal_W - start_W).norm() - kHull - 0.1;
    const double half = std::min(random_.uniform(kLeastHalf, 2.5), most);
    const bool round = random_.uniform() < 0.5;
    const double depth = random_.uniform(0, 0.8);
    const double turn = random_.uniform(-std::numbers::pi, std::numbers::pi);
    // Its middle lies off the goal.
    const Vec2 at_W = goal_W + depth * half * std::numbers::sqrt2 / 2 * algo::direction(turn);
    const double reach = std::min(half, ((at_W - start_W).norm() - kHull - 0.1));
    if (round) {
      add({at_W.x(), at_W.y(), 0}, algo::Cylinder{reach});
    } else {
      const double edge = std::numbers::sqrt2 * reach;
      add({at_W.x(), at_W.y(), turn}, algo::Box{edge, edge});
    }
  }

  /// A sliding door in one of the doors on the way to the goal. It closes before the robot can be
  /// there, and opens `wait` [s] after the robot could be there.
  void add_timed_door(const Vec2& start_W, const Vec2& goal_W, double wait) {
    GridOracle oracle(obstacles());
    const auto way = oracle.way(start_W, goal_W, kHull, kGoalReach);
    if (!way) return;
    for (const DoorPlace& door : plan_.doors()) {
      const double width = plan_.door_width();
      const bool fits_before = door.before > width;
      if (!fits_before && door.behind <= width) continue;
      double length = 0;
      bool passes = false;
      for (std::size_t i = 1; i < way->size() && !passes; ++i) {
        length += ((*way)[i] - (*way)[i - 1]).norm();
        passes = ((*way)[i] - door.middle_W).norm() < width / 2;
      }
      if (!passes || length < kLeastWay) continue;
      TimedDoor timed;
      const double there = length / kTopSpeed;
      timed.closes = 0.5 * there;
      timed.opens = there + wait;
      const Vec2 open_W = door.middle_W + (fits_before ? -width : width) * door.along;
      const double heading = std::atan2(door.along.y(), door.along.x());
      timed.shut_W = {door.middle_W.x(), door.middle_W.y(), heading};
      add({open_W.x(), open_W.y(), heading}, algo::Box{width, kLeaf});
      algo::Obstacle& leaf = obstacles().back();
      timed.id = leaf.id;
      leaf.path = algo::ObstaclePath{.period = kEndOfTime,
                                     .keys = {{0, open_W},
                                              {timed.closes, open_W},
                                              {timed.closes + TimedDoor::kSlide, door.middle_W},
                                              {timed.opens, door.middle_W},
                                              {timed.opens + TimedDoor::kSlide, open_W},
                                              {kEndOfTime, open_W}}};
      building_.timed_door = timed;
      return;
    }
  }

  Building& building_;
  sim::Random random_;
  FloorPlan plan_;
};

/// [m] A way is nowhere narrower.
double gap_of(double door_width) {
  return std::min(kGap, door_width - kUnderDoor);
}

/// [s] until a robot at top speed has driven `way_W` through the door, waiting while that is shut.
double time_through(const std::vector<Vec2>& way_W, const TimedDoor& door) {
  double way = 0;
  double waited = 0;
  algo::Obstacle leaf;
  leaf.pose_W = door.shut_W;
  leaf.shape = algo::Box{2 * kHull, kLeaf};
  for (std::size_t i = 1; i < way_W.size(); ++i) {
    way += (way_W[i] - way_W[i - 1]).norm();
    const double now = way / kTopSpeed + waited;
    const double free_again = door.opens + TimedDoor::kSlide;
    const bool shut = now > door.closes && now < free_again;
    if (shut && signed_distance(leaf, way_W[i]) < kHull) waited += free_again - now;
  }
  return way / kTopSpeed + waited;
}

}  // namespace

std::string_view name(GoalPlace place) {
  return kGoalNames.at(static_cast<std::size_t>(place));
}

Building building_of(std::uint64_t seed, const std::string& controller) {
  Building building;
  building.kind = kKinds.at(seed % kKinds.size());
  building.door_width = kDoorWidths.at(seed / kKinds.size() % kDoorWidths.size());
  sim::Scenario& scenario = building.scenario;
  scenario.name = fmt::format("building-{}", seed);
  scenario.title = fmt::format("Building {}: {}", seed, name(building.kind));
  scenario.physics = sim::PhysicsKind::Kinematic;
  scenario.drive.ramps = true;
  scenario.controller = controller;
  scenario.parameters = {{&algo::kMaxSpeed, kTopSpeed}};
  Builder(building, seed).build();
  return building;
}

Truth truth_between(GridOracle& oracle,
                    double door_width,
                    const Vec2& from_W,
                    const Vec2& to_W,
                    std::optional<std::vector<Vec2>>* found) {
  auto way = oracle.way(from_W, to_W, gap_of(door_width) / 2, kGoalReach);
  Truth truth;
  truth.has_way = way.has_value();
  truth.has_none = !oracle.way(from_W, to_W, kNoGap / 2, kGoalReach);
  if (way) truth.time = length_of(*way) / kTopSpeed;
  if (found != nullptr) *found = std::move(way);
  return truth;
}

Truth truth_of(const Building& building) {
  const sim::Scenario& scenario = building.scenario;
  const Vec2 start_W = scenario.start.position();
  const Vec2 goal_W = scenario.goal->position_W;
  GridOracle oracle(scenario.obstacles);
  std::optional<std::vector<Vec2>> way;
  Truth truth = truth_between(oracle, building.door_width, start_W, goal_W, &way);
  if (!way || !building.timed_door) return truth;
  truth.time = time_through(*way, *building.timed_door);
  std::vector<algo::Obstacle> shut = scenario.obstacles;
  for (algo::Obstacle& obstacle : shut) {
    if (obstacle.id != building.timed_door->id) continue;
    obstacle.pose_W = building.timed_door->shut_W;
    obstacle.path.reset();
  }
  const auto round =
      GridOracle(shut).way(start_W, goal_W, gap_of(building.door_width) / 2, kGoalReach);
  if (round) truth.time = std::min(*truth.time, length_of(*round) / kTopSpeed);
  return truth;
}

}  // namespace server::buildings
