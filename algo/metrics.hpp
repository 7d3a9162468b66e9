// algo/metrics.hpp: the metrics of one run.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "algo/telemetry.hpp"

namespace algo {

/// The outcome of a run; Running until it is over.
enum class Outcome : std::uint8_t {
  Running,
  Reached,
  Stuck,
  OutOfTime,
  Collided,
  Stopped,  // ended by a person: reset, another scenario, shutdown
  EndOfLog,
  Failed,      // the link was lost or a fault occurred
  Overturned,  // it lies on its side or its back
  Fallen,      // it drove off an edge
};
/// "out_of_time", as REST, the database and the command line spell it.
std::string_view name(Outcome outcome);

struct Metrics {
  std::uint64_t ticks = 0;
  double time = 0;         // [s]
  double path_length = 0;  // [m] sum of the tick-to-tick distances
  /// [m] Least distance from the hull to an obstacle; infinite in an empty world.
  double min_clearance = std::numeric_limits<double>::infinity();
  double intrusion = 0;  // [m] greatest depth into the circle of radius d_safe about the centre
  double infringed_time = 0;  // [s] with an obstacle inside it
  double turning = 0;         // [rad] total turning of the path resampled at 50 mm
  std::uint32_t via_points = 0;
  bool collided = false;
};

/// A path resampled at 50 mm.
class ResampledPath {
 public:
  struct Bend {
    double change = 0;  // [rad] of direction, from the segment before
    double length = 0;  // [m] of this segment
  };

  /// The bend at the newest segment, if `position_W` ends one that is not the first.
  std::optional<Bend> add(const Vec2& position_W);
  bool begun() const { return kept_W_.has_value(); }

 private:
  std::optional<Vec2> kept_W_{};
  std::optional<double> direction_{};  // [rad] of the last kept segment
};

/// Measures a run tick by tick. Uses the true pose and clearance if the robot has them, else the
/// odometry and the filtered scan.
class MetricsRecorder {
 public:
  void reset(const RobotSpec& spec);
  void add(const Telemetry& t, const Parameters& parameters);
  const Metrics& metrics() const { return metrics_; }

 private:
  void follow_path(const Vec2& position_W);
  void count_via(const Telemetry& t, double influence);

  Metrics metrics_{};
  double radius_ = 0;
  double period_ = 0;
  std::optional<double> first_stamp_{};
  std::optional<Vec2> last_W_{};  // position one tick ago
  ResampledPath path_{};
  std::optional<Vec2> counted_pass_W_{};
};

}  // namespace algo
