// sim/pose_trail.hpp: the robot's poses at the last physics steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "algo/robot.hpp"
#include "algo/types.hpp"

namespace sim {

/// The newest true poses, at equal steps of time. Poses in between are interpolated; before the
/// first the robot stood still. Scanners take their beams' poses from here. Tilts are kept only
/// where the ground is not level.
class PoseTrail {
 public:
  /// Keeps poses `step` [s] apart over at least `span` [s].
  PoseTrail(double step, double span)
      : step_(step), poses_(static_cast<std::size_t>(std::ceil(span / step)) + 2) {}

  /// At rest at `pose` until `time`.
  void reset(const algo::Pose2& pose, double time) {
    std::fill(poses_.begin(), poses_.end(), pose);
    start_ = time;
    pushed_ = 0;
    last_ = 0;
    tilts_.clear();
  }
  /// Adds the pose one step after the newest.
  void push(const algo::Pose2& pose) {
    ++pushed_;
    if (++last_ == poses_.size()) last_ = 0;
    poses_[last_] = pose;
  }
  /// Adds the tilt at the newest pose. The robot had it before the first one too.
  void tilt(const algo::Tilt& tilt) {
    if (tilts_.empty()) tilts_.assign(poses_.size(), tilt);
    tilts_[last_] = tilt;
  }
  /// Forgets the tilts: the ground is level again.
  void level() { tilts_.clear(); }

  double step() const { return step_; }
  /// [s] Run-clock time of the newest pose. Counted, not summed, so that it does not drift.
  double newest() const { return start_ + static_cast<double>(pushed_) * step_; }
  /// The pose `age` steps before the newest, or the oldest one kept.
  const algo::Pose2& back(std::size_t age) const { return poses_[slot(age)]; }
  /// The pose at `time`, interpolated.
  algo::Pose2 at(double time) const {
    const double steps = std::max(0.0, (newest() - time) / step_);
    if (steps < 1e-9) return back(0);  // exactly the newest
    const auto age = static_cast<std::size_t>(steps);
    const double part = steps - static_cast<double>(age);
    return algo::interpolated(back(age), back(age + 1), part);
  }
  /// The tilt at `time`, interpolated; level without any.
  algo::Tilt tilt_at(double time) const {
    if (tilts_.empty()) return {};
    const double steps = std::max(0.0, (newest() - time) / step_);
    const auto age = static_cast<std::size_t>(steps);
    const double part = steps - static_cast<double>(age);
    const algo::Tilt& a = tilts_[slot(age)];
    const algo::Tilt& b = tilts_[slot(age + 1)];
    return {std::lerp(a.z, b.z, part),
            std::lerp(a.roll, b.roll, part),
            std::lerp(a.pitch, b.pitch, part)};
  }

 private:
  std::size_t slot(std::size_t age) const {
    const std::size_t kept = std::min(age, poses_.size() - 1);
    return kept <= last_ ? last_ - kept : last_ + poses_.size() - kept;
  }

  double step_ = 0;   // [s]
  double start_ = 0;  // [s]
  std::size_t pushed_ = 0;
  std::size_t last_ = 0;  // index of the newest; a remainder would cost a division
  std::vector<algo::Pose2> poses_{};
  std::vector<algo::Tilt> tilts_{};  // of the poses; empty on level ground
};

}  // namespace sim
