// algo/local_localization.cpp: one period of dead reckoning.
#include "algo/local_localization.hpp"

#include <algorithm>
#include <cmath>

namespace algo {
namespace {

constexpr double kStanding = 1e-6;  // [m] and [rad] in a period: below one encoder count

}  // namespace

void LocalLocalization::reset(const Pose2& start_W) {
  pose_W_ = start_W;
  still_ = 0;
  slip_time_ = 0;
}

void LocalLocalization::learn_bias(const Pose2& wheels_R, double rate, double dt) {
  const bool stands =
      wheels_R.position().norm() < kStanding && std::abs(wheels_R.heading) < kStanding;
  if (!stands) {
    still_ = 0;
    return;
  }
  if (still_ == 0) {
    still_mean_ = 0;
    still_count_ = 0;
  }
  still_ += dt;
  still_count_ = std::min(still_count_ + 1, std::max(1.0, kMemory / dt));
  still_mean_ += (rate - still_mean_) / still_count_;
  if (still_ >= kStill) bias_ = still_mean_;
}

const Pose2& LocalLocalization::update(const Pose2& wheels_R, double rate, double dt) {
  if (!finite(wheels_R) || !std::isfinite(rate) || !(dt > 0)) return pose_W_;
  learn_bias(wheels_R, rate, dt);
  const double turn = (rate - bias_) * dt;
  const double way = std::copysign(wheels_R.position().norm(), wheels_R.x);
  const Vec2 moved_W = way * direction(pose_W_.heading + turn / 2);
  pose_W_ = {pose_W_.x + moved_W.x(), pose_W_.y + moved_W.y(), wrap_angle(pose_W_.heading + turn)};
  const bool differ = std::abs(wheels_R.heading - turn) > kSlipRate * dt;
  slip_time_ = differ ? slip_time_ + dt : 0;
  return pose_W_;
}

}  // namespace algo
