// algo/strip/elastic_strip_controller.hpp: drives to the pass point of a three-point elastic strip.
#pragma once

#include <cstdint>
#include <optional>

#include "algo/controller.hpp"
#include "algo/driving.hpp"
#include "algo/strip/side_choice.hpp"
#include "algo/strip/strip.hpp"
#include "algo/strip/via_buffer.hpp"

namespace algo {

enum class Sides : std::uint8_t {
  Nearest,  // the single nearest obstacle point pushes
  Both,     // the nearest of each side
};

/// The variant of the published equations in use (equations.md D and E).
struct StripReading {
  ForceLaw law = ForceLaw::C1;
  Sides sides = Sides::Both;
  bool choose_side = true;
  /// The previous tick's pass point is P^j. Otherwise each tick's via is new and lies on the chord,
  /// so that F_int is zero and K_c has no effect.
  bool keep_via = false;
};

/// The forces of one tick [m]. They act at the strip's end and move it to the pass point.
struct StripForces {
  Vec2 internal_W{0, 0};
  Vec2 left_W{0, 0};  // external, of each side
  Vec2 right_W{0, 0};
  Vec2 push_W{0, 0};       // of the side choice
  Vec2 elastic_W{0, 0};    // their sum
  Side side = Side::None;  // on which to pass the obstacle
  double side_since = 0;   // [s] run clock at which it was chosen
  double side_alpha = 0;   // share of the push, 0..1
  std::optional<std::size_t> blocked_beam{};
};

class ElasticStripController final : public Controller {
 public:
  explicit ElasticStripController(const StripReading& reading) : reading_(reading) {}

  void reset(const Pose2& start_W) override;
  void update(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;
  void explain(const Telemetry& t, Explanation& words) const override;

  /// The forces of the last tick.
  const StripForces& forces() const { return forces_; }

 private:
  struct Strip;  // start, via and end of one tick

  void follow_goal(const SetGoal& goal, const Vec2& start_W);
  Strip lay_strip(const Vec2& start_W, const Vec2& goal_W, const Parameters& parameters) const;
  bool push(const ControlInput& in, const ForceSettings& settings);
  void damp(double time_constant, double dt);
  void choose(const ControlInput& in, const Vec2& goal_W, double reach);
  Vec2 next_point(const Vec2& p_W, const Vec2& pass_W, const Parameters& parameters);
  void show(const Strip& strip, const Vec2& pass_W, const Vec2& goal_W, ControlOutput& out) const;

  StripReading reading_{};
  StripForces forces_{};
  SideChoice side_{};
  std::optional<SetGoal> goal_{};     // of the previous tick
  std::optional<Vec2> kept_via_W_{};  // pass point of the previous tick
  std::optional<Vec2> damped_W_{};    // [m] elastic force of the previous tick
  ViaBuffer buffer_{};                // from where the goal was set
};

}  // namespace algo
