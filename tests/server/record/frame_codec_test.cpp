// tests/server/record/frame_codec_test.cpp: the data that a pipeline needs decode bit for bit;
// garbage is refused.
#include "server/record/frame_codec.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "telemetry_generated.h"
#include <gtest/gtest.h>

#include "algo/gate.hpp"
#include "algo/strip/strip_law.hpp"

namespace server {
namespace {

namespace wire = tautline::wire;

constexpr algo::LayerInfo kStrip{
    .name = "strip", .label = "Strip", .kind = algo::LayerKind::Polyline};
constexpr algo::LayerInfo kPlan{
    .name = "plan", .label = "Plan", .kind = algo::LayerKind::Polyline, .tone = algo::Tone::Plan};
constexpr algo::LayerInfo kForces{
    .name = "forces", .label = "Forces", .kind = algo::LayerKind::Arrows};
constexpr algo::LayerInfo kNearest{
    .name = "scan.nearest", .label = "Nearest", .style = algo::LayerStyle::Dashed};
constexpr algo::LayerInfo kGrid{.name = "grid", .label = "Grid", .kind = algo::LayerKind::Grid};
constexpr algo::LayerInfo kText{
    .name = "text", .label = "Text", .kind = algo::LayerKind::Text, .axes = 3, .unit = "m"};

algo::Telemetry full_telemetry() {
  algo::Telemetry t;
  t.tick = 4711;
  algo::Observation& o = t.observation;
  o.stamp = 12.345678901234567;
  o.halt = algo::Halt::StopButton;
  o.odometry = {12.34, {1.0 / 3.0, -2.0 / 7.0, 0.1}, {0.3, -0.2}};
  algo::LaserScan& scan = o.scans.append();
  scan.mount_R = {0.1, -0.05, 0.01};
  scan.stamp = 12.3;
  scan.angle_min = -1.5707963267948966;
  scan.angle_increment = 0.008726646259971648;
  scan.range_max = 8.191;
  scan.turn_period = 1.0 / 75;
  scan.turns = 2;
  scan.resize(361);
  for (std::size_t i = 0; i < 361; ++i) scan.set_ok(i, 0.5 + 0.01 * static_cast<double>(i));
  scan.set_free(7);
  scan.set_invalid(8, algo::BeamCode::Dazzled);
  algo::quantise(scan);
  o.sonar.push_back({{0.3, 0, 0}, 12.2, 1.25, 3.0, algo::Beam::Ok});
  o.infrared.push_back({{0.3, 0.1, 0.2}, 12.2, 0.8, 0.8, algo::Beam::Free});
  o.bumpers.push_back({{0.375, 0, 0}, 12.3, true});
  o.gyro = algo::YawGyro{12.3, 0.123};
  o.inclinometer = algo::Inclinometer{12.3, 0.01, -0.02};
  o.encoders = algo::Encoders{12.3, 4294967290U, 17};
  t.requests.push_back(algo::SetGoal{{3.5, 5.0}, 0.25});
  t.requests.push_back(algo::SetGoal{{0, 0}, std::nullopt});
  t.requests.push_back(algo::AddGoal{{{1, 2}, -0.5}});
  t.requests.push_back(algo::SetGoals{{{{1, 2}, 0.5}, {{3, 4}, std::nullopt}}, 1, true});
  t.requests.push_back(algo::SetGoals{});
  t.requests.push_back(algo::ClearGoal{});
  for (const algo::Shape& shape : {algo::Shape{algo::Cylinder{0.3}},
                                   algo::Shape{algo::Box{0.5, 0.25}},
                                   algo::Shape{algo::Polygon{{{0, 0}, {1, 0}, {0, 1}}}},
                                   algo::Shape{algo::Wall{4, 0.1}},
                                   algo::Shape{algo::Ramp{2, 1, 0.1}},
                                   algo::Shape{algo::Trench{0.3, 1, 0.05}}}) {
    t.requests.push_back(algo::AddObstacle{{7, {1, 2, 3}, shape, 0.9, 0.4, true}});
  }
  algo::Obstacle walker{7, {1, 2, 3}, algo::Cylinder{0.25}};
  walker.path = {.period = 12.5, .phase = 0.1, .keys = {{0, {1, 2}}, {3.3, {1.7, 2.1}}}};
  t.requests.push_back(algo::ChangeObstacle{walker});
  walker.path->comes_and_goes = true;
  t.requests.push_back(algo::ChangeObstacle{walker});
  t.requests.push_back(algo::MoveObstacle{7, {1.5, 2.5, 0.5}});
  t.requests.push_back(algo::RemoveObstacle{7});
  t.requests.push_back(algo::Joystick{0.5, -0.25, algo::StickMode::Wall});
  t.requests.push_back(algo::Stop{false});
  t.requests.push_back(algo::SetParameter{&algo::kRepulsionGain, 0.45});
  t.ground_truth = algo::GroundTruth{{1, 2, 3}, 0.75, 0.5, true};
  t.goal = algo::SetGoal{{3.5, 5.0}, std::nullopt};
  t.goals_ahead.push_back({{1, 2}, std::nullopt});
  t.goals_ahead.push_back({{-3, 0.5}, std::nullopt});
  t.command = {{0.1234567890123456, -0.9876543210987654}};
  t.hold = algo::holds::kBumper;
  t.mission = algo::Mission::Held;
  t.behaviour = algo::behaviours::kAvoid;
  t.clearance = 0.75;
  t.moved.push_back({7, {1.5, -2, 0.25}});
  t.output.pass_W = algo::Vec2{0.5, 1};
  t.output.waits = true;
  t.output.state = 3;
  t.output.measures.push_back({"strip.elastic", "m", 0.25});
  t.output.measures.push_back({"strip.side", "", -1});
  put(add_layer(t.output.layers, kStrip), algo::Vec2{0, 1}, algo::Vec2{0.5, 1}, algo::Vec2{1, 1});
  add_layer(t.output.layers, kForces);  // nothing to show
  put(add_layer(t.layers, kNearest), algo::Vec2{1, 0.5});
  t.words = {"Doing this", "For that reason."};
  t.words_fresh = true;
  t.legend = 0xDEADBEEF;
  t.legend_fresh = true;
  t.limit = {.name = "slope"};
  t.command.joints = 2;
  t.command.joint_rates[1] = -0.1 / 3;
  t.ground_truth->tilt = algo::Tilt{0.25, -0.5, 0.125};
  o.line.fresh = true;
  o.line.stamp = 12.32;
  o.line.pixels.push_back({-319.5F, 1.0F / 3.0F});
  o.line.pixels.push_back({0, -17});
  o.floor = {12.31, 1.0 / 3.0, 0.28, 0.2, 0.2000000001};
  t.ground_truth->overturned = true;
  t.ground_truth->fallen = true;
  o.channels.append() = {.channel = 3, .stamp = 12.1, .values = {1.0 / 3.0, -7}};
  o.channels.append() = {.channel = 0, .stamp = o.stamp, .values = {}};
  return t;
}

/// The frame as the page reads it, valid until the encoder's next frame.
const wire::Frame& read(FrameEncoder& encoder, const algo::Telemetry& t) {
  return *wire::GetFrame(encoder.encode(t).data());
}

TEST(FrameCodec, ObservationRequestsAndCommandComeBackBitForBit) {
  const algo::Telemetry t = full_telemetry();
  FrameEncoder encoder;
  algo::Telemetry back;
  decode_frame(encoder.encode(t), back);

  EXPECT_EQ(back.tick, t.tick);
  EXPECT_EQ(back.observation.stamp, t.observation.stamp);
  EXPECT_EQ(back.observation.halt, t.observation.halt);
  EXPECT_EQ(back.observation.odometry, t.observation.odometry);
  ASSERT_EQ(back.observation.scans.size(), 1u);
  const algo::LaserScan& a = t.observation.scans[0];
  const algo::LaserScan& b = back.observation.scans[0];
  EXPECT_EQ(a.ranges, b.ranges);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.codes, b.codes);
  EXPECT_EQ(a.mount_R, b.mount_R);
  EXPECT_EQ(a.turn_period, b.turn_period);
  EXPECT_EQ(a.turns, b.turns);
  EXPECT_EQ(back.observation.sonar[0], t.observation.sonar[0]);
  EXPECT_EQ(back.observation.infrared[0], t.observation.infrared[0]);
  EXPECT_EQ(back.observation.bumpers[0], t.observation.bumpers[0]);
  EXPECT_EQ(back.observation.gyro, t.observation.gyro);
  EXPECT_EQ(back.observation.inclinometer, t.observation.inclinometer);
  EXPECT_EQ(back.observation.encoders, t.observation.encoders);
  EXPECT_TRUE(back.observation.line.fresh);
  EXPECT_EQ(back.observation.line.stamp, t.observation.line.stamp);
  EXPECT_TRUE(std::ranges::equal(back.observation.line.pixels, t.observation.line.pixels));
  EXPECT_EQ(back.observation.floor, t.observation.floor);
  ASSERT_EQ(back.requests.size(), t.requests.size());
  for (std::size_t i = 0; i < t.requests.size(); ++i) EXPECT_EQ(back.requests[i], t.requests[i]);
  EXPECT_EQ(back.command, t.command);
  EXPECT_EQ(back.ground_truth, t.ground_truth);
  EXPECT_EQ(back.goal, t.goal);
  ASSERT_EQ(back.goals_ahead.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(back.goals_ahead[i], t.goals_ahead[i]);
  EXPECT_EQ(back.hold, t.hold);
  EXPECT_EQ(back.mission, t.mission);
  EXPECT_EQ(back.behaviour, t.behaviour);
  ASSERT_EQ(back.moved.size(), 1U);
  EXPECT_EQ(back.moved[0], t.moved[0]);
  EXPECT_TRUE(back.output.waits);
  EXPECT_EQ(back.output.state, 3);
  EXPECT_TRUE(back.words_fresh);
  EXPECT_EQ(back.words, t.words);
  EXPECT_EQ(back.legend, t.legend);
  EXPECT_TRUE(back.legend_fresh);
  EXPECT_EQ(back.limit, t.limit);
  ASSERT_EQ(back.observation.channels.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back.observation.channels[i], t.observation.channels[i]);
  }
}

TEST(FrameCodec, ThePoseOnAMapAndTheOneGivenComeBackBitForBit) {
  algo::Telemetry t = full_telemetry();
  t.observation.map_pose = {.fix = algo::MapFix::NotUnique,
                            .places = 3,
                            .epoch = 2,
                            .wheels = {1.0 / 3, -2, 0.7},
                            .xx = 0.01 / 3,
                            .xy = -1e-5,
                            .yy = 0.02,
                            .turn = 1e-4 / 3,
                            .fit = 0.9};
  t.requests.clear();
  t.requests.push_back(algo::SetInitialPose{algo::Pose2{1.0 / 3, 2, -3}});
  t.requests.push_back(algo::SetInitialPose{});
  FrameEncoder encoder;
  algo::Telemetry back;
  decode_frame(encoder.encode(t), back);
  EXPECT_EQ(back.observation.map_pose, t.observation.map_pose);
  ASSERT_EQ(back.requests.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(back.requests[i], t.requests[i]);
  t.observation.map_pose.reset();
  decode_frame(encoder.encode(t), back);
  EXPECT_FALSE(back.observation.map_pose);
}

TEST(FrameCodec, OwnStampsAndFrameStampsComeBack) {
  algo::Telemetry t = full_telemetry();
  algo::Observation& o = t.observation;
  for (const double own : {0.0, 1e-9}) {
    o.odometry.stamp = o.encoders->stamp = o.gyro->stamp = o.inclinometer->stamp = o.stamp - own;
    FrameEncoder encoder;
    algo::Telemetry back;
    decode_frame(encoder.encode(t), back);
    EXPECT_EQ(back.observation.odometry, o.odometry);
    EXPECT_EQ(back.observation.encoders, o.encoders);
    EXPECT_EQ(back.observation.gyro, o.gyro);
    EXPECT_EQ(back.observation.inclinometer, o.inclinometer);
  }
}

TEST(FrameCodec, AnEmptyImageAndADistanceOutOfRangeComeBack) {
  algo::Telemetry t;
  t.observation.line.fresh = true;
  t.observation.line.stamp = 3;
  t.observation.floor = {3, std::nan(""), 0.28, 0.2, std::nan("")};
  FrameEncoder encoder;
  algo::Telemetry back = full_telemetry();
  decode_frame(encoder.encode(t), back);
  EXPECT_TRUE(back.observation.line.fresh);
  EXPECT_EQ(back.observation.line.stamp, 3);
  EXPECT_TRUE(back.observation.line.pixels.empty());
  ASSERT_TRUE(back.observation.floor);
  EXPECT_TRUE(std::isnan(back.observation.floor->far_left));
  EXPECT_EQ(back.observation.floor->far_right, 0.28);
  EXPECT_TRUE(std::isnan(back.observation.floor->near_right));
  // The next frame brings neither.
  decode_frame(encoder.encode(algo::Telemetry{}), back);
  EXPECT_FALSE(back.observation.line.fresh);
  EXPECT_FALSE(back.observation.floor);
}

TEST(FrameCodec, AFrameBetweenTwoImagesIsAsLargeAsWithoutACamera) {
  const auto size_of = [](const algo::Telemetry& t) {
    FrameEncoder encoder;
    return encoder.encode(t).size();
  };
  algo::Telemetry t = full_telemetry();
  t.command.joints = 0;
  t.command.joint_rates = {};
  t.ground_truth->tilt.reset();
  t.observation.line.fresh = false;
  t.observation.floor.reset();
  const std::size_t between = size_of(t);
  t.observation.line.pixels.clear();
  EXPECT_EQ(size_of(t), between);
  t.observation.floor.emplace();
  EXPECT_GE(size_of(t), between + sizeof(double) * 5);
}

TEST(FrameCodec, AbsentSensorsTakeNoByte) {
  algo::Telemetry t = full_telemetry();
  FrameEncoder encoder;
  const std::size_t whole = encoder.encode(t).size();
  t.command.joints = 0;
  t.command.joint_rates = {};
  t.ground_truth->tilt.reset();
  t.observation.channels.clear();
  t.observation.line.fresh = false;
  t.observation.floor.reset();
  t.limit = {};
  t.hold = {};
  const wire::Frame& frame = read(encoder, t);
  EXPECT_EQ(frame.joint_rates(), nullptr);
  EXPECT_EQ(frame.tilt(), nullptr);
  EXPECT_EQ(frame.channels(), nullptr);
  EXPECT_EQ(frame.line(), nullptr);
  EXPECT_EQ(frame.floor(), nullptr);
  EXPECT_EQ(frame.limit(), nullptr);
  EXPECT_EQ(frame.hold(), nullptr);
  EXPECT_GT(whole, encoder.encode(t).size() + 100);
}

TEST(FrameCodec, AScannerUnlikeTheDefaultComesBack) {
  for (const algo::Pose2& mount : {algo::Pose2{}, algo::Pose2{0, 0, 1e-9}}) {
    for (const double more : {0.0, 1e-15}) {
      algo::Telemetry t;
      algo::LaserScan& scan = t.observation.scans.append();
      scan.mount_R = mount;
      scan.angle_min = -1.5707963267948966 - more;
      scan.angle_increment = 0.008726646259971648 + more;
      scan.range_max = 8.191 + more;
      scan.turn_period = 1.0 / 75 + more;
      scan.turns = more == 0 ? 2 : 3;
      FrameEncoder encoder;
      algo::Telemetry back;
      decode_frame(encoder.encode(t), back);
      const algo::LaserScan& read = back.observation.scans[0];
      EXPECT_EQ(read.mount_R, scan.mount_R);
      EXPECT_EQ(read.angle_min, scan.angle_min);
      EXPECT_EQ(read.angle_increment, scan.angle_increment);
      EXPECT_EQ(read.range_max, scan.range_max);
      EXPECT_EQ(read.turn_period, scan.turn_period);
      EXPECT_EQ(read.turns, scan.turns);
    }
  }
}

TEST(FrameCodec, LayersAndMeasuresAreReadable) {
  algo::Telemetry t = full_telemetry();
  algo::Layer& grid = add_layer(t.output.layers, kGrid);
  put(grid, algo::Vec2{-1.5, 2}, 0.125, 3);
  grid.cells = {0, 127, 254, 255, 7, 0};
  algo::Layer& text = add_layer(t.output.layers, kText);
  put(text, 1.0, 2.0, 0.5);
  text.text = "here";
  FrameEncoder encoder;
  const wire::Frame& frame = read(encoder, t);
  const auto& infos = *frame.news()->layers();
  ASSERT_EQ(infos.size(), 5U);  // the one of the pipeline first, also the one that is empty
  EXPECT_EQ(infos[0]->name()->str(), "scan.nearest");
  EXPECT_EQ(infos[0]->style(), wire::LayerStyle_Dashed);
  const wire::LayerInfo& strip = *infos[1];
  EXPECT_EQ(strip.name()->str(), "strip");
  EXPECT_EQ(strip.label()->str(), "Strip");
  EXPECT_EQ(strip.kind(), wire::LayerKind_Polyline);
  EXPECT_EQ(strip.tone(), wire::Tone_Accent);
  EXPECT_EQ(strip.axes(), 2);
  EXPECT_EQ(infos[3]->kind(), wire::LayerKind_Grid);
  EXPECT_EQ(infos[4]->axes(), 3);
  EXPECT_EQ(infos[4]->unit()->str(), "m");
  EXPECT_EQ(frame.news()->measures()->str(), "strip.elastic\nstrip.side");
  EXPECT_EQ(frame.news()->units()->str(), "m\n");

  EXPECT_EQ(frame.decision()->legend(), t.legend);
  EXPECT_EQ(frame.shown_wide(), nullptr);
  const std::vector<std::int16_t> shown{2,    1024, 512,  6,   0,     1024, 512, 1024,
                                        1024, 1024, 0,    4,   -1536, 2048, 128, 3072,
                                        3,    1024, 2048, 512, 256,   -1024};
  EXPECT_TRUE(std::ranges::equal(*frame.shown(), shown));
  ASSERT_EQ(frame.more()->size(), 2U);
  EXPECT_EQ(frame.more()->Get(0)->layer(), 3);
  EXPECT_TRUE(std::ranges::equal(*frame.more()->Get(0)->cells(), grid.cells));
  EXPECT_EQ(frame.more()->Get(1)->layer(), 4);
  EXPECT_EQ(frame.more()->Get(1)->text()->str(), "here");
}

TEST(FrameCodec, LayerValuesAreRoundedToDisplayPrecision) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  algo::Telemetry t;
  algo::Layer& layer = add_layer(t.output.layers, kStrip);
  layer.values = {1.0004F, -3.9991F, kNan, kNan, 3e30F, 1e-9F};
  FrameEncoder encoder;
  const auto& values = *read(encoder, t).shown_wide();
  EXPECT_EQ(values[0], 6);
  EXPECT_EQ(values[1], 1);
  EXPECT_EQ(values[2], -4 + 1.0F / 1024);
  EXPECT_TRUE(std::isnan(values[3]) && std::isnan(values[4]));
  EXPECT_EQ(values[5], 3e30F);
  EXPECT_EQ(values[6], 0);

  layer.values[4] = 30;
  const auto& narrow = *read(encoder, t).shown();
  const std::vector<std::int16_t> expected{6, 1024, -4095, -32768, -32768, 30 * 1024, 0};
  EXPECT_TRUE(std::ranges::equal(narrow, expected));
}

/// One value beyond 16 bits makes the whole frame wide.
TEST(FrameCodec, ValuesBeyond16BitsAreStoredWide) {
  const auto is_wide = [](const algo::Telemetry& t) {
    FrameEncoder encoder;
    const wire::Frame& frame = read(encoder, t);
    EXPECT_NE(frame.shown() == nullptr, frame.shown_wide() == nullptr);
    return frame.shown() == nullptr;
  };
  for (const float sign : {1.F, -1.F}) {
    algo::Telemetry t;
    algo::Layer& layer = add_layer(t.output.layers, kStrip);
    layer.values = {sign * 32767 / 1024};
    EXPECT_FALSE(is_wide(t));
    layer.values = {sign * 32767.5F / 1024};
    EXPECT_TRUE(is_wide(t));
    layer.values = {sign * std::numeric_limits<float>::infinity()};
    EXPECT_TRUE(is_wide(t));
  }
  algo::Telemetry t;
  t.output.measures.push_back({"window.allowed", "", 189});
  EXPECT_TRUE(is_wide(t));
  t.output.measures[0].value = 18.9;
  EXPECT_FALSE(is_wide(t));
  add_layer(t.output.layers, kStrip).values.assign(32'767, 1);
  EXPECT_FALSE(is_wide(t));
  t.output.layers[0].values.push_back(1);
  EXPECT_TRUE(is_wide(t));
}

TEST(FrameCodec, RoundingGivesTheNearestStepAndTheEvenOneOfTwo) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> exponent(-14, 22);
  for (int i = 0; i < 20'000; ++i) {
    const float power = std::exp2(exponent(random));
    const float near_half = (std::floor(power) + 0.5F) / 1024;
    for (const float value :
         {power, -power, near_half, -near_half, std::nextafter(near_half, 0.F)}) {
      EXPECT_EQ(rounded(value), static_cast<float>(std::nearbyint(double{value} * 1024) / 1024))
          << value;
    }
  }
}

/// The encoder's state from the previous tick changes no byte.
TEST(FrameCodec, ChangingLayersEncodeAsWithAFreshEncoder) {
  FrameEncoder kept;
  algo::Telemetry t = full_telemetry();
  const auto expect_same = [&](const char* what) {
    FrameEncoder fresh;
    EXPECT_TRUE(std::ranges::equal(kept.encode(t), fresh.encode(t))) << what;
  };
  expect_same("at first");
  t.output.layers[0].values[2] = 0.75F;
  t.output.measures[0].value = 0.5;
  expect_same("with other values");
  t.output.layers[0].values.push_back(2);
  t.output.layers[0].values.push_back(3);
  expect_same("with a longer line");
  t.words_fresh = t.legend_fresh = false;
  expect_same("without words");
  algo::Layer& grid = add_layer(t.output.layers, kGrid);
  put(grid, algo::Vec2{-1.5, 2}, 0.125, 3);
  grid.cells = {0, 127, 254};
  expect_same("with a grid");
  t.output.layers.pop_back();
  expect_same("without it again");
  t.output.measures.pop_back();
  expect_same("with a measure less");
  t.output.clear();
  expect_same("with the pipeline's alone");
  t.layers.clear();
  expect_same("with none");
}

TEST(FrameCodec, UnchangedWordsAreLeftOut) {
  algo::Telemetry t = full_telemetry();
  t.words_fresh = t.legend_fresh = false;
  FrameEncoder encoder;
  EXPECT_EQ(read(encoder, t).news(), nullptr);
  t.legend_fresh = true;
  EXPECT_EQ(read(encoder, t).news()->what(), nullptr);
  EXPECT_EQ(read(encoder, t).news()->why(), nullptr);
  t.legend_fresh = false;
  t.words_fresh = true;
  EXPECT_EQ(read(encoder, t).news()->layers(), nullptr);
  EXPECT_EQ(read(encoder, t).news()->measures(), nullptr);
  t.words_fresh = false;
  algo::Telemetry back;
  decode_frame(encoder.encode(full_telemetry()), back);
  decode_frame(encoder.encode(t), back);  // no old value stays
  EXPECT_FALSE(back.words_fresh);
  EXPECT_TRUE(back.words.what.empty());
}

TEST(FrameCodec, EveryBehaviourIsReadBackAndAvoidingTakesNoByte) {
  FrameEncoder encoder;
  algo::Telemetry t = full_telemetry();
  for (const algo::Name& behaviour :
       {algo::behaviours::kRest, algo::behaviours::kAvoid, algo::behaviours::kManual}) {
    t.behaviour = behaviour;
    algo::Telemetry back;
    decode_frame(encoder.encode(t), back);
    EXPECT_EQ(back.behaviour, behaviour);
    EXPECT_EQ(read(encoder, t).behaviour() == nullptr, behaviour == algo::behaviours::kAvoid);
  }
}

TEST(FrameCodec, AScanOnItsOwnIsAMessage) {
  const algo::Telemetry whole = full_telemetry();
  const algo::LaserScan& scan = whole.observation.scans[0];
  FrameEncoder encoder;
  const auto bytes = encoder.encode(scan);
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  flatbuffers::Verifier verifier(data, bytes.size());
  ASSERT_TRUE(verifier.VerifyBuffer<wire::LaserScan>(nullptr));
  const auto& read = *flatbuffers::GetRoot<wire::LaserScan>(data);
  ASSERT_EQ(read.ranges()->size(), scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    EXPECT_EQ(read.ranges()->Get(static_cast<flatbuffers::uoffset_t>(i)), algo::pack_beam(scan, i));
  }
  EXPECT_EQ(read.stamp(), scan.stamp);
}

TEST(FrameCodec, AFrameIsReadableAtAnyAlignment) {
  FrameEncoder encoder;
  const auto bytes = encoder.encode(full_telemetry());
  for (std::size_t shift = 1; shift < 8; ++shift) {
    std::vector<std::byte> message(shift);
    message.insert(message.end(), bytes.begin(), bytes.end());
    algo::Telemetry back;
    decode_frame(std::span(message).subspan(shift), back);  // sanitizers check the alignment
    EXPECT_EQ(back.observation.odometry, full_telemetry().observation.odometry);
  }
}

TEST(FrameCodec, EncodingIsDeterministicAndReusesItsBuffers) {
  const algo::Telemetry t = full_telemetry();
  FrameEncoder first;
  FrameEncoder second;
  second.encode(algo::Telemetry{});
  const auto a = first.encode(t);
  const auto b = second.encode(t);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size()), 0);
}

TEST(FrameCodec, WindowsPointAtRanges) {
  algo::Telemetry t = full_telemetry();
  const algo::LaserScan scan = t.observation.scans[0];
  t.observation.scans.append() = scan;
  FrameEncoder encoder;
  const auto bytes = encoder.encode(t);
  ASSERT_EQ(encoder.windows().size(), 2u);
  const db::Window window = encoder.windows()[0];
  ASSERT_EQ(window.count, 361u);
  std::uint16_t sample = 0;
  std::memcpy(&sample, bytes.data() + window.offset + 2 * 100, 2);
  EXPECT_EQ(sample, algo::pack_beam(t.observation.scans[0], 100));
  const db::Window second = encoder.windows()[1];
  EXPECT_EQ(second.count, 361u);
  EXPECT_GE(second.offset, window.offset + 2 * 361);
  std::memcpy(&sample, bytes.data() + second.offset + 2 * 360, 2);
  EXPECT_EQ(sample, algo::pack_beam(t.observation.scans[0], 360));
}

TEST(FrameCodec, ATickOfDrivingStaysSmall) {
  algo::Telemetry t = full_telemetry();
  t.requests.clear();
  t.observation.sonar.clear();
  t.observation.infrared.clear();
  t.goals_ahead.clear();
  t.moved.clear();
  t.words_fresh = t.legend_fresh = false;
  t.observation.channels.clear();
  t.observation.line.fresh = false;
  t.observation.floor.reset();
  t.command.joints = 0;
  t.hold = {};
  t.limit = {};
  t.ground_truth->tilt.reset();
  FrameEncoder encoder;
  EXPECT_LE(encoder.encode(t).size(), 1200u);
}

TEST(FrameCodec, GarbageIsRefusedWithASentence) {
  algo::Telemetry back;
  EXPECT_THROW(decode_frame({}, back), WireError);
  std::mt19937 random(1);
  FrameEncoder encoder;
  const auto good = encoder.encode(full_telemetry());
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::byte> bytes(good.begin(), good.end());
    const std::size_t flips = 1 + random() % 8;
    for (std::size_t i = 0; i < flips; ++i) bytes[random() % bytes.size()] = std::byte(random());
    if (round % 3 == 0) bytes.resize(random() % bytes.size());
    try {
      decode_frame(bytes, back);  // a flipped coordinate is still a frame
    } catch (const WireError& e) {
      EXPECT_GT(std::string(e.what()).size(), 10u);
    }
  }
}

}  // namespace
}  // namespace server
