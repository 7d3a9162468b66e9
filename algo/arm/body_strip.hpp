// algo/arm/body_strip.hpp: an elastic strip of whole configurations, in which base and arm bend
// together.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algo/arm/mobile_arm.hpp"

namespace algo {

/// What pushes the strip away from a solid.
enum class ExternalForce : std::uint8_t {
  Shadow,  // the solid's shadow along the base's path, see solid_shadow() (ours, the default)
  AcrossThePath,  // each link's nearest point, without the part along the base's path (ours)
  AtJoints,       // shoulder, elbow, wrist and hand alone, as printed: links between them touch
};

/// Docs: equations.md, "Strip of arm and base".
struct BodyStripGains {
  ExternalForce external_force = ExternalForce::Shadow;
  double internal = 0.4;         // K_c
  double smoothing = 0.3;        // of each joint to the mean of its neighbours (ours)
  double external = 3.0;         // K_r
  double reach = 0.35;           // [m] d_0: solids farther from a link's surface push nothing
  double standing_reach = 0.05;  // [m] the same of solids that stand, where the base stands as well
  double own_reach = 0.03;  // [m] the arm keeps off base and mast, and the hand off the upper arm
  double base_weight = 0.005;  // of the base beside 1 of the joints: the arm yields first
  double base_spring = 0.05;   // back to the nominal configuration
  double joint_spring = 0.01;
  double standing_spring = 0.5;  // the same where the base stands: the arm keeps to its planned way
  double step = 0.4;             // part of a sweep's change that is made
  double longest = 0.05;         // [m, rad] of one entry in one sweep
};

/// The gains the sibling thesis prints, for comparison.
BodyStripGains printed_gains();

class BodyStrip {
 public:
  explicit BodyStrip(const MobileArm& body, const BodyStripGains& gains = {});

  /// Takes `nominal`, at least two configurations from start to goal, as the strip at rest. Start
  /// and goal stay where they are. Allocates.
  void lay(std::span<const BodyJoints> nominal);

  /// The body has moved to `now`: it is the strip's start, and configurations that it has passed
  /// are forgotten. `speed` [m/s] is that of the base, by which relax() predicts where solids will
  /// be when the body gets there; 0: where they are. Allocates nothing.
  void follow(const BodyJoints& now, double speed);

  /// Makes up to `sweeps` sweeps, each of which moves every inner configuration once. Ends early
  /// when no entry moves by more than 1e-5. Returns the number of sweeps made. Allocates nothing.
  int relax(std::span<const Solid> solids, int sweeps);

  std::size_t size() const { return now_.size(); }
  /// [m] Of the base's way from start to goal.
  double length() const;
  std::span<const BodyJoints> configurations() const { return now_; }
  /// Of length 1, in which the base arrives at its goal; 0 if it stands.
  const Vec2& end_direction() const { return end_direction_; }
  /// The base stands all the way, and the arm alone moves.
  bool stands() const { return end_direction_.isZero(); }
  const BodyJoints& goal() const { return nominal_.back(); }
  std::span<const BodyFrames> frames() const { return frames_; }

 private:
  /// Base, shoulder, elbow, wrist and hand.
  static constexpr std::size_t kPoints = 5;
  using Points = std::array<Vec3, kPoints>;

  void place(std::size_t i);
  bool passed_next() const;
  void add_internal(std::size_t i, BodyJoints& force) const;
  void add_external(std::size_t i, std::span<const Solid> solids, BodyJoints& force) const;
  void push_off_itself(std::size_t i, BodyJoints& force) const;
  void push_joints(std::size_t i, const Solid& solid, BodyJoints& force) const;
  void push_nearest(std::size_t i, const Vec3& ahead, const Solid& solid, BodyJoints& force) const;
  void push_out_of_shadow(std::size_t i,
                          const Vec3& ahead,
                          const Solid& solid,
                          BodyJoints& force) const;
  /// The arm draws back at the goal while something that moves is near it.
  double yield_at_goal(std::span<const Solid> solids);
  double move(std::size_t i, const BodyJoints& force);

  MobileArm body_;
  BodyStripGains gains_;
  std::vector<BodyJoints> nominal_{};
  std::vector<BodyJoints> now_{};
  std::vector<BodyFrames> frames_{};
  std::vector<Points> points_{};
  Vec2 end_direction_ = Vec2::Zero();
  std::vector<double> ahead_{};  // [s] until the body is at each configuration
};

}  // namespace algo
