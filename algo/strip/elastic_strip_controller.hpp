// algo/strip/elastic_strip_controller.hpp: drives to the pass point of a three-point elastic strip.
#pragma once

#include <cstdint>
#include <optional>

#include "algo/controller.hpp"
#include "algo/driving.hpp"
#include "algo/strip/side_choice.hpp"
#include "algo/strip/strip.hpp"

namespace algo {

enum class Sides : std::uint8_t {
  Nearest,  // the single nearest obstacle point pushes
  Both,     // the nearest of each side
};

/// How the sources' text is read (equations.md D and E).
struct StripReading {
  ForceLaw law = ForceLaw::C1;
  Sides sides = Sides::Both;
  bool choose_side = true;
  /// The pass point of the tick before is P^j. Otherwise the via is new on each tick and lies on
  /// the chord, so that F_int is zero and K_c has no effect.
  bool keep_via = false;
};

class ElasticStripController final : public Controller {
 public:
  explicit ElasticStripController(const StripReading& reading) : reading_(reading) {}

  void reset(const Pose2& start_W) override;
  void update(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;

 private:
  struct Strip;  // start, via and end of one tick

  void follow_goal(const SetGoal& goal);
  Strip lay_strip(const Vec2& start_W, const Vec2& goal_W, const Parameters& parameters) const;
  bool push(const ControlInput& in, const ForceSettings& settings, ControlOutput& out) const;
  void choose(const ControlInput& in, const Vec2& goal_W, double reach, ControlOutput& out);

  StripReading reading_{};
  SideChoice side_{};
  std::optional<SetGoal> goal_{};     // of the tick before
  std::optional<Vec2> kept_via_W_{};  // pass point of the tick before
};

}  // namespace algo
