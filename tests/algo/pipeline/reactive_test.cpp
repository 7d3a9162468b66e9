// tests/algo/pipeline/reactive_test.cpp: who wins, whose limits bind, and how long a proposal is
// held.
#include "algo/pipeline/reactive.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace algo {
namespace {

class Scripted final : public Behaviour {
 public:
  Scripted(BehaviourId id, Proposal proposal, double period = 0)
      : id_(id), proposal_(proposal), period_(period) {}
  BehaviourId id() const override { return id_; }
  double period() const override { return period_; }
  void reset(const Pose2& /*start_W*/) override { samples = 0; }
  Proposal propose(const Resource& /*resource*/, ControlOutput& /*output*/) override {
    ++samples;
    return proposal_;
  }
  int samples = 0;

 private:
  BehaviourId id_;
  Proposal proposal_;
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
  Scripted* add(BehaviourId id, Proposal proposal, double period = 0) {
    auto behaviour = std::make_unique<Scripted>(id, proposal, period);
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

TEST_F(CoordinatorTest, NobodyActiveMeansRest) {
  add(BehaviourId::Avoid, {.active = false, .twist = {1, 1}});
  const Decision decision = coordinator.decide(resource, output);
  EXPECT_EQ(decision.winner, BehaviourId::Rest);
  EXPECT_EQ(decision.twist, Twist2{});
}

TEST_F(CoordinatorTest, TheFirstActiveOneWinsAndAllLimitsBind) {
  add(BehaviourId::Manual, {.active = true, .twist = {0.5, 0.4}, .limits = {.v_max = 0.4}});
  add(BehaviourId::Avoid,
      {.active = true, .twist = {0.1, 0}, .limits = {.v_max = 0.2, .omega_max = 0.3}});
  const Decision decision = coordinator.decide(resource, output);
  EXPECT_EQ(decision.winner, BehaviourId::Manual);
  EXPECT_DOUBLE_EQ(decision.twist.v, 0.2);
  EXPECT_DOUBLE_EQ(decision.twist.omega, 0.3);
}

TEST_F(CoordinatorTest, ContradictoryLimitsStop) {
  add(BehaviourId::Manual, {.active = true, .twist = {0.5, 0}, .limits = {.v_min = 0.3}});
  add(BehaviourId::Avoid, {.active = true, .twist = {}, .limits = {.v_max = 0.1}});
  EXPECT_EQ(coordinator.decide(resource, output).twist, Twist2{});
}

TEST_F(CoordinatorTest, NaNReachesTheGateInsteadOfBecomingALimit) {
  add(BehaviourId::Avoid,
      {.active = true,
       .twist = {std::numeric_limits<double>::quiet_NaN(), 0},
       .limits = {.v_max = 0.1}});
  EXPECT_TRUE(std::isnan(coordinator.decide(resource, output).twist.v));
}

TEST_F(CoordinatorTest, ASlowBehaviourIsHeldBetweenItsSamples) {
  Scripted* slow = add(BehaviourId::Avoid, {.active = true, .twist = {0.2, 0}}, 0.1);
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
