// server/experiment/standing.cpp: spells of rest between motions.
#include "server/experiment/standing.hpp"

#include <cmath>

namespace server::reproduce {
namespace {

constexpr double kSlow = 0.05;      // share of the top speed that still counts as rest
constexpr double kPause = 0.1;      // [s] that make a pause of it
constexpr double kRounding = 1e-9;  // [s] a sum of periods may fall short of their product

}  // namespace

bool StandingRecorder::at_rest(const algo::Pose2& from_W, const algo::Pose2& to_W) const {
  const double moved = (to_W.position() - from_W.position()).norm();
  const double turned = std::abs(algo::wrap_angle(to_W.heading - from_W.heading));
  return moved < kSlow * limits_.v_max * period_ && turned < kSlow * limits_.omega_max * period_;
}

void StandingRecorder::add(const algo::Telemetry& t) {
  if (!t.ground_truth) return;
  const algo::Pose2& pose = t.ground_truth->pose;
  if (last_W_ && at_rest(*last_W_, pose)) {
    figures_.time += period_;
    spell_ += period_;
  } else if (last_W_) {
    if (moved_ && spell_ >= kPause - kRounding) {
      ++figures_.pauses;
      figures_.pause_time += spell_;
    }
    moved_ = true;
    spell_ = 0;
  }
  last_W_ = pose;
}

}  // namespace server::reproduce
