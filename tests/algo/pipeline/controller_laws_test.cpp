// tests/algo/pipeline/controller_laws_test.cpp: laws that every controller of the table obeys.
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/algo/allocations.hpp"
#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

#include "algo/driving.hpp"
#include "algo/filter/filter.hpp"
#include "algo/perceive.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/pipeline/parameter_table.hpp"

namespace {

using algo::ControlInput;
using algo::ControlOutput;
using algo::Parameters;
using algo::Scene;
using algo::Side;
using algo::Twist2;
using algo::Vec2;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

/// A robot before a post on its way, everything sound.
struct Situation {
  Scene scene{};
  algo::Observation observation{};
  algo::RobotSpec spec{.radius = 0.35,
                       .half_track = 0.25,
                       .period = 0.026,
                       .max_v = 0.5,
                       .max_omega = 1.0,
                       .max_acceleration = 0.5,
                       .max_angular_acceleration = 4,
                       .drives = true};
  ControlInput in{};
  Parameters parameters{};

  explicit Situation(const algo::Pose2& pose = {0.2, 0.1, 0.1}) {
    const worlds::World world{{{{1.6, 0.1}, 0.3}, {{1.2, 1.9}, 0.2}}, {}};
    worlds::scan_world(pose, world, 8.0, scene.scan);
    algo::perceive(pose, scene);
    in.stamp = 3;
    in.dt = 0.026;
    in.odometry.stamp = 3;
    in.odometry.pose = pose;
    in.scene = &scene;
    in.goal = algo::SetGoal{{4, 0}, 0.5};
    in.observation = &observation;
    in.spec = &spec;
  }
  Situation(const Situation&) = delete;
  Situation& operator=(const Situation&) = delete;
};

bool same(const ControlOutput& a, const ControlOutput& b) {
  bool strip = a.strip.size() == b.strip.size();
  for (std::size_t i = 0; strip && i < a.strip.size(); ++i) strip = a.strip[i] == b.strip[i];
  bool plan = a.plan_W.size() == b.plan_W.size();
  for (std::size_t i = 0; plan && i < a.plan_W.size(); ++i) plan = a.plan_W[i] == b.plan_W[i];
  bool candidates = a.candidates.size() == b.candidates.size();
  for (std::size_t i = 0; candidates && i < a.candidates.size(); ++i) {
    candidates = a.candidates[i] == b.candidates[i];
  }
  return strip && plan && candidates && a.histogram == b.histogram &&
         a.grid.cells == b.grid.cells && a.manner == b.manner && a.twist == b.twist &&
         a.internal_W == b.internal_W && a.external_left_W == b.external_left_W &&
         a.external_right_W == b.external_right_W && a.elastic_W == b.elastic_W &&
         a.pass_W == b.pass_W && a.side == b.side && a.side_since == b.side_since &&
         a.side_alpha == b.side_alpha && a.blocked_beam == b.blocked_beam;
}

class EveryController : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<algo::Controller> make() const {
    auto made = algo::builtin_controllers().at(GetParam()).make();
    made->reset({});
    return made;
  }
};

/// Those that stand still to take a scan move within a second of it.
TEST_P(EveryController, MovesWhenAllIsSound) {
  Situation s;
  const auto controller = make();
  ControlOutput out;
  for (int tick = 0; tick < 40 && out.twist == Twist2{}; ++tick) {
    s.in.stamp = 3 + 0.026 * tick;
    controller->update(s.in, s.parameters, out);
  }
  EXPECT_NE(out.twist, Twist2{});
  EXPECT_NE(out.pass_W, s.in.odometry.pose.position());
}

/// The law of the strips alone; the others have none. That of many nodes ends at the goal.
TEST_P(EveryController, AStripRunsFromTheRobotThroughThePassPoint) {
  const Situation s;
  ControlOutput out;
  make()->update(s.in, s.parameters, out);
  if (GetParam() == "strip" || GetParam() == "strip_moving") {
    ASSERT_GT(out.strip.size(), 10U);
    EXPECT_EQ(out.strip[0].position_W, s.in.odometry.pose.position());
    EXPECT_EQ(out.strip.back().position_W, s.in.goal->position_W);
    return;
  }
  if (out.manner != algo::Manner::None) {
    EXPECT_TRUE(out.strip.empty());
    return;
  }
  ASSERT_EQ(out.strip.size(), 3U);
  EXPECT_EQ(out.strip[0].position_W, s.in.odometry.pose.position());
  EXPECT_EQ(out.strip[1].position_W, out.pass_W);
  EXPECT_NEAR((out.strip[2].position_W - out.strip[0].position_W).norm(), 0.2, 1e-12);
  EXPECT_LT((out.strip[1].internal_W + out.strip[1].external_W - out.elastic_W).norm(), 1e-12);
}

TEST_P(EveryController, AnyNumberThatIsNotFiniteGivesZero) {
  using Spoil = std::function<void(Situation&, double)>;
  std::vector<Spoil> spoils = {
      [](Situation& s, double x) { s.in.stamp = x; },
      [](Situation& s, double x) { s.in.dt = x; },
      [](Situation& s, double x) { s.spec.radius = x; },
      [](Situation& s, double x) { s.in.odometry.stamp = x; },
      [](Situation& s, double x) { s.in.odometry.pose.x = x; },
      [](Situation& s, double x) { s.in.odometry.pose.y = x; },
      [](Situation& s, double x) { s.in.odometry.pose.heading = x; },
      [](Situation& s, double x) { s.in.odometry.twist.v = x; },
      [](Situation& s, double x) { s.in.odometry.twist.omega = x; },
      [](Situation& s, double x) { s.in.goal->position_W.x() = x; },
      [](Situation& s, double x) { s.in.goal->position_W.y() = x; },
      [](Situation& s, double x) { s.in.goal->heading = x; },
      [](Situation& s, double x) { s.scene.left->point_W.x() = x; },
      [](Situation& s, double x) { s.scene.left->distance = x; },
      [](Situation& s, double x) { s.scene.right->point_W.y() = x; },
      [](Situation& s, double x) { s.scene.right->distance = x; },
      [](Situation& s, double x) { s.scene.scan.ranges[s.scene.left->beam] = x; },
      [](Situation& s, double x) { s.scene.scan.range_max = x; },
      [](Situation& s, double x) { s.scene.scan.angle_min = x; },
      [](Situation& s, double x) { s.scene.scan.angle_increment = x; },
      [](Situation& s, double x) { s.scene.scan.mount_R.x = x; },
      [](Situation& s, double x) { s.scene.scan.mount_R.heading = x; },
  };
  for (const algo::ParameterInfo* p : algo::parameter_table()) {
    spoils.emplace_back([p](Situation& s, double x) { s.parameters.set(*p, x); });
  }
  for (std::size_t k = 0; k < spoils.size(); ++k) {
    for (const double bad : {kNan, kInf, -kInf}) {
      Situation s;
      const auto controller = make();
      ControlOutput out;
      controller->update(s.in, s.parameters, out);
      spoils[k](s, bad);
      controller->update(s.in, s.parameters, out);
      EXPECT_EQ(out.twist, Twist2{}) << "number " << k << " = " << bad;
      EXPECT_TRUE(out.strip.empty()) << "number " << k << " = " << bad;
      EXPECT_TRUE(out.pass_W.allFinite() && out.elastic_W.allFinite());
    }
  }
}

TEST_P(EveryController, ARangeOfABeamThatIsNotOkIsNotRead) {
  Situation s;
  s.scene.scan.set_invalid(5, algo::BeamCode::Dazzled);
  ControlOutput sound;
  make()->update(s.in, s.parameters, sound);
  s.scene.scan.ranges[5] = kNan;
  ControlOutput out;
  make()->update(s.in, s.parameters, out);
  EXPECT_TRUE(same(sound, out));
}

TEST_P(EveryController, NoGoalGivesZero) {
  Situation s;
  const auto controller = make();
  ControlOutput out;
  controller->update(s.in, s.parameters, out);
  s.in.goal.reset();
  controller->update(s.in, s.parameters, out);
  EXPECT_TRUE(same(out, ControlOutput{}));
}

TEST_P(EveryController, NearTheGoalItTurnsInPlaceAndThenRests) {
  Situation s;
  const auto controller = make();
  ControlOutput out;
  s.in.goal = algo::SetGoal{{0.25, 0.1}, std::nullopt};  // 50 mm away
  controller->update(s.in, s.parameters, out);
  EXPECT_EQ(out.twist, Twist2{});
  s.in.goal->heading = 0.5;  // 0.4 rad to the left of 0.1, gain 2: 0.8 rad/s
  controller->update(s.in, s.parameters, out);
  EXPECT_EQ(out.twist.v, 0);
  EXPECT_NEAR(out.twist.omega, 0.8, 1e-12);
  s.in.goal->heading = 0.1 - 3.0;  // to the right, limited to 1 rad/s
  controller->update(s.in, s.parameters, out);
  EXPECT_EQ(out.twist, (Twist2{0, -1.0}));
  s.in.goal->heading = 0.1 + 0.049;  // within 0.05
  controller->update(s.in, s.parameters, out);
  EXPECT_EQ(out.twist, Twist2{});
}

TEST_P(EveryController, OnAnObstaclePointItStops) {
  Situation s;
  s.scene.right->point_W = s.in.odometry.pose.position();
  s.scene.right->distance = 0;
  ControlOutput out;
  make()->update(s.in, s.parameters, out);
  EXPECT_EQ(out.twist, Twist2{});
  EXPECT_TRUE(out.pass_W.allFinite());
}

TEST_P(EveryController, SameInputsTwiceGiveTheSame) {
  const auto a = make();
  const auto b = make();
  ControlOutput out_a;
  ControlOutput out_b;
  for (int tick = 0; tick < 60; ++tick) {
    Situation s({0.01 * tick, 0.02 * std::sin(tick), 0.1});
    s.in.stamp = 0.1 * tick;
    a->update(s.in, s.parameters, out_a);
    b->update(s.in, s.parameters, out_b);
    ASSERT_TRUE(same(out_a, out_b)) << "tick " << tick;
  }
}

TEST_P(EveryController, ResetForgets) {
  Situation s({0.35, 0.1, 0});
  ControlOutput first;
  ControlOutput later;
  const auto controller = make();
  controller->update(s.in, s.parameters, first);
  for (int tick = 1; tick < 40; ++tick) {
    Situation on_the_way({0.35, 0.1 + 0.005 * tick, 0.02 * tick});
    on_the_way.in.stamp = 3 + 0.026 * tick;
    controller->update(on_the_way.in, on_the_way.parameters, later);
  }
  controller->reset({});
  controller->update(s.in, s.parameters, later);
  EXPECT_TRUE(same(first, later));
}

TEST_P(EveryController, StaysWithinItsSpeeds) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(-3, 3);
  const auto controller = make();
  ControlOutput out;
  for (int k = 0; k < 300; ++k) {
    Situation s({anywhere(random), anywhere(random), anywhere(random)});
    s.in.stamp = k;
    s.in.goal = algo::SetGoal{{anywhere(random), anywhere(random)}, anywhere(random)};
    s.parameters.set(algo::kMaxSpeed, 0.7);
    s.parameters.set(algo::kMaxTurnRate, 0.6);
    controller->update(s.in, s.parameters, out);
    ASSERT_GE(out.twist.v, 0);  // the strip never drives backwards, where nothing is seen
    ASSERT_LE(out.twist.v, 0.7);
    ASSERT_LE(std::abs(out.twist.omega), 0.6);
  }
}

TEST_P(EveryController, ParametersActAtOnce) {
  Situation s({-0.8, 0, 0});     // far enough for all of them to drive on
  s.spec.max_acceleration = 10;  // nor does any have to get up speed first
  const auto controller = make();
  ControlOutput slow;
  ControlOutput fast;
  s.parameters.set(algo::kMaxSpeed, 0.1);
  controller->update(s.in, s.parameters, slow);
  s.parameters.set(algo::kMaxSpeed, 0.2);
  controller->reset({});
  controller->update(s.in, s.parameters, fast);
  EXPECT_GT(slow.twist.v, 0);
  EXPECT_NEAR(fast.twist.v, 2 * slow.twist.v, 1e-12);
}

TEST_P(EveryController, AllocatesNothingWhenWarm) {
  Situation s({0.3, 0.1, 0.1});
  algo::LaserScan raw = s.scene.scan;
  algo::ScanFilter filter;
  const auto controller = make();
  ControlOutput out;
  std::size_t before = 0;
  for (int tick = 0; tick < 100; ++tick) {
    if (tick == 20) before = allocations::count();
    // Both forms of every filter, then the rest of the tick.
    if (tick % 2 == 0) {
      raw.set_invalid(100, algo::BeamCode::Dazzled);
    } else {
      raw.set_free(100);
    }
    for (const auto& info : algo::filter_table()) {
      filter.apply(info.kind, 1 + tick % 3, raw, s.scene.scan);
    }
    algo::perceive(s.in.odometry.pose, s.scene);
    s.in.stamp = 3 + 0.026 * tick;
    controller->update(s.in, s.parameters, out);
  }
  EXPECT_EQ(allocations::count(), before);
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& info : algo::builtin_controllers().entries()) all.emplace_back(info.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Laws,
                         EveryController,
                         ::testing::ValuesIn(names()),
                         [](const auto& about) { return about.param; });

TEST(ControllerTable, HoldsTheReadingsWithLabelAndHelp) {
  const std::set<std::string> wanted = {"original",
                                        "original_side",
                                        "modified_published",
                                        "modified_linear",
                                        "modified_c1",
                                        "modified",
                                        "via_kept",
                                        "strip",
                                        "strip_moving",
                                        "go_to_goal",
                                        "edge_detection",
                                        "potential_field",
                                        "certainty_grid",
                                        "vff",
                                        "vfh",
                                        "dwa"};
  const auto all = names();
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()), wanted);
  EXPECT_EQ(all.size(), wanted.size());
  for (const auto& info : algo::builtin_controllers().entries()) {
    EXPECT_FALSE(info.label.empty()) << info.name;
    EXPECT_FALSE(info.help.empty()) << info.name;
  }
}

TEST(ControllerTable, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  try {
    algo::builtin_controllers().at("modfied").make();
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("'modfied'"), std::string::npos) << what;
    EXPECT_NE(what.find("original_side"), std::string::npos) << what;
    EXPECT_NE(what.find("via_kept"), std::string::npos) << what;
  }
}

}  // namespace
