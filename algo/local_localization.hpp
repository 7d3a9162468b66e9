// algo/local_localization.hpp: the block "local localization" of the thesis (Fig. 22) for a base
// with wheel encoders and a yaw gyro.
#pragma once

#include "algo/types.hpp"

namespace algo {

/// Distances from the encoders, turns from the gyro.
///
///   theta(k) = theta(k-1) + (g(k) - b) dt
///   x(k) = x(k-1) + d cos(theta(k-1) + (g(k) - b) dt / 2),  y likewise with sin
///
/// g is the gyro's rate, b its bias, d the way of both wheels in the mean. The bias is what the
/// gyro reads while both wheels stand: after kStill seconds of that, b is the mean of all readings
/// since they came to rest, at most the newest kMemory seconds of them weighed alike:
///
///   b(n) = b(n-1) + (g(n) - b(n-1)) / min(n, kMemory / dt)
///
/// Wheels that turn on a floor that does not follow count a turn that the gyro does not see; when
/// both differ by more than kSlipRate for kSlipTime, slipping() says so (sensors.md 4).
class LocalLocalization {
 public:
  static constexpr double kStill = 1.0;        // [s]
  static constexpr double kMemory = 10.0;      // [s]
  static constexpr double kSlipRate = 0.1745;  // [rad/s] 10 degrees a second
  static constexpr double kSlipTime = 0.3;     // [s]

  /// The robot stands at `start_W`; the bias is kept, as the gyro's own.
  void reset(const Pose2& start_W);

  /// One period of `dt` [s], in which the wheels alone would say that R moved by `wheels_R` and the
  /// gyro read `rate` [rad/s]. Returns the new pose. What is not finite counts as no motion.
  const Pose2& update(const Pose2& wheels_R, double rate, double dt);

  const Pose2& pose_W() const { return pose_W_; }
  /// [rad/s] of the gyro, as far as it is known.
  double bias() const { return bias_; }
  bool slipping() const { return slip_time_ > kSlipTime; }

 private:
  void learn_bias(const Pose2& wheels_R, double rate, double dt);

  Pose2 pose_W_{};
  double bias_ = 0;        // [rad/s]
  double still_ = 0;       // [s] both wheels have stood
  double still_mean_ = 0;  // [rad/s] of the gyro since
  double still_count_ = 0;
  double slip_time_ = 0;  // [s] wheels and gyro have differed
};

}  // namespace algo
