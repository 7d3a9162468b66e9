// tests/algo/pipeline/reactive_test.cpp: which behaviour wins, which limits apply, and how long a
// proposal is held.
#include "algo/pipeline/reactive.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace algo {
namespace {

class Scripted final : public Behaviour {
 public:
  Scripted(Name name, Proposal wanted, double period = 0)
      : proposal(wanted), name_(name), period_(period) {}
  Name name() const override { return name_; }
  double period() const override { return period_; }
  void reset(const Pose2& /*start_W*/) override { samples = 0; }
  Proposal propose(const Resource& /*resource*/, ControlOutput& /*output*/) override {
    ++samples;
    return proposal;
  }
  int samples = 0;
  Proposal proposal;

 private:
  Name name_;
  double period_;
};

struct CoordinatorTest : ::testing::Test {
  CoordinatorTest() {
    resource.dt = 0.025;
    resource.observation = &observation;
    resource.scene = &scene;
    resource.parameters = &parameters;
    resource.spec = &spec;
    resource.merge = &merge;
  }
  Scripted* add(Name name, Proposal proposal, double period = 0) {
    auto behaviour = std::make_unique<Scripted>(name, proposal, period);
    Scripted* raw = behaviour.get();
    coordinator.add(std::move(behaviour));
    return raw;
  }
  Observation observation{};
  Scene scene{};
  SensorMerge merge{};
  Parameters parameters{};
  RobotSpec spec{};
  Resource resource{};
  ControlOutput output{};
  BehaviourCoordinator coordinator{};
};

TEST_F(CoordinatorTest, NoActiveBehaviourMeansRest) {
  add(behaviours::kAvoid, {.active = false, .twist = {1, 1}});
  const Decision decision = coordinator.decide(resource, output);
  EXPECT_EQ(decision.winner, behaviours::kRest);
  EXPECT_EQ(decision.twist, Twist2{});
}

TEST_F(CoordinatorTest, TheFirstActiveBehaviourWinsAndAllLimitsApply) {
  add(behaviours::kManual, {.active = true, .twist = {0.5, 0.4}, .limits = {.v_max = 0.4}});
  add(behaviours::kAvoid,
      {.active = true, .twist = {0.1, 0}, .limits = {.v_max = 0.2, .omega_max = 0.3}});
  const Decision decision = coordinator.decide(resource, output);
  EXPECT_EQ(decision.winner, behaviours::kManual);
  EXPECT_DOUBLE_EQ(decision.twist.v, 0.2);
  EXPECT_DOUBLE_EQ(decision.twist.omega, 0.3);
}

TEST_F(CoordinatorTest, ALimitOfANonDrivingBehaviourAppliesAndIsNamed) {
  add(behaviours::kManual,
      {.active = false, .limits = {.v_max = 0.1, .reason = {"slope", "The ground falls away."}}});
  add(behaviours::kAvoid, {.active = true, .twist = {0.5, -0.2}, .limits = {.omega_min = -0.5}});
  const Decision decision = coordinator.decide(resource, output);
  EXPECT_EQ(decision.winner, behaviours::kAvoid);
  EXPECT_EQ(decision.twist, (Twist2{0.1, -0.2}));
  EXPECT_EQ(decision.limit.name, Name("slope"));
  EXPECT_EQ(decision.limit.why, "The ground falls away.");
}

TEST_F(CoordinatorTest, EachTurnDirectionHasItsOwnLimit) {
  Scripted* turning =
      add(behaviours::kAvoid,
          {.active = true, .twist = {0, -0.4}, .limits = {.omega_min = -0.1, .omega_max = 0.3}});
  EXPECT_EQ(coordinator.decide(resource, output).twist.omega, -0.1);
  turning->proposal.twist.omega = 0.4;
  EXPECT_EQ(coordinator.decide(resource, output).twist.omega, 0.3);
  turning->proposal.twist.omega = 0.2;
  const Decision free = coordinator.decide(resource, output);
  EXPECT_EQ(free.twist.omega, 0.2);
  EXPECT_FALSE(free.limit) << "nothing was limited";
}

TEST_F(CoordinatorTest, LimitsDoNotSetARestingRobotInMotion) {
  add(behaviours::kAvoid, {.active = false, .limits = {.v_max = -0.1}});
  EXPECT_EQ(coordinator.decide(resource, output).twist, Twist2{});
}

TEST_F(CoordinatorTest, ContradictoryLimitsStop) {
  add(behaviours::kManual, {.active = true, .twist = {0.5, 0}, .limits = {.v_min = 0.3}});
  add(behaviours::kAvoid, {.active = true, .twist = {}, .limits = {.v_max = 0.1}});
  EXPECT_EQ(coordinator.decide(resource, output).twist, Twist2{});
}

TEST_F(CoordinatorTest, NaNReachesTheGateInsteadOfBecomingALimit) {
  add(behaviours::kAvoid,
      {.active = true,
       .twist = {std::numeric_limits<double>::quiet_NaN(), 0},
       .limits = {.v_max = 0.1}});
  EXPECT_TRUE(std::isnan(coordinator.decide(resource, output).twist.v));
}

TEST_F(CoordinatorTest, ASlowBehaviourIsHeldBetweenItsSamples) {
  Scripted* slow = add(behaviours::kAvoid, {.active = true, .twist = {0.2, 0}}, 0.1);
  for (int tick = 0; tick < 8; ++tick) {
    EXPECT_DOUBLE_EQ(coordinator.decide(resource, output).twist.v, 0.2);
  }
  EXPECT_EQ(slow->samples, 2);  // 8 ticks of 25 ms = 0.2 s = two samples at 0.1 s
}

TEST(Actuate, KeepsWithinTheRobotsOwnLimits) {
  RobotSpec spec;
  spec.max_v = 0.5;
  spec.max_omega = 1.0;
  EXPECT_EQ(actuate({2.0, -3.0}, spec), (Command{{0.5, -1.0}}));
}

}  // namespace
}  // namespace algo
