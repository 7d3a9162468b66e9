// sim/pose_trail.hpp: where the robot was at the last physics steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "algo/types.hpp"

namespace sim {

/// True poses at equal steps of time, the newest few; between them the pose is interpolated, before
/// them it stood still. A scanner reads its beams' poses here.
class PoseTrail {
 public:
  /// Keeps at least `span` [s] of poses `step` [s] apart.
  PoseTrail(double step, double span)
      : step_(step), poses_(static_cast<std::size_t>(std::ceil(span / step)) + 2) {}

  /// At rest at `pose` up to `time`.
  void reset(const algo::Pose2& pose, double time) {
    std::fill(poses_.begin(), poses_.end(), pose);
    start_ = time;
    pushed_ = 0;
    last_ = 0;
  }
  /// The pose one step after the newest.
  void push(const algo::Pose2& pose) {
    ++pushed_;
    if (++last_ == poses_.size()) last_ = 0;
    poses_[last_] = pose;
  }

  double step() const { return step_; }
  /// [s] Run-clock time of the newest pose. Counted, not summed, so that it does not drift.
  double newest() const { return start_ + static_cast<double>(pushed_) * step_; }
  /// The pose `age` steps before the newest; the oldest one kept when that is too far back.
  const algo::Pose2& back(std::size_t age) const {
    const std::size_t kept = std::min(age, poses_.size() - 1);
    return poses_[kept <= last_ ? last_ - kept : last_ + poses_.size() - kept];
  }
  /// The pose at `time`, interpolated.
  algo::Pose2 at(double time) const {
    const double steps = std::max(0.0, (newest() - time) / step_);
    if (steps < 1e-9) return back(0);  // the newest itself, not almost
    const auto age = static_cast<std::size_t>(steps);
    const double part = steps - static_cast<double>(age);
    return algo::interpolated(back(age), back(age + 1), part);
  }

 private:
  double step_ = 0;   // [s]
  double start_ = 0;  // [s]
  std::size_t pushed_ = 0;
  std::size_t last_ = 0;  // where the newest is; counted, as a remainder costs a division a pose
  std::vector<algo::Pose2> poses_{};
};

}  // namespace sim
