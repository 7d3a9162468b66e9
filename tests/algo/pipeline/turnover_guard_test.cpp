// tests/algo/pipeline/turnover_guard_test.cpp: a robot with a high centre of mass, on attitudes
// that the test sets.
#include "algo/pipeline/turnover_guard.hpp"

#include <cmath>
#include <numbers>

#include "tests/algo/allocations.hpp"
#include "tests/algo/pipeline/by_hand.hpp"
#include <gtest/gtest.h>

#include "algo/units.hpp"

namespace {

using algo::Attitude;
using algo::Joystick;
using algo::StickMode;
using by_hand::ByHand;
using namespace algo::units;

constexpr double kTurn = std::numbers::pi / 2;

/// The robot of Park et al., in the open.
struct OnSlope : ByHand {
  explicit OnSlope(double mass_height = 0.90) : ByHand(true) {
    spec.max_v = 0.86;
    spec.max_omega = kTurn;
    spec.max_acceleration = 1;
    spec.max_angular_acceleration = 6;
    spec.raw_stick = true;
    spec.stance = algo::Stance{.mass_height = mass_height, .width = 0.48, .length = 0.60};
  }
  /// The robot leans as `attitude`, whatever it does.
  void drive(const Joystick& stick, double seconds, const Attitude& attitude) {
    const double end = stamp + seconds;
    while (stamp < end - 1e-9) once(stick, attitude);
  }
  void once(const Joystick& stick, const Attitude& attitude) {
    sense();
    if (tilt_comes) t.observation.inclinometer = {stamp, attitude.roll, attitude.pitch};
    t.requests.clear();
    t.requests.push_back(stick);
    for (const algo::Request& request : further) t.requests.push_back(request);
    further.clear();
    const double before = t.command.base.v;
    pipeline->tick(t);
    hardest = std::max(hardest, std::abs(t.command.base.v - before) / spec.period);
    twist = t.command.base;
    pose = integrate_arc(pose, twist, spec.period);
    odometry = pose;
    stamp += spec.period;
  }
  double measured(const char* name) const { return t.output.measure(name).value(); }

  bool tilt_comes = true;
  std::vector<algo::Request> further{};
  double hardest = 0;  // [m/s2] change of the command
};

Joystick raw(double forward, double turn) {
  return {.forward = forward, .turn = turn, .mode = StickMode::Raw};
}

/// Eq. 25 with h 0.90 and a mass that may be 10 % higher:
/// 9.80665 (0.9848 x 0.48 / 1.98 - 0.1736) = 0.638 m/s2; of it 0.9, at 0.86 m/s.
TEST(TurnoverGuard, BoundsTheTurnOfEveryDriver) {
  for (const StickMode mode : {StickMode::Raw, StickMode::Guarded, StickMode::Elastic}) {
    OnSlope robot;
    robot.start();
    robot.drive({.forward = 1, .turn = 1, .mode = mode}, 3, {.roll = 10_deg});
    const double v = robot.t.observation.odometry.twist.v;  // 0 for a goal pulled in a circle
    if (mode != StickMode::Elastic) {
      EXPECT_GT(v, 0.2);
    }
    const double bound = v > 0 ? std::min(kTurn, 0.9 * 0.638 / v) : kTurn;
    EXPECT_NEAR(robot.measured("turnover.w_max"), bound, 0.003);
    EXPECT_LE(robot.t.command.base.omega, robot.measured("turnover.w_max"));
    EXPECT_EQ(robot.measured("turnover.w_min"), -kTurn);
  }
  OnSlope goal;
  goal.start();
  goal.further.push_back(algo::SetGoal{{-5, 3}, std::nullopt});
  for (int k = 0; k < 100; ++k) {
    goal.once({}, {.roll = 13_deg});
    EXPECT_LE(goal.t.command.base.omega, goal.measured("turnover.w_max") + 1e-12);
  }
}

TEST(TurnoverGuard, SaysThatItLimits) {
  OnSlope robot;
  robot.start();
  robot.drive(raw(1, 1), 3, {.roll = 10_deg});
  EXPECT_EQ(robot.t.limit, algo::limits::kTurnover);
  EXPECT_NEAR(robot.t.command.base.v, 0.86, 1e-12);
  EXPECT_LT(robot.measured("turnover.force_left"), 0) << "the hand is pushed back";
  robot.drive(raw(1, 0), 0.5, {.roll = 10_deg});
  EXPECT_FALSE(robot.t.limit);
  EXPECT_EQ(robot.measured("turnover.force_left"), 0);
  // On the flat, and with the mass low, it never binds.
  robot.drive(raw(1, 1), 0.5, {});
  EXPECT_FALSE(robot.t.limit);
  OnSlope low(0.25);
  low.start();
  low.drive(raw(1, 1), 3, {.roll = 20_deg});
  EXPECT_FALSE(low.t.limit);
  EXPECT_NEAR(low.t.command.base.omega, kTurn, 1e-12);
}

TEST(TurnoverGuard, SharesAreParameters) {
  OnSlope robot;
  robot.start();
  robot.further = {algo::SetParameter{&algo::kTurnoverShare, 0.5},
                   algo::SetParameter{&algo::kMassMargin, 0}};
  robot.drive(raw(1, 1), 3, {.roll = 10_deg});
  EXPECT_NEAR(robot.measured("turnover.w_max"), 0.5 * 0.8725 / 0.86, 1e-3);
}

/// The standing limit of h 0.99 is 13.6 degrees.
TEST(TurnoverGuard, StopsWhereItCannotStand) {
  OnSlope robot;
  robot.start();
  robot.drive(raw(1, 0), 2, {});
  robot.drive(raw(1, 1), 2, {.roll = -14_deg});
  EXPECT_EQ(robot.t.command.base.v, 0);
  EXPECT_NEAR(robot.t.command.base.omega, kTurn, 1e-12) << "it may turn on the spot";
  EXPECT_EQ(robot.t.limit, algo::limits::kTooSteepHere);
  EXPECT_FALSE(robot.t.limit.why.empty());
  robot.drive(raw(-1, 0), 2, {.roll = -14_deg});
  EXPECT_NEAR(robot.t.command.base.v, -0.1, 1e-12) << "and back away";
}

/// The left side rises by 10 degrees a second: 8.5 degrees 0.35 s after it has 5.
TEST(TurnoverGuard, TurnsAsTheTrendOfTheAttitudeDemands) {
  OnSlope robot;
  robot.start();
  robot.drive(raw(1, 0), 2, {});
  double roll = 0;
  for (; roll < 5_deg - 1e-9; roll += 10_deg * robot.spec.period)
    robot.once(raw(1, 0), {.roll = roll});
  robot.once(raw(1, 1), {.roll = roll});
  const double soon = roll + 10_deg * 0.35;
  const double bound = algo::sideways_range({.roll = soon}, {0.99, 0.48, 0.60}).max;
  EXPECT_NEAR(robot.measured("turnover.w_max"), 0.9 * bound / 0.86, 1e-3);
  EXPECT_LT(0.9 * bound / 0.86, kTurn);
}

/// On 10 degrees along the tracks, too, the uphill track must hold its half of the pull with a
/// friction of 0.5: 1 - 0.1736 / (0.5 x 0.9698) = 0.642 of the bound is left for the turn.
TEST(TurnoverGuard, LeavesTheUphillTrackItsGrip) {
  OnSlope robot;
  robot.start();
  const Attitude askew{.roll = 8_deg, .pitch = 10_deg};
  robot.drive(raw(1, 0), 3, askew);
  robot.once(raw(1, 1), askew);
  const double share = 1 - std::sin(10_deg) / (0.5 * std::cos(8_deg) * std::cos(10_deg));
  EXPECT_NEAR(share, 0.64, 0.01);
  const double bound = algo::sideways_range(askew, {0.99, 0.48, 0.60}).max;
  EXPECT_NEAR(robot.measured("turnover.w_max"), share * bound / 0.86, 1e-3);
}

/// The right side is up: a turn to the right pushes the robot over, until it is slow.
TEST(TurnoverGuard, TurnsNotUphillWhileItLosesItsStand) {
  OnSlope robot;
  robot.start();
  robot.drive(raw(1, 0), 2, {});
  for (int k = 0; k < 10; ++k) {
    robot.once(raw(1, -1), {.roll = -14_deg});
    EXPECT_EQ(robot.t.command.base.omega, 0);
    EXPECT_GT(robot.t.command.base.v, 0.15);
    EXPECT_EQ(robot.t.limit, algo::limits::kTooSteepHere);
  }
  robot.once(raw(1, 1), {.roll = -14_deg});
  EXPECT_NEAR(robot.t.command.base.omega, kTurn, 1e-12) << "downhill it may";
  robot.drive(raw(1, -1), 2, {.roll = -14_deg});
  EXPECT_NEAR(robot.t.command.base.omega, -kTurn, 1e-12) << "on the spot, too";
}

TEST(TurnoverGuard, BacksSlowlyWithoutAGuard) {
  OnSlope tall;
  tall.start();
  tall.drive(raw(-1, 0), 3, {});
  EXPECT_NEAR(tall.t.command.base.v, -0.2, 1e-12);
  EXPECT_EQ(tall.t.limit, algo::limits::kBlindBack);
  OnSlope low(0.25);
  low.start();
  low.drive(raw(-1, 0), 3, {});
  EXPECT_NEAR(low.t.command.base.v, -0.86, 1e-12);
}

/// 0.9 x 9.80665 (0.9848 x 0.6 / 1.98 - 0.1736) = 1.101 m/s2 on 10 degrees.
TEST(TurnoverGuard, BrakesNoHarderThanItStands) {
  for (const Attitude& attitude : {Attitude{}, Attitude{.pitch = 10_deg}, {.pitch = -10_deg}}) {
    const double most = algo::along_limit(attitude, {0.99, 0.48, 0.60}, 0.9);
    OnSlope robot;
    robot.start();
    robot.drive(raw(1, 0), 3, attitude);
    EXPECT_LE(robot.hardest, most + 1e-9) << "accelerating";
    ASSERT_NEAR(robot.t.command.base.v, 0.86, 1e-12);
    robot.further.push_back(algo::Stop{true});
    robot.once(raw(1, 0), attitude);
    EXPECT_EQ(robot.t.hold, algo::holds::kStopped);
    EXPECT_NEAR(robot.t.command.base.v, 0.86 - most * robot.spec.period, 1e-9);
    robot.drive(raw(1, 0), 1, attitude);
    EXPECT_EQ(robot.t.command.base.v, 0);
    EXPECT_LE(robot.hardest, most + 1e-9) << "stopping";
  }
}

/// Where the slope allows less braking than the base can do, those who plan to stop know it.
TEST(TurnoverGuard, PlansWithTheBrakingThatTheSlopeAllows) {
  OnSlope robot;
  algo::TurnoverGuard guard(robot.spec);
  algo::Observation seen;
  seen.inclinometer = algo::Inclinometer{0, 0, 13_deg};
  const algo::Parameters parameters;
  algo::Resource in;
  in.dt = 0.025;
  in.observation = &seen;
  in.parameters = &parameters;
  in.spec = &robot.spec;
  algo::ControlOutput out;
  EXPECT_FALSE(guard.propose(in, out).active);
  EXPECT_NEAR(guard.spec().max_acceleration,
              algo::along_limit({.pitch = 13_deg}, {0.99, 0.48, 0.60}, 0.9),
              1e-12);
  seen.inclinometer->pitch = 0;
  guard.propose(in, out);
  EXPECT_EQ(guard.spec().max_acceleration, 1);
}

/// A brake begins at the real speed, so that a robot that is still slow does not push on.
TEST(TurnoverGuard, EasesFromTheRealSpeed) {
  OnSlope robot;
  algo::TurnoverGuard guard(robot.spec);
  for (int k = 0; k < 200; ++k) guard.eased(0.86, {.twist = {0.3, 0}});
  EXPECT_NEAR(guard.eased(0.86, {.twist = {0.3, 0}}), 0.86, 1e-12);
  EXPECT_LE(guard.eased(0, {.twist = {0.3, 0}}), 0.3);
}

TEST(TurnoverGuard, AStaleInclinometerHoldsTheRobot) {
  OnSlope robot;
  robot.start();
  robot.drive(raw(1, 0), 2, {});
  EXPECT_FALSE(robot.t.hold);
  robot.tilt_comes = false;
  robot.drive(raw(1, 0), 0.15, {});
  EXPECT_FALSE(robot.t.hold);
  robot.drive(raw(1, 0), 1, {});
  EXPECT_EQ(robot.t.hold, algo::holds::kStaleTilt);
  EXPECT_EQ(robot.t.command.base.v, 0);
  EXPECT_EQ(robot.t.words.what, "Waiting for the inclinometer");
  robot.tilt_comes = true;
  robot.drive(raw(1, 0), 1, {});
  EXPECT_FALSE(robot.t.hold);
  OnSlope never;
  never.start();
  never.tilt_comes = false;
  never.drive(raw(1, 0), 0.1, {});
  EXPECT_EQ(never.t.hold, algo::holds::kNoTilt);
  EXPECT_EQ(never.t.words.why,
            "No reading has come yet. Without it the robot does not know how it leans.");
}

/// It needs no guard against turning over, but measures slopes by its inclinometer.
TEST(TurnoverGuard, ALowRobotWithAnInclinometerIsHeldWithoutItToo) {
  OnSlope robot;
  robot.spec.stance.reset();
  robot.spec.inclinometer = true;
  robot.start();
  robot.tilt_comes = false;
  robot.drive(raw(1, 0), 0.1, {});
  EXPECT_EQ(robot.t.hold, algo::holds::kNoTilt);
  robot.tilt_comes = true;
  robot.drive(raw(1, 0), 0.5, {});
  EXPECT_FALSE(robot.t.hold);
  robot.tilt_comes = false;
  robot.drive(raw(1, 0), 0.5, {});
  EXPECT_EQ(robot.t.hold, algo::holds::kStaleTilt);
  EXPECT_EQ(robot.t.command.base, algo::Twist2{});
}

algo::LineCamera camera() {
  return {.x = 0.33,
          .height = 0.45,
          .pitch = 44_deg,
          .baseline = 0.20,
          .angle = 73.14_deg,
          .focal = 600,
          .columns = 640,
          .rows = 480};
}

/// A line across a plane that leans to the left by `roll` [rad], without noise.
void see_line(double roll, algo::Observation& observation) {
  const algo::LineCamera c = camera();
  observation.line.fresh = true;
  observation.line.stamp = observation.stamp;
  for (int u = -315; u <= 315; u += 10) {
    // The row v at which the triangulated point lies on the plane z = y tan(roll), by bisection.
    double low = -150;
    double high = 240;
    for (int k = 0; k < 60; ++k) {
      const double v = (low + high) / 2;
      const algo::Vec3 p = algo::to_robot(c, *algo::triangulated(c, u, v));
      (p.z() < p.y() * std::tan(roll) ? low : high) = v;
    }
    observation.line.pixels.push_back({static_cast<float>(u), static_cast<float>(low)});
  }
}

/// The robot is level yet, but the ground ahead is not.
TEST(TurnoverGuard, LooksAheadByTheLine) {
  OnSlope robot;
  robot.spec.line = camera();
  robot.start();
  const auto drive = [&](double seconds, double roll_ahead) {
    const double end = robot.stamp + seconds;
    while (robot.stamp < end - 1e-9) {
      robot.sense();
      see_line(roll_ahead, robot.t.observation);
      robot.t.observation.inclinometer = {robot.stamp, 0, 0};
      robot.t.requests.clear();
      robot.t.requests.push_back(raw(1, 0));
      robot.pipeline->tick(robot.t);
      robot.twist = robot.t.command.base;
      robot.pose = integrate_arc(robot.pose, robot.twist, robot.spec.period);
      robot.odometry = robot.pose;
      robot.stamp += robot.spec.period;
    }
  };
  drive(3, 0);
  EXPECT_NEAR(robot.measured("turnover.roll_predicted"), 0, 1e-3);
  EXPECT_EQ(robot.measured("turnover.w_max"), kTurn);
  // 0.8 m ahead; it counts from 0.5 m on, after 0.3 m.
  drive(0.3, 10_deg);
  EXPECT_NEAR(robot.measured("terrain.profile_roll"), 10_deg, 2e-3);
  EXPECT_EQ(robot.measured("turnover.w_max"), kTurn);
  drive(0.2, 10_deg);  // the first lines after so sudden a bank count as a wall
  EXPECT_NEAR(robot.measured("turnover.roll_predicted"), 10_deg, 2e-3);
  EXPECT_NEAR(robot.measured("turnover.w_max"), 0.9 * 0.638 / 0.86, 0.01);
  drive(1.5, 14_deg);
  EXPECT_EQ(robot.t.command.base.v, 0) << "it could not stand there";
  EXPECT_EQ(robot.t.limit, algo::limits::kTooSteepAhead);
  const algo::Layer& line = robot.t.layers.back();
  EXPECT_EQ(line.name, "terrain.line");
  EXPECT_EQ(line.axes, 3);
  EXPECT_EQ(line.values.size(), 3 * 64U);
}

TEST(TurnoverGuard, AllocatesNothing) {
  OnSlope robot;
  robot.spec.line = camera();
  robot.start();
  const auto tick = [&] {
    robot.sense();
    see_line(5_deg, robot.t.observation);
    robot.t.observation.inclinometer = {robot.stamp, 0, 0};
    robot.t.requests.clear();
    robot.t.requests.push_back(raw(1, 0.3));
    const std::size_t before = allocations::count();
    robot.pipeline->tick(robot.t);
    robot.stamp += robot.spec.period;
    return allocations::count() - before;
  };
  for (int k = 0; k < 200; ++k) tick();
  for (int k = 0; k < 50; ++k) EXPECT_EQ(tick(), 0U);
}

TEST(TurnoverGuard, ARobotThatCannotTurnOverHasNoneOfIt) {
  ByHand robot;
  robot.start();
  robot.idle(0.5);
  EXPECT_FALSE(robot.t.output.measure("turnover.w_max"));
  for (const algo::Layer& layer : robot.t.layers) EXPECT_NE(layer.name, "terrain.line");
}

}  // namespace
