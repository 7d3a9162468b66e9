// tests/server/record/arm_run_test.cpp: a robot brings its hand to a goal, and the stored run
// repeats its commands bit for bit, whenever its plans came.
#include <cmath>
#include <limits>
#include <memory>

#include "tests/server/record/recorder_fixture.hpp"
#include <gtest/gtest.h>

#include "algo/arm/mobile_arm.hpp"
#include "server/record/encoded_frame.hpp"
#include "server/record/frame_codec.hpp"
#include "server/record/headless.hpp"
#include "server/record/record_sink.hpp"
#include "server/record/run_csv.hpp"
#include "server/record/run_json.hpp"
#include "server/record/verify.hpp"
#include "server/run/planning_thread.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/scenario_library.hpp"

namespace server {
namespace {

using ArmRun = test::RecorderFiles;

RunSpec arm_spec(const char* scenario, const char* physics = "kinematic") {
  RunOverrides overrides;
  overrides.physics = physics_named(physics, "physics");
  return make_spec(ScenarioLibrary({}, {}).load(scenario), overrides);
}

/// What a run of the arm came to.
struct ArmOutcome {
  HeadlessResult result{};
  double hand_error = INFINITY;  // [m] at the end
  double aside = 0;              // [m] of the hand on its path, from a line along x
  double room = INFINITY;        // [m] least, of any part to anything, by the truth
  std::size_t rates = 0;         // ticks with a moving joint
  std::string words{};
};
ArmOutcome run_arm(const RunSpec& spec, std::shared_ptr<RunChannel> channel = nullptr) {
  const auto robot = make_robot(spec);
  const algo::MobileArm body = algo::mobile_arm(*robot->spec().arm, robot->spec().radius);
  ArmOutcome out;
  HeadlessOptions options{.hash_frames = true, .record = std::move(channel)};
  options.watch = [&](const algo::Telemetry& t) -> std::optional<Ending> {
    const auto q =
        algo::body_joints(t.ground_truth->pose, algo::joints_of(t.observation.joints->position));
    if (t.arm.hand_goal) {
      const algo::Vec3 off_W = body_frames(body, q).hand() - t.arm.hand_goal->position_W;
      out.hand_error = off_W.norm();
      const bool follows = t.words.why == "The robot follows its path with the hand.";
      if (follows) out.aside = std::max(out.aside, off_W.tail<2>().norm());
    }
    out.room = std::min(out.room, t.ground_truth->clearance);
    if (t.command.joint_rates != algo::Command{}.joint_rates) ++out.rates;
    out.words = t.words.why;
    return std::nullopt;
  };
  out.result = run_headless(spec, *robot, options, {});
  return out;
}

TEST(ArmFrame, AnArmComesBackFromItsFrameAndNoneCostsNothing) {
  algo::Telemetry t;
  t.observation.stamp = 2;
  const std::size_t bare = FrameEncoder().encode(t).size();
  t.observation.joints = algo::JointReading{1.9, {0.1, 1.0 / 3}, {0.2, -1.0 / 7}};
  t.ground_truth.emplace().touched = algo::BodyLink::Forearm;
  algo::SetHandGoal goal{.position_W = {1.0 / 3, 2, 3},
                         .attitude_W = {0.5, 0.5, 0.5, 0.5},
                         .path_W = {{1, 2, 1.0 / 3}, {4, 5, 6}},
                         .arm_angle = 0.7,
                         .base_stays = true,
                         .then = algo::SetGoal{{1, 2}, 0.3}};
  t.requests.push_back(goal);
  t.requests.push_back(algo::SetJoints{{0.1, 0.2}});
  t.requests.push_back(algo::Carry{{{4, 5}, {}}});
  t.requests.push_back(algo::TakePlan{});
  t.requests.push_back(algo::AddObstacle{{.id = 7, .shape = algo::Box{1, 2}, .bottom = 0.7}});
  t.arm.present = true;
  t.arm.state = algo::ArmState::Waits;
  t.arm.hand_goal = goal;
  t.arm.clearance = {1, 2, 3, 4, std::numeric_limits<double>::infinity()};
  t.arm.own_clearance = 0.25;
  t.arm.plan = 3;
  t.arm.plan_fresh = true;
  t.arm.ghost.push_back({1, 2, 3});
  t.command.joints = algo::kArmJoints;
  t.command.joint_rates = {0.1, -1.0 / 9};
  t.output.answered = true;
  t.output.joint_rates = algo::JointValues{0.3, -1.0 / 7};
  FrameEncoder encoder;
  algo::Telemetry again;
  decode_frame(encoder.encode(t), again);
  EXPECT_EQ(again.observation.joints, t.observation.joints);
  EXPECT_EQ(again.command, t.command);
  EXPECT_EQ(again.output.joint_rates, t.output.joint_rates);
  EXPECT_EQ(again.ground_truth->touched, algo::BodyLink::Forearm);
  ASSERT_EQ(again.requests.size(), t.requests.size());
  for (std::size_t k = 0; k < t.requests.size(); ++k)
    EXPECT_EQ(again.requests[k], t.requests[k]) << k;
  EXPECT_EQ(again.arm.state, t.arm.state);
  EXPECT_EQ(again.arm.hand_goal, t.arm.hand_goal);
  EXPECT_EQ(again.arm.clearance, t.arm.clearance);
  EXPECT_EQ(again.arm.plan, t.arm.plan);
  ASSERT_EQ(again.arm.ghost.size(), 1U);
  EXPECT_EQ(again.arm.ghost[0], t.arm.ghost[0]);

  t = {};
  t.observation.stamp = 2;
  EXPECT_EQ(FrameEncoder().encode(t).size(), bare);
  decode_frame(encoder.encode(t), again);
  EXPECT_FALSE(again.arm.present);
  EXPECT_FALSE(again.observation.joints);
}

TEST_F(ArmRun, TheHandReachesOverATable) {
  const ArmOutcome out = run_arm(arm_spec("arm_table"));
  EXPECT_EQ(out.result.run.outcome, algo::Outcome::Reached) << out.result.run.reason;
  EXPECT_LT(out.hand_error, 0.005);
  EXPECT_GT(out.room, 0.02);
  EXPECT_GT(out.rates, 50U);
  EXPECT_EQ(out.words, "The hand is at its goal.");
}

TEST_F(ArmRun, AStretchedArmIsCarriedPastAPostAndUnderABeam) {
  for (const char* scenario : {"arm_post", "arm_beam"}) {
    const ArmOutcome out = run_arm(arm_spec(scenario));
    EXPECT_EQ(out.result.run.outcome, algo::Outcome::Reached)
        << scenario << ": " << out.result.run.reason << ' ' << out.words;
    EXPECT_GT(out.room, 0.02) << scenario;
    EXPECT_GT(out.rates, 50U) << scenario;
  }
}

TEST_F(ArmRun, ARobotFetchesPastAPersonWhoWalks) {
  const ArmOutcome out = run_arm(arm_spec("arm_fetch"));
  EXPECT_EQ(out.result.run.outcome, algo::Outcome::Reached) << out.result.run.reason;
  EXPECT_GT(out.room, 0);
  EXPECT_EQ(out.words, "The robot is back from where its hand has been.");
}

TEST_F(ArmRun, TheHandFollowsItsPathAlongAWall) {
  for (const char* physics : {"kinematic", "bullet"}) {
    const ArmOutcome out = run_arm(arm_spec("arm_follow", physics));
    EXPECT_EQ(out.result.run.outcome, algo::Outcome::Reached)
        << physics << ": " << out.result.run.reason << ' ' << out.words;
    EXPECT_GT(out.room, 0.02) << physics;
    EXPECT_GT(out.aside, 0) << physics;
    EXPECT_LT(out.aside, 0.02) << physics;
    EXPECT_EQ(out.words, "The hand is at the end of its path.") << physics;
  }
}

TEST_F(ArmRun, APersonWhoWalksIntoTheRobotInBulletIsNotTouched) {
  RunSpec spec = arm_spec("arm_fetch", "bullet");
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    spec.seed = seed;
    const ArmOutcome out = run_arm(spec);
    EXPECT_EQ(out.result.run.outcome, algo::Outcome::Reached)
        << seed << ": " << out.result.run.reason;
  }
}

TEST_F(ArmRun, AGoalOutOfReachIsGivenUpInWords) {
  RunSpec spec = arm_spec("arm_table");
  spec.scenario.hand_goal->position_W.z() = 3;
  const ArmOutcome out = run_arm(spec);
  EXPECT_EQ(out.result.run.outcome, algo::Outcome::Stuck);
  EXPECT_NE(out.result.run.reason.find("m from the shoulder"), std::string::npos)
      << out.result.run.reason;
}

TEST_F(ArmRun, InBulletTheStoredRunVerifiesAndTheSameRunComesAgain) {
  const RunSpec spec = arm_spec("arm_shelf", "bullet");
  db::RunId run = 0;
  ArmOutcome first;
  {
    Recorder recorder(path, {.retention_bytes = 0});
    const auto channel = recorder.begin(headless_run(spec, make_robot(spec)->spec(), 0));
    run = channel->run();
    first = run_arm(spec, channel);
    recorder.flush();
  }
  EXPECT_EQ(first.result.run.outcome, algo::Outcome::Reached) << first.result.run.reason;
  EXPECT_LT(first.hand_error, 0.01);
  EXPECT_GT(first.room, 0);
  db::RunReader reader(path);
  const Verification verified = verify_run(reader, run);
  EXPECT_EQ(verified.difference.value_or(""), "");
  EXPECT_EQ(verified.incomplete.value_or(""), "");
  EXPECT_EQ(run_arm(spec).result.telemetry_hash, first.result.telemetry_hash);

  const RunCsv csv(reader, *reader.get(run));
  EXPECT_NE(csv.header().find("joint[6]"), std::string::npos);
  EXPECT_NE(csv.header().find("clearance.forearm"), std::string::npos);
}

TEST_F(ArmRun, ALiveRobotsPlansComeFromAThreadAndTheStoredRunVerifies) {
  const RunSpec spec = arm_spec("arm_table");
  const auto robot = make_robot(spec);
  algo::PipelineConfig config = pipeline_config(spec);
  config.thinker = [] { return std::make_unique<PlanningThread>(); };
  algo::Pipeline pipeline(config, robot->spec());
  db::RunId run = 0;
  std::size_t plans = 0;
  {
    Recorder recorder(path, {.retention_bytes = 0});
    const auto channel = recorder.begin(headless_run(spec, robot->spec(), 0));
    run = channel->run();
    RecordSink sink(channel);
    const std::shared_ptr<FramePool> pool = FramePool::make<EncodedFrame>(64);
    RunLinks links;
    links.pool = pool.get();
    links.record = &sink;
    links.listeners.push_back([&](const Frame& frame) {
      for (const algo::Request& request : frame.telemetry.requests) {
        if (std::holds_alternative<algo::TakePlan>(request)) ++plans;
      }
    });
    const RunResult result = server::run(*robot,
                                         pipeline,
                                         first_requests(spec),
                                         {.until_outcome = true, .time_limit = 1e4},
                                         links,
                                         {});
    EXPECT_EQ(result.outcome, algo::Outcome::Reached) << result.reason;
    channel->close(run_end(result, false, {}), result.metrics.ticks);
    recorder.flush();
  }
  EXPECT_GE(plans, 2U);  // the whole way, and the last leg
  db::RunReader reader(path);
  const Verification verified = verify_run(reader, run);
  EXPECT_EQ(verified.difference.value_or(""), "");
  EXPECT_EQ(verified.incomplete.value_or(""), "");
}

}  // namespace
}  // namespace server
