// tests/sim/turnover_test.cpp: when the simulated robot turns over, against Park et al. 2005.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "server/run/robot_library.hpp"
#include "sim/bullet_vehicle.hpp"

namespace sim {
namespace {

constexpr double kRollDegree = std::numbers::pi / 180;
constexpr double kSpeed = 0.86;    // [m/s] the robot's fastest
constexpr double kTipped = 0.7;    // z of the body's upright axis, below which it turns over
constexpr double kGravity = 9.81;  // [m/s2]

double upright(const VehicleState& state) {
  return std::cos(state.roll) * std::cos(state.pitch);
}

struct RampedTurn {
  double period = 0;  // [s] of a step
  double roll = 0;    // [rad]
  double friction = 0;
};

/// True if the tall robot turns over in a left turn that ramps up to `omega`.
bool tips(const RampedTurn& turn, double omega) {
  RobotModel robot = server::builtin_robot("robhaz_tall");
  robot.friction = turn.friction;
  robot.max_omega = 20;
  robot.max_angular_acceleration = 1;
  BulletVehicle vehicle(robot, turn.period);
  ObstacleSet nothing;
  PoseTrail trail(Substeps(turn.period).length, 0.1);
  vehicle.reset({});
  vehicle.lean(turn.roll);
  const double until =
      1 + omega + 6;  // straight, the ramp, the turn: near the bound it tips slowly
  for (double stamp = 0; stamp < until; stamp += turn.period) {
    vehicle.drive({kSpeed, stamp < 1 ? 0 : omega}, nothing, trail);
    if (upright(vehicle.state()) < kTipped) return true;
  }
  return false;
}

/// [m/s2] The product of speed and turn rate at which it turns over.
double boundary(const RampedTurn& turn, double expected) {
  double low = 0.8 * expected / kSpeed;
  double high = 1.2 * expected / kSpeed;
  if (tips(turn, low)) return 0;
  if (!tips(turn, high)) return std::numeric_limits<double>::infinity();
  while ((high - low) > 0.002 * high) {
    const double middle = (low + high) / 2;
    (tips(turn, middle) ? high : low) = middle;
  }
  return kSpeed * (low + high) / 2;
}

/// Eq. 25 for a left turn of the tall robot: track 0.48 m, centre of mass at 0.9 m.
double bound(double roll) {
  return kGravity * (std::cos(roll) * 0.48 / (2 * 0.9) - std::sin(roll));
}

TEST(Turnover, BeginsWhereThePaperSays) {
  for (const double friction : {0.6, 2.0}) {
    for (const double roll : {-10 * kRollDegree, 0.0, 10 * kRollDegree}) {
      const double expected = bound(roll);
      EXPECT_NEAR(boundary({0.001, roll, friction}, expected) / expected, 1, 0.02)
          << roll / kRollDegree << " degrees at 1 kHz, mu " << friction;
      EXPECT_NEAR(boundary({1.0 / 240, roll, friction}, expected) / expected, 1, 0.05)
          << roll / kRollDegree << " degrees at 240 Hz, mu " << friction;
    }
  }
}

/// Fig. 12 as physics.md 4 lays it out: straight up the slope, right onto the contour, then hard
/// left. @return when it turns over [s]
std::optional<double> figure_12(const std::string& name, double slope) {
  constexpr double kPeriod = 0.001;  // [s]
  RobotModel robot = server::builtin_robot(name);
  robot.max_acceleration = 0.8;
  BulletVehicle vehicle(robot, kPeriod);
  ObstacleSet ground;
  PoseTrail trail(Substeps(kPeriod).length, 0.1);
  const double length = 8 * std::cos(slope);
  const algo::Obstacle ramp{.id = 1,
                            .pose_W = {0, length / 2, 90 * kRollDegree},
                            .shape = algo::Ramp{length, 12, 0},
                            .height = length * std::tan(slope)};
  vehicle.reset({0, -1.5, 90 * kRollDegree});
  ground.add(ramp);
  vehicle.added(ramp);
  vehicle.stand_on(ground);
  enum class Leg { Up, Right, Along, Left } leg = Leg::Up;
  for (double stamp = 0; stamp < 11; stamp += kPeriod) {
    const VehicleState& state = vehicle.state();
    if (leg == Leg::Up && state.pose_W.y > 0.55) leg = Leg::Right;
    if (leg == Leg::Right && state.pose_W.heading < 6 * kRollDegree) leg = Leg::Along;
    if (leg == Leg::Along && state.pose_W.x > 1.6) leg = Leg::Left;
    algo::Twist2 stick{stamp < 0.5 ? 0 : kSpeed, 0};
    if (leg == Leg::Right) stick.omega = -0.7;
    if (leg == Leg::Left) stick.omega = 90 * kRollDegree;
    vehicle.drive(stick, ground, trail);
    if (upright(state) < kTipped) return stamp;
  }
  return std::nullopt;
}

TEST(Turnover, Figure12WithoutAController) {
  const auto tall = figure_12("robhaz_tall", 10 * kRollDegree);
  ASSERT_TRUE(tall);
  EXPECT_NEAR(*tall, 8.2, 0.5);
  EXPECT_FALSE(figure_12("robhaz_tall", 5 * kRollDegree));
  EXPECT_FALSE(figure_12("robhaz", 10 * kRollDegree));
}

}  // namespace
}  // namespace sim
