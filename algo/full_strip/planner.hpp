// algo/full_strip/planner.hpp: the deliberative layer: plans a path to the goal over the local map
// and over what is remembered beyond it.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

#include "algo/full_strip/building_memory.hpp"
#include "algo/full_strip/local_map.hpp"
#include "algo/full_strip/plan_world.hpp"
#include "algo/full_strip/step_cost.hpp"
#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// How a search takes the walls of a known map that the robot has not seen itself.
enum class DrawnWalls : std::uint8_t {
  Shut,    // there is no way through them
  Priced,  // they may be gone
};

/// A* from the goal to the robot, in bounded portions, over two lattices that are joined where they
/// meet: one of 0.1 m over the inner tiles of the local map, and one of 0.2 m beyond them. Where
/// the robot has not looked, a known map tells the room; space of which nothing is known counts as
/// free, at a price.
///
/// A step costs its length x StepCost::of(clearance). Below the least clearance there is no way,
/// except at the robot, which may stand anywhere.
class Planner {
 public:
  enum class State : std::uint8_t { Idle, Searching, Found, NoWay };

  Planner();
  void reset() { state_ = State::Idle; }
  /// Makes the lattice large enough for goals anywhere on `drawn`. Allocates; forgets the search.
  void hold(const DrawnSpace& drawn);

  struct Options {
    StepCost cost{};
    bool exact = false;      // doubtful clearances are measured to the hits themselves
    bool try_tight = false;  // keep a goal without room right before the robot: the map may err
    bool lenient = false;    // narrow places that nobody has seen from nearby may be passed
    DrawnWalls walls = DrawnWalls::Shut;
  };
  /// Begins a search. The nearest place with room replaces a goal without room; a goal farther than
  /// farthest() is replaced on the straight line to it.
  void start(const PlanWorld& world,
             const Vec2& robot_W,
             const Vec2& goal_W,
             const Options& options);
  /// [m] along each axis: kFarthest without a map, and more on a large one.
  double farthest() const { return farthest_; }
  static constexpr double kFarthest = 90;  // [m]
  /// Expands up to `budget` lattice points.
  State search(const PlanWorld& world, int budget);

  State state() const { return state_; }
  /// True if the path ends away from the requested goal because an obstacle stands there.
  bool goal_taken() const { return goal_taken_; }
  /// True if the goal was kept although it has no room.
  bool goal_tight() const { return goal_tight_; }

  /// The place nearest to `robot_W` of all that the search has come to.
  const Vec2& closest_W() const { return closest_W_; }

  /// A path found.
  struct Path {
    Recycled<Vec2> points_W{};  // robot first, at most one point per lattice step
    std::size_t local = 0;      // of them lie on the inner tiles of the local map, before it leaves
    double beyond = 0;          // cost [m] of the rest
    bool unsure = false;        // it passes a narrow place that nobody has seen from nearby
  };
  void path(const PlanWorld& world, Path& out) const;
  /// Cost [m] from `p_W` to the goal, as far as the last search has come; nothing if it has not
  /// been there.
  std::optional<double> cost_from(const Vec2& p_W) const;

 private:
  using Id = std::uint32_t;                          // of a lattice point: the fine ones first
  static constexpr int kFine = LocalMap::kSize / 2;  // fine points along the window's edge
  static constexpr int kRim = BuildingMemory::kFineSide / 2;  // of them, along its outermost tiles
  static constexpr double kStep = 2 * LocalMap::kCell;        // [m] between fine points
  static constexpr int kCoarse = BuildingMemory::kTiles * BuildingMemory::kCoarseSide;
  static constexpr int kMostCoarse = 4096;  // along the edge of the largest lattice: 819 m
  static constexpr Id kFineCount = Id{kFine} * kFine;
  using Cell = BuildingMemory::Cell;

  struct Point {
    std::uint32_t round = 0;  // of the search that wrote it; zero: never
    Id parent = 0;            // on the way to the goal; the root is its own
    float g = -1;             // [m] negative: not opened
    float cost = 0;           // [m per m] negative: no way; 0: not yet known
    bool closed = false;
  };
  /// A point waiting to be expanded; the entries of a bucket are chained.
  struct Entry {
    Id point = 0;
    std::uint32_t next = 0;  // entry + 1; 0: the last
  };
  struct Release {
    void operator()(void* memory) const { std::free(memory); }
  };

  static bool is_fine(Id id) { return id < kFineCount; }
  static bool is_inner(int column, int row) {
    return column >= kRim && row >= kRim && column < kFine - kRim && row < kFine - kRim;
  }
  Id fine_id(int column, int row) const { return static_cast<Id>(row * kFine + column); }
  Id coarse_id(Cell c) const;
  Cell cell_of(Id coarse) const;
  Id id_at(const Vec2& p_W) const;
  Vec2 position_W(Id id) const;
  Point& at(Id id);
  bool near_robot(Id id) const;
  float heuristic(Id id) const;
  /// [m] On a lattice of `coarse` points along its edge.
  static double farthest_on(int coarse) {
    return kFarthest + (coarse - kCoarse) * BuildingMemory::kCoarse / 2;
  }
  void allocate(int coarse);
  double clearance(const PlanWorld& world, Id id) const;
  Cell coarse_of(Id id) const;
  /// The coarse cell of a fine point.
  Cell coarse_at(int column, int row) const {
    return {corner_.column + column / 2, corner_.row + row / 2};
  }
  double room(const PlanWorld& world, Id id) const;
  float cost_of(const PlanWorld& world, Id id);
  float new_cost(const PlanWorld& world, Id id);
  void push(Id id, float g, Id parent);
  std::optional<Id> pop();
  void relax(const PlanWorld& world, Id from, Id to, float length);
  void expand_fine(const PlanWorld& world, Id id);
  void expand_coarse(const PlanWorld& world, Id id);
  bool has_room(const PlanWorld& world, Id id) const;
  Id free_point(const PlanWorld& world, Id wanted) const;
  Id free_coarse(const PlanWorld& world, Id wanted) const;
  void place_bounds(const PlanWorld& world);

  State state_ = State::Idle;
  bool goal_taken_ = false;
  bool goal_tight_ = false;
  Options options_{};
  int coarse_ = 0;       // coarse points along the lattice's edge, a power of two
  double farthest_ = 0;  // [m]
  Vec2 corner_W_{0, 0};  // of the fine lattice
  Cell corner_{};        // the same, in coarse cells
  Vec2 robot_W_{0, 0};
  Vec2 goal_W_{0, 0};
  Vec2 closest_W_{0, 0};
  Id robot_ = 0;
  Id root_ = 0;
  Cell low_{}, high_{};                       // bounds of the coarse lattice
  std::uint32_t round_ = 0;                   // of the search; data of earlier rounds is void
  int spent_ = 0;                             // of the budget, on exact clearances
  std::unique_ptr<Point[], Release> points_;  // zero, and out of memory, until searched
  // A queue of buckets. Costs rise along a search, so the first filled bucket is near.
  std::vector<std::uint32_t> buckets_;  // entry + 1
  std::vector<Entry> entries_;
  std::size_t bucket_ = 0;
};

/// Removes points of `path` wherever the straight line past them keeps `room` [m], and `least` [m]
/// from walls that only the map shows. This removes the lattice's corners in open space.
void straighten(const PlanWorld& world, double room, double least, Recycled<Vec2>& path);

}  // namespace algo
