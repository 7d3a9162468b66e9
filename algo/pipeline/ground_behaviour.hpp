// algo/pipeline/ground_behaviour.hpp: drives a robot with floor sensors over ground that it
// masters, and away from ground that it does not.
#pragma once

#include <string>

#include "algo/pipeline/reactive.hpp"
#include "algo/terrain/ground_survey.hpp"

namespace algo {

namespace limits {

/// The survey's own sentence replaces this one.
inline constexpr Limit kGround{"ground", "The floor sensors do not see a level floor."};
inline constexpr Limit kFloorSilent{"ground_silent",
                                    "The floor sensors are silent: the robot waits for them."};

}  // namespace limits

/// Takes the base from a goal's controller while it surveys an edge. A driver by hand keeps the
/// base, within the survey's limits. Before all other behaviours.
class GroundBehaviour final : public Behaviour {
 public:
  /// `spec` has floor sensors.
  explicit GroundBehaviour(const RobotSpec& spec) : survey_(spec) {}
  Name name() const override { return behaviours::kGround; }
  void reset(const Pose2& start_W) override;
  Proposal propose(const Resource& resource, ControlOutput& output) override;
  /// Enters the refused edges into a new scan, so that a controller may go round them.
  void enter_edges(const Pose2& pose_W, LaserScan& scan) const {
    survey_.refused().enter(pose_W, scan);
  }
  /// Adds the verdict, its edge and its measures to `t`.
  void show(Telemetry& t);

 private:
  GroundSurvey survey_;
  std::string verdict_{};
  double pitch_ = 0;    // [rad] of the newest reading
  double read_at_ = 0;  // [s] of the newest reading of the floor
  bool has_read_ = false;
};

}  // namespace algo
