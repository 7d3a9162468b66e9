// algo/baselines/certainty_grid_planner.cpp: turns the map into costs, a path, and a twist along
// it.
#include <algorithm>
#include <array>
#include <cmath>

#include "algo/baselines/certainty_grid.hpp"
#include "algo/common_layers.hpp"

namespace algo {
namespace {

constexpr double kReplanPeriod = 0.2;  // [s] [D]
constexpr double kOccupied = 0.25;     // [D] certainty from which a cell counts as occupied
constexpr double kComfort = 0.3;       // [m] [D] width beyond the margin where cells cost more
constexpr float kNearCost = 3;         // [D] extra cost of a cell at the margin
constexpr float kWayOutCost = 10;      // [D] of a cell under the robot inside the margin
constexpr double kWayOut = 0.3;        // [m] [D] around the robot such cells are not blocked
constexpr LayerInfo kGrid{.name = "certainty.grid",
                          .label = "Certainty grid",
                          .kind = LayerKind::Grid,
                          .tone = Tone::External};
constexpr std::uint8_t kPlanned = 1;
constexpr std::uint8_t kNoPlan = 2;
constexpr std::size_t kCells =
    static_cast<std::size_t>(CertaintyGrid::kSide) * CertaintyGrid::kSide;

constexpr ParameterInfo kGridMargin{.name = "certainty_grid.margin",
                                    .label = "Margin",
                                    .unit = "m",
                                    .max = 0.5,
                                    .step = 0.01,
                                    .initial = 0.05,
                                    .help = "Room that the path keeps beyond the hull."};
constexpr ParameterInfo kLookAhead{.name = "certainty_grid.look_ahead",
                                   .label = "Look ahead",
                                   .unit = "m",
                                   .min = 0.1,
                                   .max = 2,
                                   .step = 0.05,
                                   .initial = 0.4,
                                   .help = "How far ahead on its path the robot aims."};
constexpr auto kGridParameters = std::to_array<const ParameterInfo*>(
    {&kGridMargin, &kLookAhead, &kMaxSpeed, &kMaxTurnRate, &kHeadingGain, &kGoalReach});

}  // namespace

ParameterList CertaintyGridPlanner::parameters() {
  return kGridParameters;
}

void CertaintyGridPlanner::forget() {
  grid_.clear();
  costs_.resize(kCells);
  search_.resize(kCells);
  path_W_.reserve(kCells);
  path_W_.clear();
  reaches_ = false;
  planned_at_.reset();
}

GridCell CertaintyGridPlanner::place(Cell c) const {
  return {c.i - grid_.first().i, c.j - grid_.first().j};
}

CostGrid CertaintyGridPlanner::view() const {
  return {CertaintyGrid::kSide, CertaintyGrid::kSide, costs_};
}

/// Costs: 1 in the open, more near occupied cells, blocked within `hard` [m] of one.
void CertaintyGridPlanner::fill_costs(double hard) {
  constexpr int kSide = CertaintyGrid::kSide;
  constexpr double kCell = CertaintyGrid::kCell;
  const int reach = static_cast<int>(std::ceil((hard + kComfort) / kCell));
  std::fill(costs_.begin(), costs_.end(), 1.0F);
  const CostGrid view = this->view();
  const Cell first = grid_.first();
  const auto spread = [&](GridCell occupied) {
    for (int row = occupied.row - reach; row <= occupied.row + reach; ++row) {
      for (int column = occupied.column - reach; column <= occupied.column + reach; ++column) {
        if (!view.covers({column, row})) continue;
        float& cost = costs_[view.index({column, row})];
        const double d = kCell * std::hypot(column - occupied.column, row - occupied.row);
        if (d < hard) cost = CostGrid::kBlocked;
        if (cost < 1 || d >= hard + kComfort) continue;
        cost = std::max(cost, 1 + kNearCost * static_cast<float>(1 - (d - hard) / kComfort));
      }
    }
  };
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const Cell cell{first.i + column, first.j + row};
      if (grid_.certainty(cell) >= kOccupied) spread({column, row});
    }
  }
}

/// Unblocks free cells under the robot that are too near to an obstacle.
void CertaintyGridPlanner::open_way_out(const Vec2& robot_W) {
  constexpr int kSide = CertaintyGrid::kSide;
  const CostGrid view = this->view();
  const Cell first = grid_.first();
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      float& cost = costs_[view.index({column, row})];
      const Cell cell{first.i + column, first.j + row};
      const bool under = (grid_.centre(cell) - robot_W).norm() < kWayOut;
      if (cost < 1 && under && grid_.certainty(cell) < kOccupied) cost = kWayOutCost;
    }
  }
}

void CertaintyGridPlanner::plan(const ControlInput& in, double margin) {
  const Vec2 p = in.odometry.pose.position();
  fill_costs(in.spec->radius + margin);
  const bool trapped = view().blocked(place(grid_.cell_of(p)));  // where no path may lead
  if (trapped) open_way_out(p);
  Vec2 aim = goal_W(in);
  constexpr int kHalf = CertaintyGrid::kSide / 2;
  const double farthest = (kHalf - 1) * CertaintyGrid::kCell;
  const double over = (aim - p).cwiseAbs().maxCoeff() / farthest;
  if (over > 1) aim = p + (aim - p) / over;  // move it to the border of the grid
  reaches_ = search_.find(view(), place(grid_.cell_of(p)), place(grid_.cell_of(aim)));
  path_W_.clear();
  path_W_.push_back(p);
  // Leaves a place that is too narrow only to the goal: the nearest reachable place could be a
  // wall.
  if (trapped && !reaches_) return;
  const auto path = search_.path();
  for (std::size_t k = 1; k < path.size(); ++k) {
    const Cell first = grid_.first();
    path_W_.push_back(grid_.centre({first.i + path[k].column, first.j + path[k].row}));
  }
  if (!reaches_) return;
  if (path_W_.size() == 1) path_W_.push_back(aim);
  path_W_.back() = aim;
}

/// The point `ahead` [m] further along the path than its point nearest to the robot.
Vec2 CertaintyGridPlanner::next_point(const Vec2& p_W, double ahead) const {
  const auto nearest = std::ranges::min_element(
      path_W_, {}, [&](const Vec2& point) { return (point - p_W).squaredNorm(); });
  const auto next = std::find_if(
      nearest, path_W_.end(), [&](const Vec2& point) { return (point - p_W).norm() >= ahead; });
  return next == path_W_.end() ? path_W_.back() : *next;
}

void CertaintyGridPlanner::steer(const ControlInput& in,
                                 const Parameters& parameters,
                                 ControlOutput& out) {
  grid_.sense(in);
  Layer& grid = add_layer(out.layers, kGrid);
  if (in.grids) grid_.show(grid);
  if (!planned_at_ || in.stamp - *planned_at_ >= kReplanPeriod) {
    plan(in, parameters[kGridMargin]);
    planned_at_ = in.stamp;
  }
  out.state = reaches_ ? kPlanned : kNoPlan;
  out.waits = !reaches_;
  show_plan(out);
  const Vec2 p = in.odometry.pose.position();
  const Vec2 next = next_point(p, parameters[kLookAhead]);
  if ((next - p).norm() < CertaintyGrid::kCell / 2) return;  // as near as it can get
  steer_along(in, bearing_W(p, next), parameters[kMaxSpeed], parameters, out);
  out.pass_W = next;
}

void CertaintyGridPlanner::show_plan(ControlOutput& out) const {
  Layer& plan = add_layer(out.layers, layers::kPlan);
  double length = 0;
  for (std::size_t k = 0; k < path_W_.size(); ++k) {
    put(plan, path_W_[k]);
    if (k > 0) length += (path_W_[k] - path_W_[k - 1]).norm();
  }
  out.measures.push_back({"plan.length", "m", length});
}

void CertaintyGridPlanner::tell(const Telemetry& t, Explanation& words) const {
  if (t.output.state == kNoPlan) {
    words.what = "Looking for a way";
    words.why = "No path over the grid reaches the goal; this one ends nearest to it.";
    return;
  }
  words.what = "Following its plan";
  say(words.why,
      "The path over the grid is %.2f m long.",
      t.output.measure("plan.length").value_or(0));
}

}  // namespace algo
