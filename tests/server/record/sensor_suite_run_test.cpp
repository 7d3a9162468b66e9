// tests/server/record/sensor_suite_run_test.cpp: whole runs of a robot with the Silvermate's
// sensors.
#include <string>

#include <gtest/gtest.h>

#include "server/record/headless.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/scenario_json.hpp"

namespace server {
namespace {

/// A low box on the way, under the laser's plane at 0.30 m.
constexpr const char* kLowBox =
    R"("obstacles":[{"type":"cylinder","x":2.5,"y":0.05,"radius":0.25,"height":0.15}],)";
constexpr const char* kInfrared = R"("infrared":[{"mount":{"x":0.3,"y":0}},)"
                                  R"({"mount":{"x":-0.3,"y":0,"heading":3.14159}}],)";
constexpr const char* kSuite =
    R"("lasers":[{"mount":{"x":0.2,"y":0}},{"mount":{"x":-0.2,"y":0,"heading":3.14159}}],)"
    R"("sonar":{},"gyro":{"bias":0.005,"noise":0.002},"bumpers":3,"localization":"gyro",)";

HeadlessResult run(const std::string& sensors, const char* controller, bool hash = false) {
  const std::string text = R"({"name":"low","vehicle":"kinematic","parameters":{"v_max":0.3},)" +
                           sensors + kLowBox + R"("goal":{"x":5,"y":0},"controller":")" +
                           controller + R"("})";
  const RunSpec spec = make_spec(scenario_from_json(nlohmann::json::parse(text)), {});
  const auto robot = make_robot(spec);
  return run_headless(spec, *robot, {.hash_frames = hash}, {});
}

TEST(SensorSuiteRun, TheInfraredScannerAvoidsWhatTheLaserMisses) {
  for (const char* controller : {"modified", "original_side", "strip"}) {
    EXPECT_NE(run("", controller).run.outcome, algo::Outcome::Reached) << controller;
    const HeadlessResult seen = run(kInfrared, controller);
    EXPECT_EQ(seen.run.outcome, algo::Outcome::Reached) << controller;
    EXPECT_GT(seen.run.metrics.min_clearance, 0.05) << controller;
  }
}

TEST(SensorSuiteRun, ARunWithAllSensorsIsRepeatable) {
  const std::string all = std::string(kInfrared) + kSuite;
  const HeadlessResult first = run(all, "modified", true);
  EXPECT_EQ(first.run.outcome, algo::Outcome::Reached) << first.run.reason;
  EXPECT_EQ(run(all, "modified", true).telemetry_hash, first.telemetry_hash);
}

}  // namespace
}  // namespace server
