// tests/server/record/ground_run_test.cpp: what the ground senses saw is stored bit for bit, and a
// run with it verifies.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "tests/server/record/recorder_fixture.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/record/frame_codec.hpp"
#include "server/record/headless.hpp"
#include "server/record/run_csv.hpp"
#include "server/record/run_json.hpp"
#include "server/record/verify.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/scenario_json.hpp"

namespace server {
namespace {

/// A robot with ground senses about another one. Keeps all that it reported.
class WithGroundSenses final : public algo::Robot {
 public:
  explicit WithGroundSenses(std::unique_ptr<algo::Robot> robot)
      : robot_(std::move(robot)), spec_(robot_->spec()) {
    spec_.floor = algo::FloorSensors{0.2, 0.2, 0.1, 0.8, 0.08};
    spec_.line = algo::LineCamera{0.1, 0.45, 0.3, 0.2, 0.6, 600, 640, 480};
  }

  std::vector<algo::FloorRanges> floors{};
  std::vector<std::vector<algo::LinePixel>> lines{};

  const algo::RobotSpec& spec() const override { return spec_; }
  void reset(algo::Observation& observation) override {
    robot_->reset(observation);
    sense(observation);
  }
  bool step(const algo::Command& command, algo::Observation& observation) override {
    const bool more = robot_->step(command, observation);
    sense(observation);
    return more;
  }
  void stop() noexcept override { robot_->stop(); }

 private:
  void sense(algo::Observation& observation) {
    const double t = static_cast<double>(ticks_++);
    if (ticks_ % 2 == 0) {
      observation.floor = algo::FloorRanges{
          t / 7, 0.28 + t / 3e5, ticks_ % 10 == 0 ? std::nan("") : 0.27, 0.2, 0.2 - t / 3e5};
      floors.push_back(*observation.floor);
    }
    if (ticks_ % 3 == 0) {
      observation.line.fresh = true;
      observation.line.stamp = t / 7;
      for (std::uint64_t i = 0; i < ticks_ % 5; ++i) {
        observation.line.pixels.push_back(
            {static_cast<float>(i) / 3.0F, static_cast<float>(-t) / 7.0F});
      }
      lines.emplace_back(observation.line.pixels.begin(), observation.line.pixels.end());
    }
  }

  std::unique_ptr<algo::Robot> robot_;
  algo::RobotSpec spec_;
  std::uint64_t ticks_ = 0;
};

bool same(const algo::FloorRanges& a, const algo::FloorRanges& b) {
  const auto equal = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return equal(a.stamp, b.stamp) && equal(a.far_left, b.far_left) &&
         equal(a.far_right, b.far_right) && equal(a.near_left, b.near_left) &&
         equal(a.near_right, b.near_right);
}

using GroundRun = test::RecorderFiles;

TEST_F(GroundRun, LineAndFloorComeBackBitForBitAndTheRunVerifies) {
  const auto scenario = scenario_from_json(
      nlohmann::json::parse(R"({"name":"ground","vehicle":"kinematic","goal":{"x":1,"y":0}})"));
  const RunSpec spec = make_spec(scenario, {});
  WithGroundSenses robot(make_robot(spec));
  db::RunId run = 0;
  {
    Recorder recorder(path, {.retention_bytes = 0});
    const auto channel = recorder.begin(headless_run(spec, robot.spec(), 0));
    run = channel->run();
    run_headless(spec, robot, {.record = channel}, {});
    recorder.flush();
  }
  db::RunReader reader(path);
  const db::RunRow row = *reader.get(run);
  ASSERT_GT(row.ticks, 100U);
  const algo::RobotSpec stored =
      robot_spec_from_json(parse_json(row.what.document, kOwnDocument).at("robot"));
  EXPECT_EQ(stored.floor, robot.spec().floor);
  EXPECT_EQ(stored.line, robot.spec().line);

  std::size_t floors = 0;
  std::size_t lines = 0;
  algo::Telemetry t;
  reader.frames(run, 0, row.ticks, [&](std::uint64_t, std::span<const std::byte> frame) {
    decode_frame(frame, t);
    if (t.observation.floor) {
      ASSERT_LT(floors, robot.floors.size());
      EXPECT_TRUE(same(*t.observation.floor, robot.floors[floors++])) << t.tick;
    }
    if (t.observation.line.fresh) {
      ASSERT_LT(lines, robot.lines.size());
      EXPECT_TRUE(std::ranges::equal(t.observation.line.pixels, robot.lines[lines++])) << t.tick;
    }
  });
  EXPECT_EQ(floors, robot.floors.size());
  EXPECT_EQ(lines, robot.lines.size());

  const Verification verification = verify_run(reader, run);
  EXPECT_EQ(verification.difference, std::nullopt);
  EXPECT_EQ(verification.incomplete, std::nullopt);
  EXPECT_EQ(verification.compared, row.ticks);
}

}  // namespace
}  // namespace server
