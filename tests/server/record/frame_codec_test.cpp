// tests/server/record/frame_codec_test.cpp: what a pipeline needs comes back bit for bit; garbage
// does not.
#include "server/record/frame_codec.hpp"

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "algo/strip/strip_law.hpp"

namespace server {
namespace {

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
  t.requests.push_back(algo::ClearGoal{});
  for (const algo::Shape& shape : {algo::Shape{algo::Cylinder{0.3}},
                                   algo::Shape{algo::Box{0.5, 0.25}},
                                   algo::Shape{algo::Polygon{{{0, 0}, {1, 0}, {0, 1}}}},
                                   algo::Shape{algo::Wall{4, 0.1}}}) {
    t.requests.push_back(algo::AddObstacle{{7, {1, 2, 3}, shape, 0.9, 0.4, true}});
  }
  t.requests.push_back(algo::MoveObstacle{7, {1.5, 2.5, 0.5}});
  t.requests.push_back(algo::RemoveObstacle{7});
  t.requests.push_back(algo::Joystick{0.5, -0.25});
  t.requests.push_back(algo::Stop{false});
  t.requests.push_back(algo::SetParameter{&algo::kRepulsionGain, 0.45});
  t.ground_truth = algo::GroundTruth{{1, 2, 3}, 0.75, 0.5, true};
  t.goal = algo::SetGoal{{3.5, 5.0}, std::nullopt};
  t.goals_ahead.push_back({{1, 2}, std::nullopt});
  t.goals_ahead.push_back({{-3, 0.5}, std::nullopt});
  t.command = {{0.1234567890123456, -0.9876543210987654}};
  t.hold = algo::Hold::Bumper;
  t.mission = algo::Mission::Held;
  t.behaviour = algo::BehaviourId::Avoid;
  t.clearance = 0.75;
  t.output.strip.push_back({{0, 1}, {0, 0}, {0, 0}});
  t.output.strip.push_back({{0.5, 1}, {0.25, 0}, {-0.5, 0.375}});
  t.output.strip.push_back({{1, 1}, {0, 0}, {0, 0}});
  t.output.pass_W = {0.5, 1};
  t.output.internal_W = {0.25, 0};
  t.output.external_left_W = {-0.5, 0};
  t.output.external_right_W = {0, 0.125};
  t.output.elastic_W = {-0.25, 0.375};  // the side choice pushes by 0.25
  t.output.side = algo::Side::Right;
  t.output.side_since = 11.9;
  t.scene.left = algo::Nearest{200, {1, 0.5}, 1.125};
  return t;
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
  EXPECT_EQ(back.output.side, t.output.side);
  EXPECT_EQ(back.output.side_since, t.output.side_since);
  EXPECT_EQ(back.output.pass_W, t.output.pass_W);
  EXPECT_EQ(back.output.elastic_W, t.output.elastic_W);
  ASSERT_EQ(back.output.strip.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(back.output.strip[i], t.output.strip[i]);
  EXPECT_EQ(back.scene.left, t.scene.left);
}

TEST(FrameCodec, StampsOfTheirOwnAndThoseOfTheFrameComeBack) {
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

TEST(FrameCodec, WhatAControllerWeighsComesBack) {
  algo::Telemetry t = full_telemetry();
  algo::ControlOutput& out = t.output;
  for (int i = 0; i < 4; ++i) out.plan_W.push_back({0.5 * i, -0.25 * i});
  out.candidates.push_back({{0.25, -0.5}, 1.5, 0.125, true, true});
  out.candidates.push_back({{0.5, 0}, 1.5, 0.0625, false, false});
  out.histogram = {0, 1, 2.5F, 300};
  out.histogram_threshold = 300;
  out.grid = {{-1.5, 2}, 0.125, 3, 2, {0, 127, 254, 255, 7, 0}};
  FrameEncoder encoder;
  algo::Telemetry back;
  decode_frame(encoder.encode(t), back);
  ASSERT_EQ(back.output.plan_W.size(), 4U);
  EXPECT_EQ(back.output.plan_W[3], out.plan_W[3]);
  ASSERT_EQ(back.output.candidates.size(), 2U);
  EXPECT_EQ(back.output.candidates[0], out.candidates[0]);
  EXPECT_EQ(back.output.candidates[1], out.candidates[1]);
  EXPECT_EQ(back.output.histogram, out.histogram);
  EXPECT_EQ(back.output.histogram_threshold, 300);
  EXPECT_EQ(back.output.grid, out.grid);

  decode_frame(encoder.encode(full_telemetry()), back);  // nothing of it stays
  EXPECT_TRUE(back.output.plan_W.empty() && back.output.candidates.empty());
  EXPECT_TRUE(back.output.histogram.empty() && back.output.grid.cells.empty());
}

// By the fuzzer: forces of 1e-27 m beside others left a push of 1e-43 m that grew with every
// reading.
TEST(FrameCodec, TheRoundingOfForcesIsNoPushToASide) {
  for (const double tiny : {1.64078e-27, 1e-9, 0.0}) {
    algo::Telemetry t = full_telemetry();
    t.output.internal_W = {tiny, 0.1};
    t.output.external_left_W = {3.57331e-43, 35.751};
    t.output.external_right_W = {3.54487e-38, 0.3};
    t.output.elastic_W = t.output.internal_W + t.output.external_left_W + t.output.external_right_W;
    t.output.elastic_W.x() += 0x1p-53 * tiny;
    FrameEncoder encoder;
    const auto first = encoder.encode(t);
    const std::vector<std::byte> kept(first.begin(), first.end());
    algo::Telemetry back;
    decode_frame(kept, back);
    const algo::Vec2 sum =
        back.output.internal_W + back.output.external_left_W + back.output.external_right_W;
    EXPECT_EQ(back.output.elastic_W, sum) << tiny;
    const auto second = encoder.encode(back);
    EXPECT_TRUE(std::ranges::equal(kept, second)) << tiny;
  }
}

TEST(FrameCodec, AFrameReadsWhereverItLies) {
  FrameEncoder encoder;
  const auto bytes = encoder.encode(full_telemetry());
  for (std::size_t shift = 1; shift < 8; ++shift) {
    std::vector<std::byte> message(shift);
    message.insert(message.end(), bytes.begin(), bytes.end());
    algo::Telemetry back;
    decode_frame(std::span(message).subspan(shift), back);  // the sanitizers watch
    EXPECT_EQ(back.observation.odometry, full_telemetry().observation.odometry);
  }
}

TEST(FrameCodec, EncodingIsDeterministicAndReusesItsBuffers) {
  const algo::Telemetry t = full_telemetry();
  FrameEncoder first;
  FrameEncoder second;
  second.encode({});
  const auto a = first.encode(t);
  const auto b = second.encode(t);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size()), 0);
}

TEST(FrameCodec, WindowsPointAtTheRanges) {
  const algo::Telemetry t = full_telemetry();
  FrameEncoder encoder;
  const auto bytes = encoder.encode(t);
  ASSERT_EQ(encoder.windows().size(), 2u);  // the ranges and the strip
  const auto windows = encoder.windows();
  const db::Window window = windows[0].kind == db::Window::Kind::Samples ? windows[0] : windows[1];
  ASSERT_EQ(window.kind, db::Window::Kind::Samples);
  ASSERT_EQ(window.count, 361u);
  EXPECT_EQ(window.per_half_turn, 360u);
  std::uint16_t sample = 0;
  std::memcpy(&sample, bytes.data() + window.offset + 2 * 100, 2);
  EXPECT_EQ(sample, algo::pack_beam(t.observation.scans[0], 100));
}

TEST(FrameCodec, ATickOfDrivingStaysSmall) {
  algo::Telemetry t = full_telemetry();
  t.requests.clear();
  t.observation.sonar.clear();
  t.observation.infrared.clear();
  t.goals_ahead.clear();
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
