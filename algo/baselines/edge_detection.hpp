// algo/baselines/edge_detection.hpp: stops, finds the two edges of the obstacle in the way, and
// drives past one of them (the method that Borenstein and Koren 1988 describe; equations.md F.1).
#pragma once

#include <optional>

#include "algo/baselines/baseline.hpp"
#include "algo/strip/side_choice.hpp"

namespace algo {

/// The two beams beside a jump in range; the edge is the nearer of their returns.
struct Edge {
  std::size_t beam = 0;
  double range = 0;  // [m]
};

/// The edges of the obstacle that beam `beam` has hit. On either side of the beam, the first jump
/// of more than 0.3 m between neighbours is an edge. A Free beam counts as range_max; an Invalid
/// one is skipped. A side without a jump inside the field of view has no edge.
struct EdgePair {
  std::optional<Edge> left{};
  std::optional<Edge> right{};
};
EdgePair bounding_edges(const LaserScan& scan, std::size_t beam);

/// The edge's point moved 0.45 m [D] outward, at right angles to the line of sight from the robot.
/// `side` is the edge's side of the obstacle.
Vec2 beside_edge(const Pose2& pose_W, const LaserScan& scan, const Edge& edge, Side side);

/// Drives to the goal until its lane is blocked (as in equations.md E.4). It then stands still for
/// 0.5 s [D], takes the newest scan, and drives beside the edge that gives the shorter way to the
/// goal [D]. There it checks the lane again. Without an edge it drives at the goal.
class EdgeDetection final : public Baseline {
 public:
  static ParameterList parameters();
  /// ControlOutput::state.
  static constexpr std::uint8_t kTakingScan = 1;
  static constexpr std::uint8_t kToEdge = 2;
  static constexpr std::uint8_t kToGoal = 3;

 private:
  void forget() override;
  void retarget() override { forget(); }
  void steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;
  void tell(const Telemetry& t, Explanation& words) const override;
  std::optional<std::size_t> blocking_beam(const ControlInput& in, const Parameters& parameters);
  void choose(const ControlInput& in, std::size_t beam);
  bool wait(double stamp);

  SideChoice lane_{};                       // for its lane test only
  std::optional<double> standing_since_{};  // [s] run clock
  std::optional<Vec2> via_W_{};             // beside the chosen edge
};

}  // namespace algo
