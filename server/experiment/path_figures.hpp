// server/experiment/path_figures.hpp: what paper.json measures of a path beyond algo/metrics.hpp.
#pragma once

#include <optional>

#include "algo/telemetry.hpp"

namespace server::reproduce {

struct PathFigures {
  double body_infringed_time = 0;  // [s] an obstacle within d_safe of the hull
  double body_intrusion = 0;       // [m] how deep
  /// [rad2/m] Sum of (change of direction)^2 / length of the later segment, of the path resampled
  /// at 50 mm as for the turning.
  double bending = 0;
  /// Share of the strip before its via point, |P^j - P^{j-1}| / (|P^j - P^{j-1}| +
  /// |P^{j+1} - P^j|), over the ticks with an external force: the relative distance that K_c is
  /// said to keep.
  double share_mean = 0;
  double share_deviation = 0;   // standard deviation
  double largest_internal = 0;  // [m] the largest |F_int|
};

/// Follows a run tick by tick, the start included.
class PathRecorder {
 public:
  PathRecorder(double radius, double period) : radius_(radius), period_(period) {}
  void add(const algo::Telemetry& t, double safety_distance);
  PathFigures figures() const;

 private:
  void follow(const algo::Vec2& position_W);
  void follow_strip(const algo::ControlOutput& output);

  PathFigures figures_{};
  double radius_ = 0;  // [m]
  double period_ = 0;  // [s]
  bool started_ = false;
  std::optional<algo::Vec2> kept_W_{};
  std::optional<double> direction_{};  // [rad] of the last kept segment
  double shares_ = 0;                  // count
  double squares_ = 0;                 // of the deviations (Welford)
};

}  // namespace server::reproduce
