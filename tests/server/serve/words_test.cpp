// tests/server/serve/words_test.cpp: the sentences of the server, and the frames from which the
// page forms the same ones: tests/golden/words.json, read by tests/web/explain.test.ts too.
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "tests/folders.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "algo/explain.hpp"
#include "server/record/frame_codec.hpp"

namespace server {
namespace {

using nlohmann::json;
const std::string kFile = (tests::folder() / "golden/words.json").string();

algo::Telemetry driving() {
  algo::Telemetry t;
  t.observation.stamp = 10.0;
  t.observation.odometry = {10.0, {0.25, -0.5, 0.5}, {}};
  t.goal = algo::SetGoal{{3.1, 4.2}, std::nullopt};
  t.mission = algo::Mission::Driving;
  t.behaviour = algo::BehaviourId::Avoid;
  t.scene.left = algo::Nearest{200, {1, 0.5}, 1.253};
  t.scene.right = algo::Nearest{100, {1, -0.5}, 1.127};
  t.output.strip.push_back({{0.25, -0.5}, {0, 0}, {0, 0}});
  t.output.strip.push_back({{0.5, 0}, {0, 0}, {0, 0}});
  return t;
}

/// One of each sentence.
std::vector<algo::Telemetry> ticks() {
  std::vector<algo::Telemetry> out;
  for (int hold = 1; hold <= static_cast<int>(algo::Hold::Dazzled); ++hold) {
    if (static_cast<algo::Hold>(hold) == algo::Hold::Halted) continue;
    out.push_back(driving());
    out.back().hold = static_cast<algo::Hold>(hold);
  }
  for (int halt = 1; halt <= static_cast<int>(algo::Halt::LateTick); ++halt) {
    out.push_back(driving());
    out.back().hold = algo::Hold::Halted;
    out.back().observation.halt = static_cast<algo::Halt>(halt);
  }
  out.push_back(driving());
  out.back().hold = algo::Hold::StaleScan;
  out.back().scene.scan.resize(1);
  out.back().scene.scan.stamp = 9.27;
  out.push_back(driving());
  out.back().behaviour = algo::BehaviourId::Manual;
  out.back().command = {{-0.253, 0.127}};
  out.push_back(driving());
  out.back().goal.reset();
  out.push_back(driving());
  out.back().goal.reset();
  out.back().scene.left.reset();
  out.push_back(driving());
  out.back().goal.reset();
  out.back().scene.left.reset();
  out.back().scene.right.reset();
  for (const auto mission : {algo::Mission::Arrived, algo::Mission::Stuck, algo::Mission::Idle}) {
    out.push_back(driving());
    out.back().mission = mission;
    out.back().output.elastic_W = {0.123, -0.456};
  }
  for (const auto side : {algo::Side::None, algo::Side::Left, algo::Side::Right}) {
    for (const bool by_left : {true, false}) {
      out.push_back(driving());
      algo::ControlOutput& o = out.back().output;
      (by_left ? o.external_left_W : o.external_right_W) = {-0.21, 0.113};
      o.side = side;
      o.side_since = 6.63;
    }
  }
  return out;
}

json golden() {
  json out = json::array();
  FrameEncoder encoder;
  for (const algo::Telemetry& t : ticks()) {
    const algo::Explanation words = algo::explain(t);
    std::string hex;
    constexpr const char* kDigits = "0123456789abcdef";
    for (const std::byte byte : encoder.encode(t)) {
      hex += kDigits[std::to_integer<unsigned>(byte) >> 4U];
      hex += kDigits[std::to_integer<unsigned>(byte) & 15U];
    }
    out.push_back({{"frame", hex}, {"what", words.what}, {"why", words.why}});
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
