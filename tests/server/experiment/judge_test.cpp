// tests/server/experiment/judge_test.cpp: each judge on hand-made ticks, and the table of judges.
#include "server/experiment/judge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algo/driving.hpp"
#include "server/experiment/oracle.hpp"

namespace server::experiment {
namespace {

using algo::Outcome;

/// A judge that watches ticks made by the test.
class Watched {
 public:
  explicit Watched(const char* judge, Settings settings = {}) : settings_(std::move(settings)) {
    info_ = &find_judge(judge);
    spec.parameters.set(algo::kSafetyDistance, 1.0);
    spec.parameters.set(algo::kMaxSpeed, 1.0);
    spec.parameters.set(algo::kMaxTurnRate, 1.0);
    robot.radius = 0.35;
    robot.period = 0.1;
  }

  /// The next tick, one period after the last.
  void see(algo::Telemetry t) {
    if (!judge_) judge_ = info_->make({spec, robot, settings_});
    t.tick = ticks_;
    t.observation.stamp = robot.period * static_cast<double>(ticks_++);
    judge_->see(t);
  }
  /// The same, of a robot at `pose` with an obstacle `distance` from its centre.
  void at(const algo::Pose2& pose, double distance, bool collided = false) {
    algo::Telemetry t;
    t.ground_truth = algo::GroundTruth{pose, distance, distance - robot.radius, collided};
    see(std::move(t));
  }

  double operator[](std::string_view column) const {
    std::vector<double> row(info_->columns.size());
    judge_->write(row);
    const auto found = std::ranges::find(info_->columns, column, &Column::name);
    return row.at(static_cast<std::size_t>(found - info_->columns.begin()));
  }
  std::optional<Ending> ending() const { return judge_->ending(); }

  RunSpec spec{};
  algo::RobotSpec robot{};

 private:
  const JudgeInfo* info_ = nullptr;
  Settings settings_{};
  std::unique_ptr<Judge> judge_{};
  std::uint64_t ticks_ = 0;
};

TEST(Judges, HaveNamesAndColumnsOfTheirOwn) {
  std::set<std::string_view> columns;
  std::string_view last;
  for (const JudgeInfo& judge : judge_table()) {
    EXPECT_LT(last, judge.name);
    last = judge.name;
    EXPECT_NE(judge.help, "") << judge.name;
    ASSERT_FALSE(judge.columns.empty()) << judge.name;
    for (const Column& column : judge.columns) {
      EXPECT_TRUE(columns.insert(column.name).second) << column.name;
      EXPECT_EQ(find_column(column.name), &column);
    }
  }
  EXPECT_EQ(find_judge("standing").name, "standing");
  EXPECT_EQ(find_column("beauty"), nullptr);
  EXPECT_THROW(find_judge("beauty"), std::invalid_argument);
}

// ---- path --------------------------------------------------------------------------------------

TEST(PathJudge, BodyCircleIsMeasuredFromTheHull) {
  Watched path("path");
  path.at({0, 0, 0},
          1.30);  // the start is no tick gone by, but it is as deep as it is: 1.35 - 1.30
  path.at({0.1, 0, 0}, 1.20);
  path.at({0.2, 0, 0}, 1.10);
  path.at({0.3, 0, 0}, 1.40);
  EXPECT_NEAR(path["body_depth_m"], 0.25, 1e-12);     // 1.35 - 1.10
  EXPECT_NEAR(path["body_infringed_s"], 0.2, 1e-12);  // two ticks
}

TEST(PathJudge, BendingIsSquaredTurnOverTheLaterSegment) {
  // East 0.1 m, then north 0.2 m: (pi/2)^2 / 0.2; then 45 degrees on over 0.1 sqrt 2.
  Watched path("path");
  path.at({0, 0, 0}, 5), path.at({0.1, 0, 0}, 5), path.at({0.1, 0.2, 0}, 5);
  path.at({0, 0.3, 0}, 5);
  const double quarter = std::numbers::pi / 2;
  const double eighth = std::numbers::pi / 4;
  EXPECT_NEAR(path["bending_rad2_per_m"],
              quarter * quarter / 0.2 + eighth * eighth / (0.1 * std::numbers::sqrt2),
              1e-9);
}

TEST(PathJudge, StepsBelowFiftyMillimetresAreMerged) {
  // 30 mm and 30 mm east count as one segment of 60 mm; the step of 10 mm north is left out.
  Watched path("path");
  path.at({0, 0, 0}, 5), path.at({0.03, 0, 0}, 5), path.at({0.06, 0, 0}, 5);
  path.at({0.06, 0.01, 0}, 5), path.at({0.12, 0, 0}, 5);
  EXPECT_NEAR(path["bending_rad2_per_m"], 0, 1e-12);
}

TEST(PathJudge, ShareOfTheStripBeforeItsVia) {
  Watched path("path");
  const auto tick = [&](double via, double push) {
    algo::Telemetry t;
    t.ground_truth = algo::GroundTruth{{0, 0, 0}, 2, 1.65, false};
    t.output.measures.push_back({"strip.share", "", via / 0.2});
    t.output.measures.push_back({"strip.left", "m", push});
    path.see(std::move(t));
  };
  tick(0.1, 1), tick(0.15, 1), tick(0.05, 1);  // shares 0.5, 0.75, 0.25
  tick(0.0, 0);                                // nothing pushes: not counted
  EXPECT_NEAR(path["strip_share"], 0.5, 1e-12);
  EXPECT_NEAR(path["strip_share_deviation"], 0.25, 1e-12);
}

// ---- standing ----------------------------------------------------------------------------------

TEST(StandingJudge, APauseIsARestBeforeDrivingOn) {
  // At most 1 m/s and 1 rad/s, ticks of 0.05 s: at rest below 2.5 mm and 2.5 mrad a tick.
  Watched standing("standing");
  standing.robot.period = 0.05;
  algo::Pose2 pose{};
  const auto ticks = [&](int count, double v, double omega) {
    for (int i = 0; i < count; ++i) {
      pose = {pose.x + 0.05 * v, pose.y, pose.heading + 0.05 * omega};
      standing.at(pose, 2);
    }
  };
  ticks(1, 0, 0);                        // the start
  ticks(10, 0.01, 0);                    // 0.5 s of rest before the first motion: no pause
  ticks(5, 1, 0), ticks(4, 0.01, 0);     // 0.2 s of rest
  ticks(5, 0, 1), ticks(1, 0, 0);        // turning is no rest; 0.05 s is no pause
  ticks(5, 0.1, 0), ticks(20, 0, 0.01);  // creeping is no rest; the last rest has no end
  EXPECT_EQ(standing["pauses"], 1);
  EXPECT_NEAR(standing["pause_s"], 0.2, 1e-9);
  EXPECT_NEAR(standing["standing_s"], 0.5 + 0.2 + 0.05 + 1.0, 1e-9);
}

// ---- backing -----------------------------------------------------------------------------------

TEST(BackingJudge, MeasuresAlongTheHeadingAndCountsStretches) {
  Watched backing("backing");
  backing.at({0, 0, 0}, 5), backing.at({-0.04, 0, 0}, 5);  // 4 cm back: not yet a stretch
  backing.at({0.1, 0, 0}, 5);
  const double left = std::numbers::pi / 2;  // facing +y: back is -y
  backing.at({0.1, 0, left}, 5), backing.at({0.1, -0.03, left}, 5);
  backing.at({0.1, -0.06, left}, 5), backing.at({0.1, -0.09, left}, 5);
  EXPECT_NEAR(backing["backing_m"], 0.04 + 0.09, 1e-12);
  EXPECT_EQ(backing["backing_spells"], 1);
}

// ---- metrics and place -------------------------------------------------------------------------

TEST(MetricsJudge, MeasuresAgainstTheSafetyDistanceOfTheRun) {
  Watched metrics("metrics");
  metrics.at({0, 0, 0}, 2), metrics.at({0.1, 0, 0}, 0.9), metrics.at({0.2, 0, 0}, 0.8);
  EXPECT_NEAR(metrics["path_m"], 0.2, 1e-12);
  EXPECT_NEAR(metrics["time_s"], 0.2, 1e-12);
  EXPECT_NEAR(metrics["safety_depth_m"], 0.2, 1e-12);
  EXPECT_NEAR(metrics["safety_infringed_s"], 0.2, 1e-12);
  EXPECT_NEAR(metrics["min_clearance_m"], 0.45, 1e-12);
}

TEST(MotionJudge, MeasuresTheWayAgainstTheStraightLine) {
  // 3 m east and 4 m north, 5 m in a straight line; hull clearances 0.65 and twice 0.05.
  Watched motion("motion");
  motion.spec.scenario.goal = algo::SetGoal{.position_W = {3, 4}};
  motion.at({0, 0, 0}, 1.0), motion.at({3, 0, 0}, 0.4), motion.at({3, 4, 0}, 0.4);
  EXPECT_NEAR(motion["path_ratio"], 1.4, 1e-12);
  EXPECT_NEAR(motion["mean_clearance_m"], 0.25, 1e-12);
}

TEST(MotionJudge, JerkIsTheSecondDifferenceOfTheSpeed) {
  // Steps of 0, 0.01, 0.03, 0.01 m in 0.1 s: speeds 0, 0.1, 0.3, -0.1 m/s (the last backwards).
  // Second differences 0.1 and -0.6, over 0.01 s^2: 10 and -60 m/s^3; RMS sqrt((100 + 3600) / 2).
  Watched motion("motion");
  for (const double x : {0.0, 0.0, 0.01, 0.04, 0.03}) motion.at({x, 0, 0}, 5);
  EXPECT_NEAR(motion["jerk_rms_m_s3"], std::sqrt(1850), 1e-6);
  Watched still("motion");
  still.at({0, 0, 0}, 5);
  EXPECT_TRUE(std::isnan(still["jerk_rms_m_s3"]));
}

TEST(MotionJudge, EffortAndFlipsAreOfTheCommand) {
  Watched motion("motion");
  const auto command = [&](double v, double omega) {
    algo::Telemetry t;
    t.command.base = {v, omega};
    motion.see(t);
  };
  command(0, 0.2), command(0.2, 0.01), command(0.1, -0.3), command(0.1, -0.2), command(0.1, 0.4);
  EXPECT_NEAR(motion["effort_m2_s3"], (0.04 + 0.01) / 0.1, 1e-12);
  EXPECT_EQ(motion["turn_flips"], 2);  // 0.2 to -0.3, past a command too slow to be a turn; to 0.4
  const double squares = 0.19 * 0.19 + 0.31 * 0.31 + 0.1 * 0.1 + 0.6 * 0.6;
  EXPECT_NEAR(motion["turn_rms_rad_s2"], std::sqrt(squares / 4) / 0.1, 1e-12);
}

TEST(PlaceJudge, IsTheLastTruePoseOrUnknown) {
  Watched place("place");
  place.see({});
  EXPECT_TRUE(std::isnan(place["end_x_m"]));
  place.at({1, 2, 0.5}, 3);
  EXPECT_EQ(place["end_x_m"], 1);
  EXPECT_EQ(place["end_y_m"], 2);
  EXPECT_EQ(place["end_heading_rad"], 0.5);
}

// ---- barn_score --------------------------------------------------------------------------------

struct BarnScoreTest : ::testing::Test {
  BarnScoreTest() {
    barn.spec.scenario.goal = algo::SetGoal{{6, 0}, std::nullopt};
    barn.robot.period = 1;
  }
  Watched barn{"barn_score", {{"optimal_length", 2.0}}};  // at 2 m/s: 1 s
};

TEST_F(BarnScoreTest, ItsClockBeginsATenthOfAMetreFromTheStart) {
  barn.at({0, 0, 0}, 9), barn.at({0.05, 0, 0}, 9), barn.at({0.2, 0, 0}, 9);  // at 2 s
  barn.at({2, 0, 0}, 9), barn.at({4, 0, 0}, 9);
  EXPECT_FALSE(barn.ending());
  barn.at({5.1, 0, 0}, 9);  // at 5 s, within 1 m of the goal
  ASSERT_TRUE(barn.ending());
  EXPECT_EQ(barn.ending()->outcome, Outcome::Reached);
  EXPECT_EQ(barn["barn_time_s"], 3);
  EXPECT_DOUBLE_EQ(barn["barn_score"], 1.0 / 3);          // OT / AT, within 2 OT and 8 OT
  EXPECT_DOUBLE_EQ(barn["barn_score_quarter"], 1.0 / 4);  // AT counts as 4 OT at least
}

TEST_F(BarnScoreTest, AContactScoresNothing) {
  barn.at({0, 0, 0}, 9), barn.at({5.5, 0, 0}, 0, true);
  EXPECT_EQ(barn.ending()->outcome, Outcome::Collided);
  EXPECT_EQ(barn["barn_score"], 0);
}

TEST_F(BarnScoreTest, ARobotThatNeverMovesIsGivenAMinute) {
  for (int second = 0; second < 60; ++second) barn.at({0, 0, 0}, 9);
  EXPECT_FALSE(barn.ending());
  barn.at({0, 0, 0}, 9);
  EXPECT_EQ(barn.ending()->outcome, Outcome::OutOfTime);
  EXPECT_EQ(barn["barn_time_s"], 0);
}

// ---- contact -----------------------------------------------------------------------------------

TEST(ContactJudge, CountsOnlyMovingObstacles) {
  for (const bool moves : {true, false}) {
    Watched contact("contact");
    contact.robot = {.radius = 0.35,
                     .period = 0.05,
                     .max_v = 1,
                     .max_omega = 2,
                     .max_acceleration = 2,
                     .max_angular_acceleration = 4};
    algo::Obstacle cylinder{.id = 1, .shape = algo::Cylinder{.radius = 0.5}};
    cylinder.pose_W = {10, 0, 0};
    if (moves) cylinder.path = {.period = 20, .keys = {{0, {10, 0}}, {20, {-10, 0}}}};
    contact.spec.scenario.obstacles.push_back(cylinder);
    for (int k = 0; k <= 183; ++k) contact.at({0, 0, 1.57}, 5, k == 183);  // it arrives at 9.15 s
    EXPECT_EQ(contact["contact"], static_cast<double>(moves ? Contact::Avoidable : Contact::None));
  }
}

// ---- silence -----------------------------------------------------------------------------------

struct SilenceTest : ::testing::Test {
  SilenceTest() { silence.robot.period = 1; }
  /// A second at `x`.
  void tick(double x, bool waits, algo::Mission mission = algo::Mission::Driving) {
    algo::Telemetry t;
    t.ground_truth = algo::GroundTruth{{x, 0, 0}, 5, 4.65, collided};
    t.output.waits = waits;
    t.words.why = "Nothing is free just now.";
    t.output.twist.v = speed;
    t.mission = mission;
    silence.see(std::move(t));
  }
  Watched silence{"silence"};
  bool collided = false;
  double speed = 0;
};

TEST_F(SilenceTest, StandingWithoutAReasonIsSilent) {
  for (int second = 0; second <= 20; ++second) tick(0, false);
  EXPECT_FALSE(silence.ending());
  tick(0, false);
  ASSERT_TRUE(silence.ending());
  EXPECT_EQ(silence.ending()->outcome, Outcome::Stuck);
  EXPECT_EQ(silence["silent"], 1);
}

TEST_F(SilenceTest, AReasonGivenMeanwhileIsEnough) {
  for (int second = 0; second <= 21; ++second) {
    tick(0, second == 12);
  }
  ASSERT_TRUE(silence.ending());
  EXPECT_EQ(silence.ending()->outcome, Outcome::Stuck);
  EXPECT_NE(silence.ending()->reason, "");
  EXPECT_EQ(silence["silent"], 0);
}

TEST_F(SilenceTest, AMovingRobotNeedsNoReason) {
  for (int second = 0; second <= 300; ++second) tick(0.1 * second, false);
  EXPECT_FALSE(silence.ending());
  tick(31, false);
  EXPECT_EQ(silence.ending()->outcome, Outcome::OutOfTime);
  EXPECT_EQ(silence["silent"], 0);
}

TEST_F(SilenceTest, ATrialSetsItsTimes) {
  const auto begin = [&] {
    silence = Watched("silence", {{"stands_s", 60}, {"limit_s", 100}});
    silence.robot.period = 1;
  };
  begin();
  for (int second = 0; second <= 60; ++second) tick(0, true);
  EXPECT_FALSE(silence.ending());
  tick(0, true);
  EXPECT_EQ(silence.ending()->outcome, Outcome::Stuck);
  begin();
  for (int second = 0; second <= 101; ++second) tick(0.1 * second, true);
  EXPECT_EQ(silence.ending()->outcome, Outcome::OutOfTime);
}

TEST_F(SilenceTest, ArrivalContactAndNanEndIt) {
  tick(0, false, algo::Mission::Arrived);
  EXPECT_EQ(silence.ending()->outcome, Outcome::Reached);
  silence = Watched("silence");
  collided = true;
  tick(0, false);
  EXPECT_EQ(silence.ending()->outcome, Outcome::Collided);
  silence = Watched("silence");
  speed = std::nan("");
  tick(0, false);
  EXPECT_EQ(silence.ending()->outcome, Outcome::Failed);
  EXPECT_EQ(silence["not_finite"], 1);
}

}  // namespace
}  // namespace server::experiment
