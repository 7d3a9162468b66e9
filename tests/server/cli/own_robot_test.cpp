// tests/server/cli/own_robot_test.cpp: the user's own robots on the command line.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/cli/parsed.hpp"
#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/cli/cli.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

using ::testing::HasSubstr;

constexpr const char* kCarrier = R"({
  "name": "carrier", "hull": {"length": 1.2, "width": 0.7}, "mass": 200, "track": 0.6,
  "wheel_radius": 0.1, "limits": {"speed": 0.8, "turn": 1.2}})";

/// A folder of the user's files in place of the real one.
class OwnRobotTest : public testing::Test {
 protected:
  OwnRobotTest() {
    ::setenv("XDG_STATE_HOME", folder_.path().c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    const std::filesystem::path robots = folder_.path() / "tautline" / "robots";
    make_folder(robots);
    write_text(robots / "carrier.json", kCarrier);
    write_text(world(), R"({"name": "near", "goal": {"x": 0.2, "y": 0}, "time_limit": 0.5,
                            "physics": "kinematic"})");
  }
  ~OwnRobotTest() override {
    ::unsetenv("XDG_STATE_HOME");  // NOLINT(concurrency-mt-unsafe)
  }
  std::filesystem::path world() const { return folder_.path() / "near.json"; }
  std::filesystem::path path(const char* name) const { return folder_.path() / name; }

  /// The sentence that refuses these arguments; else "status N".
  static std::string outcome(void (*add)(Command, int&), std::vector<std::string> arguments) {
    const tests::Parsed out = tests::parsed(add, std::move(arguments));
    return out.refusal.empty() ? "status " + std::to_string(out.status) : out.refusal;
  }

 private:
  tests::TemporaryFolder folder_{};
};

TEST_F(OwnRobotTest, ItIsFoundByItsNameWhereverARobotIsChosen) {
  EXPECT_THAT(outcome(add_run_command, {"run", world(), "--robot-model", "carrier"}),
              testing::StartsWith("status "));
  EXPECT_THAT(outcome(add_run_command, {"run", world(), "--robot-model", "tank"}),
              HasSubstr("'tank' is unknown; known are"));
  EXPECT_THAT(outcome(add_run_command, {"run", world(), "--robot-model", "tank"}),
              HasSubstr("carrier"));
  EXPECT_THAT(outcome(add_worlds_command, {"worlds", world(), "--robot-model", "tank"}),
              HasSubstr("carrier"));
}

TEST_F(OwnRobotTest, AnEmptyNameOfARobotIsRefused) {
  EXPECT_THAT(outcome(add_run_command, {"run", world(), "--robot-model", ""}),
              HasSubstr("--robot-model"));
}

TEST_F(OwnRobotTest, AFolderInPlaceOfAFileIsNamed) {
  make_folder(path("dir.json"));
  const std::string folder = path("dir.json").string() + " is a folder, not a file.";
  EXPECT_EQ(outcome(add_run_command, {"run", world(), "--robot-model", path("dir.json")}), folder);
  EXPECT_EQ(outcome(add_run_command, {"run", path("dir.json")}), folder);
  EXPECT_EQ(outcome(add_serve_command, {"serve", "--port", "0", "--scenario", path("dir.json")}),
            folder);
}

TEST_F(OwnRobotTest, AFolderOfRobotsThatIsNoneIsRefused) {
  EXPECT_THAT(outcome(add_serve_command, {"serve", "--port", "0", "--robots", path("nowhere")}),
              HasSubstr("--robots"));
  EXPECT_THAT(outcome(add_serve_command, {"serve", "--port", "0", "--robots", world()}),
              HasSubstr("--robots"));
}

/// Choices that only a simulated robot has are refused before any device is opened.
TEST_F(OwnRobotTest, RealHardwareRefusesTheChoicesOfASimulation) {
  using Choice = std::pair<const char*, const char*>;
  for (const auto& [option, value] : {Choice{"--physics", "kinematic"},
                                      {"--scenario", "case3"},
                                      {"--seed", "7"},
                                      {"--robot-model", "jackal"}}) {
    EXPECT_EQ(outcome(add_serve_command,
                      {"serve", "--port", "0", "--robot", path("none.toml"), option, value}),
              std::string(option) + ": cannot be chosen: this is real hardware");
  }
  EXPECT_THAT(outcome(add_serve_command, {"serve", "--port", "0", "--robot", path("none.toml")}),
              HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace server
