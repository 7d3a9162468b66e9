// server/experiment/path_figures.cpp: one tick at a time.
#include "server/experiment/path_figures.hpp"

#include <algorithm>
#include <cmath>

namespace server::reproduce {
namespace {

constexpr double kResample = 0.050;  // [m] between kept positions, as for the turning

}  // namespace

void PathRecorder::add(const algo::Telemetry& t, double safety_distance) {
  if (!t.ground_truth) return;
  const double clearance = t.ground_truth->obstacle_distance - radius_;
  figures_.body_intrusion = std::max(figures_.body_intrusion, safety_distance - clearance);
  // A tick is the time since the one before: at the start none has gone by.
  if (started_ && clearance < safety_distance) figures_.body_infringed_time += period_;
  started_ = true;
  follow(t.ground_truth->pose.position());
  follow_strip(t.output);
}

void PathRecorder::follow(const algo::Vec2& position_W) {
  if (!kept_W_) {
    kept_W_ = position_W;
    return;
  }
  const algo::Vec2 segment = position_W - *kept_W_;
  const double length = segment.norm();
  if (length < kResample) return;
  const double direction = std::atan2(segment.y(), segment.x());
  if (direction_) {
    const double change = algo::wrap_angle(direction - *direction_);
    figures_.bending += change * change / length;
  }
  direction_ = direction;
  kept_W_ = position_W;
}

void PathRecorder::follow_strip(const algo::ControlOutput& output) {
  figures_.largest_internal = std::max(figures_.largest_internal, output.internal_W.norm());
  const bool pushed = output.external_left_W.norm() + output.external_right_W.norm() > 0;
  if (output.strip.size() != 3 || !pushed) return;
  const double before = (output.strip[1].position_W - output.strip[0].position_W).norm();
  const double after = (output.strip[2].position_W - output.strip[1].position_W).norm();
  if (!(before + after > 0)) return;
  const double share = before / (before + after);
  shares_ += 1;
  const double off = share - figures_.share_mean;
  figures_.share_mean += off / shares_;
  squares_ += off * (share - figures_.share_mean);
}

PathFigures PathRecorder::figures() const {
  PathFigures out = figures_;
  if (shares_ > 1) out.share_deviation = std::sqrt(squares_ / (shares_ - 1));
  return out;
}

}  // namespace server::reproduce
