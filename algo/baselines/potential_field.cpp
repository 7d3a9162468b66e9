// algo/baselines/potential_field.cpp: the two forces, and the motion of the robot under them.
#include "algo/baselines/potential_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "algo/baselines/returns.hpp"

namespace algo {
namespace {

constexpr double kLeastRho = 0.05;  // [m] smallest rho (equations.md F.3)
constexpr double kGap = 0.3;  // [m] [D] a jump between neighbours that separates two obstacles

/// Groups points that come in order of bearing, and keeps the nearest point of each group.
class NearestOfEach {
 public:
  NearestOfEach(const Vec2& robot_W, std::vector<Vec2>& points_W)
      : robot_W_(robot_W), points_W_(points_W) {
    points_W_.clear();
  }
  /// Adds a return. The caller starts a new group after a gap in range or bearing.
  void add(const Vec2& point_W, bool new_group) {
    if (new_group || points_W_.empty()) {
      points_W_.push_back(point_W);
    } else if ((point_W - robot_W_).squaredNorm() < (points_W_.back() - robot_W_).squaredNorm()) {
      points_W_.back() = point_W;
    }
  }

 private:
  Vec2 robot_W_;
  std::vector<Vec2>& points_W_;
};

constexpr ParameterInfo kPull{
    .name = "potential_field.attraction",
    .label = "Attraction k_a",
    .unit = "1/m",
    .min = 0.1,
    .max = 10,
    .step = 0.1,
    .initial = 1.0,
    .help = "How strongly the goal pulls, for each metre of its distance."};
constexpr ParameterInfo kPush{
    .name = "potential_field.repulsion",
    .label = "Repulsion eta",
    .unit = "m2",
    .max = 5,
    .step = 0.05,
    .initial = 0.5,
    .help = "How strongly each obstacle within the safety distance pushes."};
constexpr auto kPotentialParameters = std::to_array<const ParameterInfo*>(
    {&kPull, &kPush, &kSafetyDistance, &kMaxSpeed, &kMaxTurnRate, &kHeadingGain, &kGoalReach});

}  // namespace

ParameterList PotentialField::parameters() {
  return kPotentialParameters;
}

Vec2 attraction(const PotentialSettings& settings, const Vec2& p_W, const Vec2& goal_W) {
  const Vec2 pull = settings.k_a * (goal_W - p_W);
  const double size = pull.norm();
  return size > settings.f_max ? Vec2(pull * (settings.f_max / size)) : pull;
}

Vec2 repulsion(const PotentialSettings& settings, const Vec2& p_W, const Vec2& obstacle_W) {
  const Vec2 away = p_W - obstacle_W;
  const double distance = away.norm();
  if (!(distance > 0) || distance > settings.rho_0) return {0, 0};
  const double rho = std::max(distance, kLeastRho);
  const double size = settings.eta * (1 / rho - 1 / settings.rho_0) / (rho * rho);
  return size * away / distance;
}

void nearest_points(const ControlInput& in, std::vector<Vec2>& points_W) {
  const Pose2& pose = in.odometry.pose;
  NearestOfEach groups(pose.position(), points_W);
  if (lacks_laser(*in.scene)) {
    for (const Echo& echo : in.scene->echoes) {
      if (echo.hit) groups.add(echo.point_W, true);
    }
    return;
  }
  const LaserScan& scan = in.scene->scan;
  bool open = false;  // the previous beam was a return or Invalid
  double range = 0;   // [m] of the previous return
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] == Beam::Free) open = false;
    if (scan.status[i] != Beam::Ok) continue;
    const bool same = open && std::abs(scan.ranges[i] - range) <= kGap;
    groups.add(beam_point_W(pose, scan.mount_R, scan.angle(i), scan.ranges[i]), !same);
    open = true;
    range = scan.ranges[i];
  }
}

void PotentialField::forget() {
  constexpr std::size_t kMost = 1024;  // beams of the finest scan, hence the most groups
  obstacles_W_.reserve(kMost);
}

void PotentialField::steer(const ControlInput& in,
                           const Parameters& parameters,
                           ControlOutput& out) {
  out.state = 1;
  PotentialSettings settings;
  settings.k_a = parameters[kPull];
  settings.eta = parameters[kPush];
  settings.rho_0 = parameters[kSafetyDistance] + in.spec->radius;
  const Vec2 p = in.odometry.pose.position();
  Vec2 force = attraction(settings, p, goal_W(in));
  nearest_points(in, obstacles_W_);
  for (const Vec2& obstacle : obstacles_W_) force += repulsion(settings, p, obstacle);
  if (!(force.norm() > 0)) return;  // pull and pushes cancel: no direction
  const double share = std::min(1.0, force.norm() / settings.f_max);
  steer_along(in, std::atan2(force.y(), force.x()), share * parameters[kMaxSpeed], parameters, out);
}

}  // namespace algo
