// algo/terrain/tilt_prediction.cpp: Eq. 13-19, and the memory of lines.
#include "algo/terrain/tilt_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace algo {
namespace {

constexpr double kSpacing = 0.02;                   // [m] of way between two lines
constexpr double kSteepest = std::numbers::pi / 4;  // [rad] steeper is a wall, not ground
constexpr double kWallReach = 0.05;                 // [m] between two lines that show a wall

/// `p` turned by `heading` [rad] about z.
Vec3 turned(double heading, const Vec3& p) {
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z()};
}

}  // namespace

double roll_change(double z_left, double z_right, double track) {
  return std::atan2(z_left - z_right, track);
}

double pitch_change(const Vec2& older, const Vec2& newer, TiltLaw law) {
  const Vec2 step = newer - older;
  if (law == TiltLaw::Literal) return std::atan(step.y() / step.x());
  return -std::atan2(step.y(), step.x());
}

Vec3 moved_into(const Vec3& p, const Attitude& then, const Attitude& now, double way, TiltLaw law) {
  const Vec3 moved(way * std::cos(then.pitch), 0, -way * std::sin(then.pitch));
  if (law == TiltLaw::Literal) return p - moved;
  return from_level(now, to_level(then, p) - moved);
}

TiltPrediction::TiltPrediction(const Stance& stance) : stance_(stance), lines_(kLines) {}

void TiltPrediction::reset() {
  next_ = 0;
  count_ = 0;
  place_ = {0, 0, 0};
  heading_ = 0;
  attitude_ = {};
}

void TiltPrediction::move(const Twist2& twist,
                          double heading,
                          const Attitude& attitude,
                          double dt) {
  const double way = twist.v * dt;
  place_ += turned(heading, to_level({.pitch = attitude.pitch}, {way, 0, 0}));
  heading_ = heading;
  attitude_ = attitude;
}

Vec3 TiltPrediction::in_robot(const Vec3& p) const {
  return from_level(attitude_, turned(-heading_, p - place_));
}

/// [m] Negative if the line does not lie ahead of the tracks.
double TiltPrediction::way_to(const Line& line) const {
  const Vec3 p = turned(-heading_, line.middle() - place_);
  return std::abs(p.y()) <= stance_.width / 2 ? p.x() : -1;
}

/// True if `line` lies on something upright, under either track: it is too high for where it is, or
/// the lines shortly before were too much higher or lower. A robot that turns before a wall sees
/// the line fall on it too. Ground below an edge lies on: only its first lines are left out.
bool TiltPrediction::upright(const Line& line) const {
  const auto wall = [this](const Vec3& before, const Vec3& now) {
    const Vec3 step = turned(-heading_, now - before);
    return std::abs(step.z()) > std::abs(step.x()) * std::tan(kSteepest);
  };
  for (const Vec3& end : {line.left, line.right}) {
    const Vec3 p = in_robot(end);
    if (p.z() > (p.x() - stance_.length / 2) * std::tan(kSteepest)) return true;
  }
  for (std::size_t age = 0; age < count_; ++age) {
    const Line& before = at(age);
    if ((line.middle() - before.middle()).norm() < kWallReach) continue;
    return wall(before.left, line.left) || wall(before.right, line.right);
  }
  return false;
}

/// x and z in R of the ground where the rear end of the tracks will stand when their front end
/// stands on the line at `front`: the newest line as far back as the tracks are long (Dk_2). Until
/// there is one, the ground under the front end of the tracks now.
Vec2 TiltPrediction::rear_of(double front) const {
  for (std::size_t age = 0; age < count_; ++age) {
    const Line& line = at(age);
    if (!line.ground || way_to(line) < 0) continue;
    const Vec3 p = in_robot(line.middle());
    if (front - p.x() >= stance_.length) return {p.x(), p.z()};
  }
  return {stance_.length / 2, 0};
}

void TiltPrediction::take(const TrackPoints& line_R) {
  const auto level = [this](const Vec3& p) {
    return Vec3(place_ + turned(heading_, to_level(attitude_, p)));
  };
  Line line{.left = level(line_R.left), .right = level(line_R.right)};
  if (count_ > 1 && (line.middle() - at(1).middle()).norm() < kSpacing) {
    next_ = (next_ + kLines - 1) % kLines;
    --count_;
  }
  line.ground = !upright(line);
  const Vec3 front = (line_R.left + line_R.right) / 2;
  const Vec2 rear = rear_of(front.x());
  const double track = line_R.left.y() - line_R.right.y();
  line.predicted = attitude_;
  line.predicted.roll += roll_change(line_R.left.z(), line_R.right.z(), track);
  if (front.x() > rear.x()) line.predicted.pitch += pitch_change(rear, {front.x(), front.z()});
  lines_[next_] = line;
  next_ = (next_ + 1) % kLines;
  count_ = std::min(count_ + 1, kLines);
}

std::optional<PredictedTilt> TiltPrediction::newest() const {
  if (count_ == 0 || !at(0).ground) return std::nullopt;
  return PredictedTilt{at(0).predicted, way_to(at(0))};
}

}  // namespace algo
