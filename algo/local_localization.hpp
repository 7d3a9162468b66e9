// algo/local_localization.hpp: the block "local localization" of the thesis (Fig. 22) for a base
// with wheel encoders and a yaw gyro.
#pragma once

#include "algo/types.hpp"

namespace algo {

/// Odometry with distances from the encoders and turns from the gyro.
///
///   theta(k) = theta(k-1) + (g(k) - b) dt
///   x(k) = x(k-1) + d cos(theta(k-1) + (g(k) - b) dt / 2),  y likewise with sin
///
/// g is the gyro's rate, b its bias, and d the mean distance of the two wheels. The bias is the
/// gyro's reading while both wheels stand. After kStill seconds of standing, b is the mean of all
/// readings since they came to rest; at most the newest kMemory seconds are weighed alike:
///
///   b(n) = b(n-1) + (g(n) - b(n-1)) / min(n, kMemory / dt)
///
/// Wheels that slip in a turn count a rotation that the gyro does not see. When the two differ by
/// more than kSlipRate for kSlipTime, slipping() is true (sensors.md 4).
class LocalLocalization {
 public:
  static constexpr double kStill = 1.0;        // [s]
  static constexpr double kMemory = 10.0;      // [s]
  static constexpr double kSlipRate = 0.1745;  // [rad/s] 10 degrees a second
  static constexpr double kSlipTime = 0.3;     // [s]

  /// Places the robot at `start_W`. Keeps the bias, which belongs to the gyro.
  void reset(const Pose2& start_W);

  /// Advances one period of `dt` [s] and returns the new pose. `wheels_R` is R's motion by the
  /// wheels alone; `rate` [rad/s] is the gyro's reading. Input that is not finite counts as no
  /// motion.
  const Pose2& update(const Pose2& wheels_R, double rate, double dt);

  const Pose2& pose_W() const { return pose_W_; }
  /// [rad/s] Estimated bias of the gyro.
  double bias() const { return bias_; }
  bool slipping() const { return slip_time_ > kSlipTime; }

 private:
  void learn_bias(const Pose2& wheels_R, double rate, double dt);

  Pose2 pose_W_{};
  double bias_ = 0;        // [rad/s]
  double still_ = 0;       // [s] since both wheels came to rest
  double still_mean_ = 0;  // [rad/s] of the gyro since then
  double still_count_ = 0;
  double slip_time_ = 0;  // [s] for which wheels and gyro have differed
};

}  // namespace algo
