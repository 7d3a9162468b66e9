// server/experiment/standing.hpp: how long a robot stands still on its way.
#pragma once

#include <cstdint>
#include <optional>

#include "algo/telemetry.hpp"

namespace server::reproduce {

struct StandingFigures {
  double time = 0;        // [s] at rest, all of it
  double pause_time = 0;  // [s] of it in pauses
  /// Times it came to rest for 0.1 s or more and then drove on: the rest before the first motion
  /// and the one a run ends in are none.
  std::uint32_t pauses = 0;
};

/// Follows a run tick by tick, the start included. At rest: by the true pose, slower than 5 % of
/// the top speed and turning slower than 5 % of the top turn rate; who turns on the spot is about
/// something.
class StandingRecorder {
 public:
  struct Limits {
    double v_max = 0;      // [m/s]
    double omega_max = 0;  // [rad/s]
  };
  StandingRecorder(const Limits& limits, double period) : limits_(limits), period_(period) {}
  void add(const algo::Telemetry& t);
  const StandingFigures& figures() const { return figures_; }

 private:
  bool at_rest(const algo::Pose2& from_W, const algo::Pose2& to_W) const;

  StandingFigures figures_{};
  Limits limits_{};
  double period_ = 0;  // [s]
  std::optional<algo::Pose2> last_W_{};
  double spell_ = 0;  // [s] of the present rest
  bool moved_ = false;
};

}  // namespace server::reproduce
