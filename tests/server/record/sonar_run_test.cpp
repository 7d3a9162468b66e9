// tests/server/record/sonar_run_test.cpp: whole runs of a robot that has a sonar ring and no laser.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/record/headless.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/scenario_json.hpp"

namespace server {
namespace {

RunSpec by_sonar(const std::string& controller, const std::string& obstacles) {
  const std::string text =
      R"({"name":"ring","lasers":[],"sonar":{"count":24,"ping":0.01},"vehicle":"kinematic",)"
      R"("parameters":{"v_max":0.2},"goal":{"x":5,"y":0},"controller":")" +
      controller + R"(","obstacles":[)" + obstacles + "]}";
  return make_spec(scenario_from_json(nlohmann::json::parse(text)), {});
}

HeadlessResult run(const RunSpec& spec, bool hash = false) {
  const auto robot = make_robot(spec);
  return run_headless(spec, *robot, {.hash_frames = hash}, {});
}

constexpr const char* kPost = R"({"type":"cylinder","x":2.5,"y":0.45,"radius":0.3})";

TEST(SonarRun, TheControllersThatDriveBySonarPassAPost) {
  for (const char* controller : {"potential_field", "certainty_grid", "vff", "vfh"}) {
    const HeadlessResult result = run(by_sonar(controller, kPost));
    EXPECT_EQ(result.run.outcome, algo::Outcome::Reached) << controller;
  }
}

TEST(SonarRun, TheSameSeedGivesTheSameFrames) {
  EXPECT_EQ(run(by_sonar("vfh", kPost), true).telemetry_hash,
            run(by_sonar("vfh", kPost), true).telemetry_hash);
}

TEST(SonarRun, AControllerThatNeedsALaserIsRefused) {
  try {
    by_sonar("modified", kPost);
    FAIL() << "was accepted";
  } catch (const DocumentError& e) {
    EXPECT_THAT(e.what(),
                testing::StartsWith("controller: 'modified' needs a laser; with a sonar ring alone "
                                    "there are go_to_goal potential_field"));
  }
}

TEST(SonarRun, TheRecordedRobotHasNoLaser) {
  const RunSpec spec = by_sonar("vff", "");
  const auto robot = make_robot(spec);
  EXPECT_FALSE(robot->spec().has_laser);
  EXPECT_FALSE(robot_spec_from_json(to_json(robot->spec())).has_laser);
}

}  // namespace
}  // namespace server
