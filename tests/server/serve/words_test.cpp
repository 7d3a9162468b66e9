// tests/server/serve/words_test.cpp: the server's sentences and their frames:
// tests/golden/words.json, which the page's tests read too.
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/algo/worlds.hpp"
#include "tests/folders.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "algo/driving.hpp"
#include "algo/explain.hpp"
#include "algo/gate.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/strip/strip_law.hpp"
#include "server/record/frame_codec.hpp"

namespace server {
namespace {

using nlohmann::json;
const std::string kFile = (tests::folder() / "golden/words.json").string();

using Controller = std::unique_ptr<algo::Controller>;

/// A tick and its controller.
struct Tick {
  algo::Telemetry t{};
  Controller controller{};
};

algo::Telemetry driving() {
  algo::Telemetry t;
  t.observation.stamp = 10.0;
  t.observation.odometry = {10.0, {0.25, -0.5, 0.5}, {}};
  t.goal = algo::SetGoal{{3.1, 4.2}, std::nullopt};
  t.mission = algo::Mission::Driving;
  t.behaviour = algo::behaviours::kAvoid;
  t.scene.left = algo::Nearest{200, {1, 0.5}, 1.253};
  t.scene.right = algo::Nearest{100, {1, -0.5}, 1.127};
  return t;
}

/// The strip controller pushed by `force` [m] from one side, at 6.63 s and now.
Tick pushed(const char* controller, bool by_left, double force, double post_aside = 0) {
  Tick tick{driving(), algo::builtin_controllers().at(controller).make()};
  algo::Telemetry& t = tick.t;
  const algo::Pose2 pose = t.observation.odometry.pose;
  auto& pushes = by_left ? t.scene.left : t.scene.right;
  (by_left ? t.scene.right : t.scene.left).reset();
  const double aside = by_left ? 0.5 : -0.5;
  pushes->point_W = pose.position() + pushes->distance * algo::direction(pose.heading + aside);
  // A post on the way to the goal makes it choose a side.
  const algo::Vec2 way = (t.goal->position_W - pose.position()).normalized();
  const algo::Vec2 post = pose.position() + 1.2 * way + post_aside * algo::Vec2(-way.y(), way.x());
  worlds::scan_world(pose, {{{post, 0.3}}, {}}, 8, t.scene.scan);

  algo::RobotSpec spec{.radius = 0.35, .period = 0.026, .drives = true};
  algo::Parameters parameters;
  const double gain = parameters[algo::kRepulsionGain];
  const double half_step = parameters[algo::kStripStep] / 2;
  // C1: half a step and gain times the depth into the reach, which is safety distance and radius.
  parameters.set(algo::kSafetyDistance,
                 pushes->distance + (force - half_step) / gain - spec.radius);
  algo::ControlInput in;
  in.dt = spec.period;
  in.odometry = t.observation.odometry;
  in.scene = &t.scene;
  in.observation = &t.observation;
  in.goal = t.goal;
  in.spec = &spec;
  for (const double stamp : {6.63, 10.0}) {
    in.stamp = stamp;
    tick.controller->update(in, parameters, t.output);
  }
  return tick;
}

/// One of each sentence.
std::vector<Tick> ticks() {
  std::vector<Tick> out;
  const auto add = [&]() -> algo::Telemetry& {
    out.push_back({driving(), algo::builtin_controllers().at("modified").make()});
    return out.back().t;
  };
  for (const algo::Hold& hold : {algo::holds::kStopped,
                                 algo::holds::kBumper,
                                 algo::holds::kStaleScan,
                                 algo::holds::kNotFinite,
                                 algo::holds::kOverturned,
                                 algo::holds::kDazzled}) {
    add().hold = hold;
  }
  for (int halt = 1; halt <= static_cast<int>(algo::Halt::FloorFault); ++halt) {
    algo::Telemetry& t = add();
    t.hold = algo::holds::kHalted;
    t.observation.halt = static_cast<algo::Halt>(halt);
  }
  algo::Telemetry& stale = add();
  stale.hold = algo::holds::kStaleScan;
  stale.scene.scan.resize(1);
  stale.scene.scan.stamp = 9.27;
  algo::Telemetry& by_hand = add();
  by_hand.behaviour = algo::behaviours::kManual;
  by_hand.command = {{-0.253, 0.127}};
  add().goal.reset();
  algo::Telemetry& right_only = add();
  right_only.goal.reset();
  right_only.scene.left.reset();
  algo::Telemetry& in_the_open = add();
  in_the_open.goal.reset();
  in_the_open.scene.left.reset();
  in_the_open.scene.right.reset();
  add().mission = algo::Mission::Arrived;
  out.push_back(pushed("modified_c1", true, 0.4723));
  out.back().t.mission = algo::Mission::Stuck;
  add().mission = algo::Mission::Idle;
  for (const bool by_left : {true, false}) out.push_back(pushed("modified_c1", by_left, 0.2385));
  for (const double post_aside : {-0.1, 0.1}) {  // it passes the post on the other side
    for (const bool by_left : {true, false}) {
      out.push_back(pushed("modified", by_left, 0.2385, post_aside));
    }
  }
  for (Tick& tick : out) {
    algo::explain(tick.t, *tick.controller, tick.t.words);
    tick.t.words_fresh = tick.t.legend_fresh = true;
  }
  return out;
}

json golden() {
  json out = json::array();
  FrameEncoder encoder;
  for (const Tick& tick : ticks()) {
    std::string hex;
    constexpr const char* kDigits = "0123456789abcdef";
    for (const std::byte byte : encoder.encode(tick.t)) {
      hex += kDigits[std::to_integer<unsigned>(byte) >> 4U];
      hex += kDigits[std::to_integer<unsigned>(byte) & 15U];
    }
    out.push_back({{"frame", hex}, {"what", tick.t.words.what}, {"why", tick.t.words.why}});
  }
  return out;
}

TEST(Words, FramesAndSentencesAreAsTheGoldenFileSays) {
  const json now = golden();
  if (std::getenv("TAUTLINE_REWRITE_GOLDEN") != nullptr)
    std::ofstream(kFile) << now.dump(1) << '\n';
  std::ifstream file(kFile);
  ASSERT_TRUE(file) << kFile << " is missing; TAUTLINE_REWRITE_GOLDEN=1 writes it.";
  EXPECT_EQ(json::parse(file), now);
}

}  // namespace
}  // namespace server
