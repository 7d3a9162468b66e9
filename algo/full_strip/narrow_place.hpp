// algo/full_strip/narrow_place.hpp: the search for a manoeuvre to the strip ahead, and its driving.
#pragma once

#include <optional>

#include "algo/full_strip/maneuver.hpp"
#include "algo/full_strip/strip_state.hpp"
#include "algo/full_strip/velocity_stage.hpp"

namespace algo {

class NarrowPlace {
 public:
  void reset();
  /// Ends the manoeuvre, but not the search.
  void stop_driving() { drive_.reset(); }

  bool driving() const { return drive_.active(); }
  /// True while a search runs, but only for a while after it began: the robot may wait for it.
  bool worth_waiting(double now) const;

  /// Searches, a portion each tick, for a way from `here_W` to a pose on the strip ahead that
  /// points along it. `speed` [m/s] of the robot, which must stand when a search begins.
  void look(const StageInput& stage,
            const HullCheck& hull,
            const Pose2& here_W,
            double speed,
            double now);
  /// The next command of the present manoeuvre; nothing if it is over or no longer free.
  std::optional<Twist2> next(const StageInput& stage, const VelocityStage& proof, Weighing& out);

 private:
  ManeuverSearch search_{};
  ManeuverDrive drive_{};
  double next_search_ = 0;  // [s] run clock
};

}  // namespace algo
