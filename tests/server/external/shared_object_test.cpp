// tests/server/external/shared_object_test.cpp: docs/examples/go_to_goal.cpp, built as a shared
// object, drives as docs/examples/go_to_goal.py does.
#include "server/external/shared_object.hpp"

#include "tests/server/external/own.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace server::external {
namespace {

Registration example_object() {
  return {.name = "mine", .command = TAUTLINE_EXAMPLE_CONTROLLER};
}

TEST(SharedObject, DrivesTheSameWayEachTimeAndAsThePythonExample) {
  const auto catalogue = catalogue_of(example_object());
  for (const char* scenario : {"case1", "case3"}) {
    const HeadlessResult first = drive(spec_of(catalogue, scenario));
    EXPECT_EQ(drive(spec_of(catalogue, scenario)).telemetry_hash, first.telemetry_hash);
    const auto python = catalogue_of({.name = "mine", .command = example("go_to_goal.py")});
    const HeadlessResult other = drive(spec_of(python, scenario));
    EXPECT_NE(first.run.outcome, algo::Outcome::Failed) << first.run.reason;
    EXPECT_EQ(other.run.outcome, first.run.outcome) << other.run.reason;
    EXPECT_NEAR(other.run.metrics.path_length, first.run.metrics.path_length, 1e-6);
  }
}

TEST(SharedObject, ShowsItsLayerAndWords) {
  const RunSpec spec = spec_of(catalogue_of(example_object()));
  const auto robot = make_robot(spec);
  HeadlessOptions options;
  std::string words;
  std::size_t lines = 0;
  options.watch = [&](const algo::Telemetry& t) {
    words = t.words.what;
    for (const algo::Layer& layer : t.output.layers) lines += layer.name == "mine.line" ? 1U : 0U;
    const bool over = t.tick == 50;  // by then a scan has come and the words tell of the drive
    return over ? std::optional<Ending>({.outcome = algo::Outcome::Stopped}) : std::nullopt;
  };
  run_headless(spec, *robot, options, {});
  EXPECT_EQ(words, "Driving straight to the goal");
  EXPECT_EQ(lines, 51U);
}

TEST(SharedObject, RefusesAnotherLibrary) {
  EXPECT_THAT([] { SharedObjectSource("mine", "libm.so.6"); },
              ::testing::ThrowsMessage<ControllerError>(
                  ::testing::HasSubstr("lacks the function tautline_controller_version")));
}

}  // namespace
}  // namespace server::external
