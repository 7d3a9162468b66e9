// tests/algo/pipeline/controller_laws_test.cpp: laws that every controller of the table obeys.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/algo/allocations.hpp"
#include "tests/algo/not_finite.hpp"
#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

#include "algo/driving.hpp"
#include "algo/explain.hpp"
#include "algo/filter/filter.hpp"
#include "algo/perceive.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/pipeline/parameter_table.hpp"

namespace {

using algo::ControlInput;
using algo::ControlOutput;
using algo::Parameters;
using algo::Scene;
using algo::Twist2;
using algo::Vec2;

using tests::kInf;
using tests::kNan;

/// A robot in front of a post on its way, with valid inputs.
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

bool same(const algo::Layer& a, const algo::Layer& b) {
  return a.name == b.name && a.level == b.level && a.values == b.values && a.cells == b.cells &&
         a.text == b.text;
}

bool same(const algo::Measure& a, const algo::Measure& b) {
  return a.name == b.name && a.unit == b.unit && a.value == b.value;
}

bool same(const ControlOutput& a, const ControlOutput& b) {
  const auto alike = [](const auto& x, const auto& y) { return same(x, y); };
  return a.twist == b.twist && a.pass_W == b.pass_W && a.waits == b.waits && a.state == b.state &&
         std::ranges::equal(a.measures, b.measures, alike) &&
         std::ranges::equal(a.layers, b.layers, alike);
}

const algo::Layer* layer_of(const ControlOutput& out, std::string_view name) {
  const auto found = std::ranges::find(out.layers, name, &algo::Layer::name);
  return found == out.layers.end() ? nullptr : found;
}

/// Point `k` of a layer.
Vec2 point(const algo::Layer& layer, std::size_t k) {
  return {layer.values[2 * k], layer.values[2 * k + 1]};
}

/// Whether a layer has as many values as its kind needs, all finite.
void expect_well_formed(const algo::Layer& layer) {
  SCOPED_TRACE(layer.name);
  EXPECT_FALSE(layer.name.empty());
  EXPECT_FALSE(layer.label.empty());
  const std::size_t n = layer.values.size();
  const std::size_t axes = layer.axes;
  EXPECT_TRUE(axes == 2 || axes == 3);
  switch (layer.kind) {
    case algo::LayerKind::Points:
    case algo::LayerKind::Polyline:
    case algo::LayerKind::Text:
      EXPECT_EQ(n % axes, 0U);
      break;
    case algo::LayerKind::Arrows:
      EXPECT_EQ(n % (2 * axes), 0U);
      break;
    case algo::LayerKind::Circles:
      EXPECT_EQ(n % (axes + 1), 0U);
      break;
    case algo::LayerKind::Arcs:
      EXPECT_EQ(n % 2, 0U);
      EXPECT_EQ(layer.frame, algo::LayerFrame::Robot);
      break;
    case algo::LayerKind::Grid:
      ASSERT_TRUE(n == 0 || n == 4);
      if (n == 4) {
        EXPECT_EQ(layer.cells.size() % static_cast<std::size_t>(layer.values[3]), 0U);
      }
      break;
    case algo::LayerKind::Polar:
      EXPECT_GT(layer.level, 0);
      break;
  }
  EXPECT_EQ(layer.cells.empty(), layer.kind != algo::LayerKind::Grid || n == 0);
  for (const float value : layer.values) EXPECT_TRUE(std::isfinite(value));
}

class EveryController : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<algo::Controller> make() const {
    auto made = algo::builtin_controllers().at(GetParam()).make();
    made->reset({});
    return made;
  }
};

/// Controllers that stand still for a scan move within a second after it.
TEST_P(EveryController, MovesWhenAllIsSound) {
  Situation s;
  const auto controller = make();
  ControlOutput out;
  for (int tick = 0; tick < 40 && out.twist == Twist2{}; ++tick) {
    s.in.stamp = 3 + 0.026 * tick;
    controller->update(s.in, s.parameters, out);
  }
  EXPECT_NE(out.twist, Twist2{});
  ASSERT_TRUE(out.pass_W);
  EXPECT_NE(*out.pass_W, s.in.odometry.pose.position());
}

TEST_P(EveryController, ShowsWellFormedLayersAndMeasuresWithUniqueNames) {
  Situation s;
  s.in.grids = true;
  const auto controller = make();
  ControlOutput out;
  std::vector<std::string_view> first;
  for (int tick = 0; tick < 30; ++tick) {
    s.in.stamp = 3 + 0.026 * tick;
    controller->update(s.in, s.parameters, out);
    std::vector<std::string_view> layers;
    for (const algo::Layer& layer : out.layers) {
      expect_well_formed(layer);
      layers.push_back(layer.name);
    }
    EXPECT_EQ(std::set(layers.begin(), layers.end()).size(), layers.size());
    if (tick == 0) first = layers;
    EXPECT_EQ(layers, first);  // so that each reuses its own buffers
    std::set<std::string_view> measures;
    for (const algo::Measure& each : out.measures) {
      EXPECT_TRUE(measures.insert(each.name).second) << each.name;
      EXPECT_TRUE(std::isfinite(each.value)) << each.name;
    }
  }
}

TEST_P(EveryController, AnUnrequestedGridIsNotMadeAndChangesNoCommand) {
  Situation s;
  const auto with = make();
  const auto without = make();
  ControlOutput seen;
  ControlOutput unseen;
  for (int tick = 0; tick < 30; ++tick) {
    s.in.stamp = 3 + 0.026 * tick;
    s.in.grids = true;
    with->update(s.in, s.parameters, seen);
    s.in.grids = false;
    without->update(s.in, s.parameters, unseen);
    ASSERT_EQ(seen.twist, unseen.twist) << "tick " << tick;
    for (const algo::Layer& layer : unseen.layers) EXPECT_TRUE(layer.cells.empty());
  }
}

TEST_P(EveryController, HasSentencesForItsStates) {
  Situation s;
  const auto controller = make();
  algo::Telemetry t;
  t.goal = s.in.goal;
  t.mission = algo::Mission::Driving;
  t.behaviour = algo::behaviours::kAvoid;
  for (const algo::Mission mission : {algo::Mission::Driving, algo::Mission::Stuck}) {
    t.mission = mission;
    for (int tick = 0; tick < 30; ++tick) {
      s.in.stamp = 3 + 0.026 * tick;
      t.observation.stamp = s.in.stamp;
      t.observation.odometry = s.in.odometry;
      t.scene = s.scene;
      controller->update(s.in, s.parameters, t.output);
      algo::explain(t, *controller, t.words);
      EXPECT_FALSE(t.words.what.empty());
      EXPECT_GT(t.words.why.size(), 10U);
    }
  }
  EXPECT_EQ(t.words.what, "Stuck");
  EXPECT_NE(t.words.why.find("Move an obstacle or the goal."), std::string::npos);
}

/// Only strip controllers have a strip. The one with many nodes ends at the goal, the one with
/// three nodes where the forces begin.
TEST_P(EveryController, AStripRunsFromTheRobotThroughThePassPoint) {
  const Situation s;
  ControlOutput out;
  make()->update(s.in, s.parameters, out);
  const algo::Layer* strip = layer_of(out, "strip");
  EXPECT_EQ(strip != nullptr, out.measure("strip.length").has_value());
  if (strip == nullptr) return;
  const Vec2 robot = s.in.odometry.pose.position();
  EXPECT_LT((point(*strip, 0) - robot).norm(), 1e-6);
  if (GetParam() == "strip" || GetParam() == "strip_moving") {
    ASSERT_GT(strip->values.size(), 20U);
    EXPECT_LT((point(*strip, strip->values.size() / 2 - 1) - s.in.goal->position_W).norm(), 1e-6);
    return;
  }
  ASSERT_EQ(strip->values.size(), 4U);
  ASSERT_TRUE(out.pass_W);
  EXPECT_LT((point(*strip, 1) - *out.pass_W).norm(), 1e-6);
  const algo::Layer* elastic = layer_of(out, "strip.elastic");
  ASSERT_TRUE(elastic != nullptr && elastic->values.size() == 4U);
  const Vec2 end = point(*elastic, 0);
  EXPECT_NEAR((end - robot).norm(), 0.2, 1e-6);
  EXPECT_LT((end + point(*elastic, 1) - *out.pass_W).norm(), 1e-6);
  Vec2 sum{0, 0};
  for (const char* name : {"strip.internal", "strip.external", "strip.push"}) {
    const algo::Layer* forces = layer_of(out, name);
    ASSERT_NE(forces, nullptr) << name;
    for (std::size_t k = 1; k < forces->values.size() / 2; k += 2) sum += point(*forces, k);
  }
  EXPECT_LT((sum - point(*elastic, 1)).norm(), 1e-6);
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
      EXPECT_TRUE(out.layers.empty()) << "number " << k << " = " << bad;
      EXPECT_FALSE(out.pass_W) << "number " << k << " = " << bad;
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
  const auto settle = [&] {  // a controller may ask for a turn as fast as the base can gain it
    for (int k = 0; k < 20; ++k) controller->update(s.in, s.parameters, out);
  };
  s.in.goal = algo::SetGoal{{0.25, 0.1}, std::nullopt};  // 50 mm away
  controller->update(s.in, s.parameters, out);
  EXPECT_EQ(out.twist, Twist2{});
  s.in.goal->heading = 0.5;  // 0.4 rad to the left of 0.1, gain 2: 0.8 rad/s
  settle();
  EXPECT_EQ(out.twist.v, 0);
  EXPECT_NEAR(out.twist.omega, 0.8, 1e-12);
  s.in.goal->heading = 0.1 - 3.0;  // to the right, limited to 1 rad/s
  settle();
  EXPECT_EQ(out.twist, (Twist2{0, -1.0}));
  s.in.goal->heading = 0.1 + 0.049;  // within 0.05
  settle();
  EXPECT_EQ(out.twist, Twist2{});
}

TEST_P(EveryController, OnAnObstaclePointItStops) {
  Situation s;
  s.scene.right->point_W = s.in.odometry.pose.position();
  s.scene.right->distance = 0;
  ControlOutput out;
  make()->update(s.in, s.parameters, out);
  EXPECT_EQ(out.twist, Twist2{});
  EXPECT_TRUE(!out.pass_W || out.pass_W->allFinite());
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
    ASSERT_GE(out.twist.v, 0);  // the strip never drives backwards into unseen space
    ASSERT_LE(out.twist.v, 0.7);
    ASSERT_LE(std::abs(out.twist.omega), 0.6);
  }
}

TEST_P(EveryController, ParametersActAtOnce) {
  Situation s({-0.8, 0, 0});     // far enough for all of them to drive on
  s.spec.max_acceleration = 10;  // so none has to accelerate first
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
