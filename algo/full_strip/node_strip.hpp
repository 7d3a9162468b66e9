// algo/full_strip/node_strip.hpp: the reactive layer: an elastic strip of many nodes.
#pragma once

#include <cstddef>

#include "algo/full_strip/local_map.hpp"
#include "algo/full_strip/step_cost.hpp"
#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// One control point of the strip. Forces are displacements [m].
struct Node {
  Vec2 position_W{0, 0};
  Vec2 internal_W{0, 0};
  Vec2 external_W{0, 0};
};

struct StripSettings {
  double contraction = 0.4;     // K_c
  double repulsion = 0.6;       // K_r
  double rest_distance = 0.75;  // [m] d_o: clearance above which nothing pushes
  double least_clearance = 0;   // [m] below it the strip is broken
};

/// Nodes from the robot to the goal, every kSpacing. Its neighbours pull each node straight (Eq. 2
/// of the thesis). Obstacles on its left and on its right push it (the two sides of the thesis, at
/// every node).
class NodeStrip {
 public:
  static constexpr double kSpacing = 0.15;  // [m]
  static constexpr std::size_t kMost = 400;

  NodeStrip();
  void clear() { nodes_.clear(); }
  bool empty() const { return nodes_.size() < 2; }

  /// Lays the strip along `path`, from the robot to the goal.
  void lay(const Recycled<Vec2>& path);
  /// Cuts off the part that the robot has passed, starts the strip at the robot, and spaces the
  /// nodes evenly.
  void follow(const Vec2& robot_W);
  /// Runs `sweeps` rounds of forces over the first `reach` [m] of the strip; the rest gets fewer.
  void relax(const LocalMap& map, const StripSettings& settings, int sweeps);
  /// Where it is narrow, puts the next nodes into the middle, by the hits themselves: the forces
  /// err by a part of a cell, and pull a corner's nodes inwards.
  void centre(const LocalMap& map, const StripSettings& settings);
  /// [m] Distance from the robot to the first node without room; negative if there is none.
  double broken_at(const LocalMap& map, const StripSettings& settings) const;

  /// Cost [m] of the strip by the planner's cost function, as if all of it had been seen.
  double cost(const LocalMap& map, const StepCost& step) const;
  /// [m] Length along its nodes.
  double length() const;
  /// The point `s` [m] along the strip; its end if the strip is shorter.
  Vec2 at(double s) const;
  const Recycled<Node>& nodes() const { return nodes_; }
  Vec2 end_W() const { return nodes_.back().position_W; }

 private:
  void space_out();
  void push(const LocalMap& map, const StripSettings& settings, std::size_t i);
  void centre(const LocalMap& map, double room, std::size_t i);

  Recycled<Node> nodes_{};
  Recycled<Vec2> line_{};  // workspace of space_out()
};

}  // namespace algo
