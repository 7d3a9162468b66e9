// server/experiment/oracle.cpp: rolls out the motions tried with hindsight.
#include "server/experiment/oracle.hpp"

#include <algorithm>
#include <cmath>

#include "algo/full_strip/motion.hpp"
#include "sim/obstacle_set.hpp"

namespace server::experiment {
namespace {

constexpr double kBefore = 3;      // [s] before the contact, when the motions begin
constexpr double kAfter = 1;       // [s] after the contact, until which they must stay clear
constexpr double kStep = 0.05;     // [s]
constexpr double kJump = 1.0;      // [m] in one step: a jump, not a motion
constexpr double kTouch = 0.1;     // [m] from the hull: an obstacle this near was touched
constexpr std::size_t kArcs = 10;  // turn rates, at full and at half speed

/// The world's obstacles at their true positions at a given time.
class Truth {
 public:
  explicit Truth(const sim::Scenario& scenario) : scenario_(scenario) {
    for (const algo::Obstacle& obstacle : scenario.obstacles) set_.add(obstacle);
  }
  const sim::ObstacleSet& at(double stamp) {
    for (std::size_t i = 0; i < scenario_.obstacles.size(); ++i) {
      const algo::Obstacle& obstacle = scenario_.obstacles[i];
      if (!obstacle.path) continue;
      if (obstacle.path->is_there(stamp)) {
        const algo::Vec2 p_W = obstacle.path->at(stamp);
        set_.move(i, {p_W.x(), p_W.y(), 0});
      } else {
        set_.hide(i);
      }
    }
    return set_;
  }

 private:
  const sim::Scenario& scenario_;
  sim::ObstacleSet set_{};
};

sim::Hull hull_of(const algo::RobotSpec& spec) {
  return {spec.radius, spec.half_length, spec.half_width};
}

/// True if an obstacle that the robot touched, or nearly touched, jumped or appeared in the time
/// before the contact.
bool jumped(const sim::Scenario& scenario, const algo::RobotSpec& spec, const Moment& contact) {
  return std::ranges::any_of(scenario.obstacles, [&](const algo::Obstacle& obstacle) {
    if (!obstacle.path) return false;
    const algo::ObstaclePath& path = *obstacle.path;
    if (!path.is_there(contact.stamp)) return false;
    const double far = (path.at(contact.stamp) - contact.pose_W.position()).norm();
    const auto* const cylinder = std::get_if<algo::Cylinder>(&obstacle.shape);
    const double radius = cylinder != nullptr ? cylinder->radius : 0;
    if (far > radius + spec.radius + kTouch) return false;
    const double begin = contact.stamp - kBefore;
    const int steps = static_cast<int>(std::lround(kBefore / kStep));
    for (int k = 1; k <= steps; ++k) {
      if (!path.is_there(begin + k * kStep)) return true;
      const algo::Vec2 before_W = path.at(begin + (k - 1) * kStep);
      if ((path.at(begin + k * kStep) - before_W).norm() > kJump) return true;
    }
    return false;
  });
}

bool stays_clear(Truth& truth,
                 const algo::RobotSpec& spec,
                 const algo::MotionLimits& limits,
                 const Moment& from,
                 double until,
                 const algo::Twist2& command) {
  algo::MotionState state{from.pose_W, from.twist};
  const int steps = static_cast<int>(std::lround((until - from.stamp) / kStep));
  for (int k = 1; k <= steps; ++k) {
    state = algo::advanced(state, command, limits, kStep);
    if (truth.at(from.stamp + k * kStep).clearance(hull_of(spec), state.pose_W) <= 0) return false;
  }
  return true;
}

std::vector<algo::Twist2> motions(const algo::MotionLimits& limits) {
  std::vector<algo::Twist2> out{{0, 0}, {-limits.max_v, 0}};
  for (const double share : {1.0, 0.5}) {
    for (std::size_t i = 0; i < kArcs; ++i) {
      const double turn = -1 + 2 * static_cast<double>(i) / (kArcs - 1);
      out.push_back({share * limits.max_v, turn * limits.max_omega});
    }
  }
  return out;
}

}  // namespace

Contact judge_contact(const sim::Scenario& scenario,
                      const algo::RobotSpec& spec,
                      const std::vector<Moment>& trail) {
  if (trail.empty()) return Contact::Unavoidable;
  const Moment& contact = trail.back();
  if (jumped(scenario, spec, contact)) return Contact::Jumped;
  const auto from = std::ranges::find_if(
      trail, [&](const Moment& m) { return m.stamp >= contact.stamp - kBefore - 1e-9; });
  const algo::MotionLimits limits = algo::limits_of(spec);
  Truth truth(scenario);
  const bool avoidable = std::ranges::any_of(motions(limits), [&](const algo::Twist2& motion) {
    return stays_clear(truth, spec, limits, *from, contact.stamp + kAfter, motion);
  });
  return avoidable ? Contact::Avoidable : Contact::Unavoidable;
}

}  // namespace server::experiment
