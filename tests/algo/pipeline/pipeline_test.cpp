// tests/algo/pipeline/pipeline_test.cpp: the command of each tick and the reason of each hold.
#include "algo/pipeline/pipeline.hpp"

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/algo/allocations.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algo/gate.hpp"
#include "algo/strip/strip_law.hpp"

namespace algo {
namespace {

RobotSpec disc() {
  RobotSpec spec;
  spec.name = "disc";
  spec.radius = 0.35;
  spec.period = 0.025;
  spec.max_v = 0.5;
  spec.max_omega = 1.0;
  spec.max_acceleration = 0.5;
  spec.drives = true;
  return spec;
}

struct PipelineTest : ::testing::Test {
  PipelineTest() { pipeline.reset({}); }
  /// One tick with a scan of free beams, except for an optional `obstacle` straight ahead [m].
  const Telemetry& tick(double obstacle = 0,
                        bool with_scan = true,
                        bool dazzled = false,
                        std::size_t cone = 0) {
    t.observation.clear_sensors();
    t.observation.stamp = 0.025 * static_cast<double>(ticks++);
    t.observation.odometry.stamp = t.observation.stamp;
    t.observation.map_pose = on_map;
    if (with_scan) {
      LaserScan& scan = t.observation.scans.append();
      scan.stamp = t.observation.stamp;
      scan.angle_min = -std::numbers::pi / 2;
      scan.angle_increment = std::numbers::pi / 360;
      scan.range_max = 8.191;
      scan.resize(361);
      for (std::size_t i = 0; i < 361; ++i) scan.set_free(i);
      for (std::size_t i = 0; dazzled && i < 361; ++i) scan.set_invalid(i, algo::BeamCode::Dazzled);
      for (std::size_t i = 0; i < cone; ++i) {
        scan.set_invalid(180 - cone / 2 + i, algo::BeamCode::Dazzled);
      }
      for (std::size_t i = 170; obstacle > 0 && i <= 190; ++i) scan.set_ok(i, obstacle);
    }
    pipeline.tick(t);
    t.requests.clear();
    return t;
  }
  void ask(const Request& request) { t.requests.push_back(request); }

  Pipeline pipeline{{}, disc()};
  Telemetry t{};
  std::optional<MapPose> on_map{};
  int ticks = 0;
};

TEST_F(PipelineTest, RestsWithoutAGoalAndDrivesWithOne) {
  EXPECT_EQ(tick().command, Command{});
  EXPECT_EQ(t.behaviour, behaviours::kRest);
  ask(SetGoal{{3, 0}, std::nullopt});
  EXPECT_GT(tick().command.base.v, 0);
  EXPECT_EQ(t.behaviour, behaviours::kAvoid);
  EXPECT_EQ(t.mission, Mission::Driving);
}

TEST_F(PipelineTest, ALostRobotRefusesGoalsAndKeepsTheOneItHad) {
  ask(SetGoal{{3, 0}, std::nullopt});
  on_map = MapPose{.fix = MapFix::NotUnique};
  t.observation.odometry.pose = {3, 0, 0};  // so it seems
  EXPECT_EQ(tick().hold, holds::kNotLocated);
  EXPECT_EQ(t.command, Command{});
  EXPECT_EQ(t.mission, Mission::Held);
  EXPECT_THAT(t.words.why, testing::HasSubstr("Several places"));
  const char* refusal = "Where the robot is on the map is not known: give an initial pose.";
  EXPECT_EQ(pipeline.refusal(SetGoal{{1, 0}, std::nullopt}), refusal);
  EXPECT_EQ(pipeline.refusal(AddGoal{{{1, 0}, std::nullopt}}), refusal);
  EXPECT_EQ(pipeline.refusal(SetGoals{{{{1, 0}, std::nullopt}}}), refusal);
  EXPECT_FALSE(pipeline.refusal(ClearGoal{}));
  EXPECT_FALSE(pipeline.refusal(SetInitialPose{Pose2{1, 2, 3}}));
  on_map = MapPose{.fix = MapFix::Located, .epoch = 1};
  t.observation.odometry.pose = {-2, 0, 0};
  EXPECT_GT(tick().command.base.v, 0);
  EXPECT_EQ(t.mission, Mission::Driving);
  EXPECT_FALSE(pipeline.refusal(SetGoal{{1, 0}, std::nullopt}));
}

/// A controller that counts how often it was told to forget, and that its map moved.
class Listening final : public Controller {
 public:
  Listening(int& resets, int& moves) : resets_(resets), moves_(moves) {}
  void reset(const Pose2& /*start_W*/) override { ++resets_; }
  void move(const MapMove& /*move*/, const Pose2& here_W) override {
    EXPECT_EQ(here_W, Pose2({1, 2, 0}));
    ++moves_;
  }
  void update(const ControlInput& /*in*/, const Parameters& /*p*/, ControlOutput& out) override {
    out.clear();
  }
  void explain(const Telemetry& /*t*/, Explanation& /*words*/) const override {}

 private:
  int& resets_;
  int& moves_;
};

TEST_F(PipelineTest, TellsTheControllerOnceThatTheMapHasMoved) {
  int resets = 0;
  int moves = 0;
  std::vector<ControllerInfo> entries = builtin_controllers().entries();
  for (ControllerInfo& entry : entries) {
    entry.make = [&] { return std::make_unique<Listening>(resets, moves); };
  }
  Pipeline listening({}, disc(), ControllerCatalogue(std::move(entries)));
  listening.reset({});
  resets = 0;
  listening.tick(t);
  t.observation.odometry.pose = {1, 2, 0};
  t.observation.map_move = std::make_shared<const MapMove>();
  listening.tick(t);
  t.observation.clear_sensors();
  listening.tick(t);
  EXPECT_EQ(moves, 1);
  EXPECT_EQ(resets, 0);
}

TEST_F(PipelineTest, APoseThatIsNoNumberIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(pipeline.refusal(SetInitialPose{Pose2{nan, 0, 0}}));
  EXPECT_FALSE(pipeline.refusal(SetInitialPose{}));
}

TEST_F(PipelineTest, AStaleScanHoldsAndAFreshOneLetsGo) {
  ask(SetGoal{{3, 0}, std::nullopt});
  tick();
  for (int i = 0; i < 8; ++i) EXPECT_EQ(tick(0, false).hold, Hold{}) << i;  // 8 x 25 ms = 0.2 s
  EXPECT_EQ(tick(0, false).hold, holds::kStaleScan);
  EXPECT_EQ(t.command, Command{});
  EXPECT_EQ(t.mission, Mission::Held);
  EXPECT_EQ(tick().hold, Hold{});
  EXPECT_GT(t.command.base.v, 0);
}

TEST_F(PipelineTest, ABlindedScanIsTreatedAsMissing) {
  ask(SetGoal{{3, 0}, std::nullopt});
  tick();
  for (int i = 0; i < 8; ++i) tick(0, true, true);
  EXPECT_EQ(tick(0, true, true).hold, holds::kDazzled);
  EXPECT_EQ(t.command, Command{});
  EXPECT_NE(t.words.why.find("blinded"), std::string::npos);
  EXPECT_EQ(tick().hold, Hold{});
}

TEST_F(PipelineTest, ADazzledConeAheadHoldsAtOnceAndUntilItIsGone) {
  ask(SetGoal{{3, 0}, std::nullopt});
  EXPECT_EQ(tick().hold, Hold{});
  EXPECT_EQ(tick(0, true, false, 20).hold, holds::kDazzled);
  EXPECT_EQ(t.command, Command{});
  EXPECT_EQ(t.mission, Mission::Held);
  EXPECT_NE(t.words.why.find("dazzled"), std::string::npos);
  EXPECT_EQ(tick(0, false).hold, holds::kDazzled);  // no newer scan
  EXPECT_EQ(tick(0, true, false, 2).hold, Hold{});
}

TEST(PipelineGrid, IsSentTwiceASecondAndOnlyIfNew) {
  Pipeline pipeline({.controller = "vff"}, disc());
  pipeline.want_grids(true);
  pipeline.reset({});
  Telemetry t;
  t.requests.push_back(SetGoal{{3, 0}, std::nullopt});
  int brought = 0;
  const auto run = [&](int from, int to, bool changing) {
    for (int tick = from; tick < to; ++tick) {
      t.observation.clear_sensors();
      t.observation.stamp = 0.025 * tick;
      LaserScan& scan = t.observation.scans.append();
      scan.stamp = t.observation.stamp;
      scan.angle_min = -0.1;
      scan.angle_increment = 0.1;
      scan.range_max = 8;
      scan.resize(3);
      for (std::size_t i = 0; i < 3; ++i) {
        scan.set_free(i);
        if (changing) scan.set_ok(i, 1.0 + 0.005 * tick);
      }
      pipeline.tick(t);
      t.requests.clear();
      for (const algo::Layer& layer : t.output.layers) brought += layer.cells.empty() ? 0 : 1;
    }
  };
  run(0, 200, true);  // 5 s
  EXPECT_NEAR(brought, 10, 1);
  brought = 0;
  run(200, 800, false);  // 15 s, nothing new but the last returns
  EXPECT_GE(brought, 3);
  EXPECT_LE(brought, 4);
  brought = 0;
  pipeline.want_grids(false);
  run(800, 1000, true);
  EXPECT_EQ(brought, 0);
}

/// A tick each 25 ms of a robot that stands in the open.
struct Spoken {
  Pipeline pipeline{{}, disc()};
  Telemetry t{};
  int ticks = 0;
  int fresh = 0;

  Spoken() { pipeline.reset({}); }
  void tick() {
    t.observation.clear_sensors();
    t.observation.stamp = 0.025 * ticks++;
    LaserScan& scan = t.observation.scans.append();
    scan.stamp = t.observation.stamp;
    scan.angle_min = -0.1;
    scan.angle_increment = 0.1;
    scan.range_max = 8;
    scan.resize(3);
    for (std::size_t i = 0; i < 3; ++i) scan.set_free(i);
    pipeline.tick(t);
    t.requests.clear();
    fresh += t.words_fresh ? 1 : 0;
  }
};

TEST(PipelineWords, AreSentTwiceASecondAndHoldInBetween) {
  Spoken robot;
  for (int k = 0; k < 200; ++k) {  // 5 s
    robot.tick();
    EXPECT_EQ(robot.t.words.what, "Waiting for a goal");
  }
  EXPECT_NEAR(robot.fresh, 10, 1);
}

TEST(PipelineWords, TheLegendIsSentEveryTwoSecondsAndAtOnceAfterAChange) {
  Spoken robot;
  std::uint32_t legend = 0;
  int fresh = 0;
  int changed = 0;
  for (int k = 0; k < 200; ++k) {  // 5 s
    if (k == 100) robot.t.requests.push_back(SetGoal{{3, 0}, std::nullopt});
    robot.tick();
    const bool other = k == 0 || robot.t.legend != legend;
    EXPECT_TRUE(robot.t.legend_fresh || !other) << k;
    changed += other ? 1 : 0;
    fresh += robot.t.legend_fresh ? 1 : 0;
    legend = robot.t.legend;
  }
  EXPECT_LE(fresh, 2 + changed + 1) << changed;
  EXPECT_GE(fresh, 3);
}

TEST(PipelineWords, AreSentAtOnceWhenTheStateChanges) {
  Spoken robot;
  for (int k = 0; k < 5; ++k) robot.tick();
  EXPECT_EQ(robot.fresh, 1);
  robot.t.requests.push_back(SetGoal{{3, 0}, std::nullopt});
  robot.tick();
  EXPECT_TRUE(robot.t.words_fresh);
  EXPECT_EQ(robot.t.words.what, "Driving to the goal");
  robot.tick();
  EXPECT_FALSE(robot.t.words_fresh);
  robot.t.requests.push_back(algo::Stop{true});
  robot.tick();
  EXPECT_TRUE(robot.t.words_fresh);
  EXPECT_EQ(robot.t.words.what, "Stopped");
}

/// One tick of a robot with a sonar ring and no scanner; the front sonar pings every fourth tick.
struct SonarPipeline {
  explicit SonarPipeline(const char* controller)
      : pipeline({.controller = controller}, without_laser()) {
    pipeline.reset({});
    t.requests.push_back(SetGoal{{3, 0}, std::nullopt});
  }
  static RobotSpec without_laser() {
    RobotSpec spec = disc();
    spec.has_laser = false;
    return spec;
  }
  const Telemetry& tick(bool ping) {
    t.observation.clear_sensors();
    t.observation.stamp = 0.025 * static_cast<double>(ticks++);
    if (ping) {
      t.observation.sonar.push_back({{0.35, 0, 0}, t.observation.stamp, 1.65, 5.0, Beam::Ok});
    }
    pipeline.tick(t);
    t.requests.clear();
    return t;
  }

  Pipeline pipeline;
  Telemetry t{};
  int ticks = 0;
};

TEST(PipelineBySonar, ItsStampsAreCheckedForStaleness) {
  for (const char* controller : {"vff", "vfh", "certainty_grid", "potential_field"}) {
    SonarPipeline robot(controller);
    EXPECT_EQ(robot.tick(false).hold, holds::kStaleScan) << "nothing has come yet";
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(robot.tick(i % 4 == 0).hold, Hold{}) << controller << ' ' << i;
    }
    EXPECT_GT(robot.t.command.base.v, 0) << controller;
    EXPECT_NEAR(robot.t.clearance, 1.65, 1e-12) << controller;
    for (int i = 0; i < 5; ++i) EXPECT_EQ(robot.tick(false).hold, Hold{}) << i;
    EXPECT_EQ(robot.tick(false).hold, holds::kStaleScan) << controller;
    EXPECT_EQ(robot.t.command, Command{});
    EXPECT_EQ(robot.tick(true).hold, Hold{}) << controller;
  }
}

TEST(PipelineBySonar, AControllerThatNeedsALaserIsHeld) {
  for (const char* controller : {"modified", "dwa", "edge_detection"}) {
    SonarPipeline robot(controller);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(robot.tick(true).hold, holds::kStaleScan) << controller;
  }
}

/// A robot whose scanner has not reported yet must not drive by sonar.
TEST(PipelineBySonar, ARobotWithALaserWaitsForIt) {
  Pipeline pipeline({.controller = "vff"}, disc());
  Telemetry t;
  t.requests.push_back(SetGoal{{3, 0}, std::nullopt});
  t.observation.sonar.push_back({{0.35, 0, 0}, 0, 1.65, 5.0, Beam::Ok});
  pipeline.tick(t);
  EXPECT_EQ(t.hold, holds::kStaleScan);
}

TEST_F(PipelineTest, StopIsLatchedAndSurvivesANewGoal) {
  ask(SetGoal{{3, 0}, std::nullopt});
  ask(Stop{true});
  EXPECT_EQ(tick().command, Command{});
  ask(SetGoal{{4, 0}, std::nullopt});
  EXPECT_EQ(tick().hold, holds::kStopped);
  ask(Stop{false});
  EXPECT_GT(tick().command.base.v, 0);
}

TEST_F(PipelineTest, ASilentDriverLeavesARobotThatStandsStill) {
  ask(SetGoal{{3, 0}, std::nullopt});
  tick();
  ask(Joystick{0.5, 0});
  EXPECT_EQ(tick().behaviour, behaviours::kManual);
  EXPECT_DOUBLE_EQ(t.command.base.v, 0.25);
  EXPECT_FALSE(t.goal);
  int live = 1;
  while (tick().behaviour == behaviours::kManual) ++live;
  EXPECT_EQ(live, 20);  // 0.5 s of 25 ms
  EXPECT_EQ(t.command, Command{});
  for (int i = 0; i < 100; ++i) ASSERT_EQ(tick().command, Command{});
}

TEST_F(PipelineTest, ACentredStickDoesNotCancelTheGoal) {
  ask(SetGoal{{3, 0}, std::nullopt});
  ask(Joystick{0, 0});
  tick();
  EXPECT_TRUE(t.goal);
}

TEST_F(PipelineTest, ClearanceCountsEveryBeam) {
  EXPECT_NEAR(tick(2.0).clearance, 1.65, 1e-12);
  EXPECT_NEAR(tick().clearance, 8.191 - 0.35, 1e-12);
}

TEST_F(PipelineTest, NotANumberNeverReachesTheMotors) {
  ask(SetGoal{{3, 0}, std::nullopt});
  tick();
  t.observation.odometry.pose.x = std::numeric_limits<double>::quiet_NaN();
  pipeline.tick(t);
  EXPECT_EQ(t.hold, holds::kNotFinite);
  EXPECT_EQ(t.command, Command{});
}

TEST_F(PipelineTest, RefusesUnsupportedRequestsWithASentence) {
  EXPECT_FALSE(pipeline.refusal(SetParameter{&algo::kRepulsionGain, 0.5}));
  EXPECT_TRUE(pipeline.refusal(SetParameter{&algo::kRepulsionGain, 50}));
  EXPECT_TRUE(pipeline.refusal(SetParameter{&algo::kStripStep, 0.6}));  // S >= K_r d_safe
  EXPECT_TRUE(pipeline.refusal(Joystick{1.5, 0}));
  EXPECT_TRUE(pipeline.refusal(SetGoal{{std::numeric_limits<double>::infinity(), 0}, {}}));
  RobotSpec log = disc();
  log.drives = false;
  EXPECT_TRUE((Pipeline{{}, log}.refusal(SetGoal{{1, 0}, {}})));
}

/// With K_c = 1 a kept via point never settles.
TEST_F(PipelineTest, RefusesFullContractionOfAViaThatIsKept) {
  const SetParameter full{&algo::kContractionGain, 1.0};
  EXPECT_FALSE(pipeline.refusal(full));
  const Pipeline kept({.controller = "via_kept"}, disc());
  const auto reason = kept.refusal(full);
  ASSERT_TRUE(reason);
  EXPECT_NE(reason->find("k_c must be below 1"), std::string::npos) << *reason;
  EXPECT_FALSE(kept.refusal(SetParameter{&algo::kContractionGain, 0.95}));
}

TEST_F(PipelineTest, ASteadyTickAllocatesNothing) {
  ask(SetGoal{{100, 0}, std::nullopt});
  for (int i = 0; i < 50; ++i) tick(2.0);
  const auto before = allocations::count();
  for (int i = 0; i < 500; ++i) tick(i % 2 == 0 ? 2.0 : 1.2);
  EXPECT_EQ(allocations::count(), before);
}

}  // namespace
}  // namespace algo
