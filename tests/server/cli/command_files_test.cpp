// tests/server/cli/command_files_test.cpp: what the commands refuse before they begin.
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/cli/parsed.hpp"
#include "tests/temporary_folder.hpp"
#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/cli/cli.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class CommandFilesTest : public testing::Test {
 protected:
  /// The sentence that refuses these arguments, the first of which is the command; else empty.
  static std::string refusal(void (*add)(Command, int&), std::vector<std::string> arguments) {
    return tests::parsed(add, std::move(arguments)).refusal;
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

 private:
  tests::TemporaryFolder folder_{};
};

TEST_F(CommandFilesTest, AnOutputThatCannotBeWrittenIsRefusedAtOnce) {
  const std::string nowhere = path("none/out.csv");
  // No input exists: the sentence about the output comes before any about the input.
  EXPECT_THAT(refusal(add_crowd_command, {"crowd", "x", "--tracks", nowhere}), HasSubstr(nowhere));
  EXPECT_THAT(refusal(add_buildings_command, {"buildings", "--rows", nowhere}), HasSubstr(nowhere));
  EXPECT_THAT(refusal(add_barn_command, {"barn", "x", "--rows", nowhere}), HasSubstr(nowhere));
  EXPECT_THAT(refusal(add_locate_command, {"locate", "x", "--poses", nowhere}), HasSubstr(nowhere));
  for (const char* option : {"--out", "--poses", "--map"}) {
    EXPECT_THAT(refusal(add_map_command, {"map", "x", option, nowhere}), HasSubstr(nowhere));
  }
  EXPECT_THAT(refusal(add_export_command, {"export", "1", "-o", nowhere}), HasSubstr(nowhere));
}

TEST_F(CommandFilesTest, AnExportThatFailsKeepsTheOldFile) {
  write_text(path("old.csv"), "kept");
  EXPECT_NE(
      refusal(add_export_command, {"export", "1", "--db", path("no.db"), "-o", path("old.csv")}),
      "");
  EXPECT_EQ(read_text(path("old.csv")), "kept");
}

TEST_F(CommandFilesTest, AnOutputThatWouldOverwriteAnInputIsRefused) {
  write_text(path("in.log"), "kept");
  const std::string in = path("in.log");
  const std::string out = path("out.csv");
  const auto shared = HasSubstr("are one file");
  EXPECT_THAT(refusal(add_map_command, {"map", in, "--poses", in}), shared);
  EXPECT_THAT(refusal(add_map_command, {"map", in, "--map", out, "--out", out}), shared);
  EXPECT_THAT(
      refusal(add_map_command, {"map", in, "--map", path("a.yaml"), "--out", path("a.pgm")}),
      shared);
  EXPECT_THAT(refusal(add_map_command, {"map", in, "--map", path("a.pgm")}), HasSubstr("picture"));
  EXPECT_THAT(refusal(add_crowd_command, {"crowd", in, "--tracks", in}), shared);
  EXPECT_THAT(refusal(add_locate_command, {"locate", in, "--poses", in}), shared);
  write_text(path("in.json"), "kept");
  EXPECT_THAT(refusal(add_barn_command, {"barn", path("in.json"), "--rows", path("in.json")}),
              shared);
  for (const char* journal : {"", "-wal"}) {
    const std::string output = in + journal;
    EXPECT_THAT(refusal(add_export_command, {"export", "1", "--db", in, "-o", output}), shared);
  }
  for (const char* input : {"--log", "--scenario"}) {
    EXPECT_THAT(refusal(add_emulate_command,
                        {"emulate", "lms200", "--link", path("port"), input, in, "--record", in}),
                shared);
  }
  EXPECT_EQ(read_text(in), "kept");
  EXPECT_EQ(read_text(path("in.json")), "kept");
}

TEST_F(CommandFilesTest, ALogMayHaveAnyName) {
  const std::string scan = "FLASER 3 1.0 1.0 1.0 0 0 0 0 0 0 ";
  write_text(path("lab"), scan + "1.0 lab 1.0\n" + scan + "1.1 lab 1.1\n");
  const tests::Parsed replay = tests::parsed(add_replay_command, {"replay", path("lab")});
  EXPECT_EQ(replay.refusal, "");
  EXPECT_EQ(replay.status, kReached);
  write_text(path("world.json"), "{}");
  EXPECT_THAT(refusal(add_replay_command, {"replay", path("world.json")}),
              HasSubstr("holds no scan"));
}

TEST_F(CommandFilesTest, LinesOfALogThatAreLeftOutAreSaid) {
  write_text(path("lab.log"),
             "FLASER 3 1 1 1 0 0 0 0 0 0 1.0 lab 1.0\nFLASER 3 nan 1 1 0 0 0 0 0 0 1.1 lab 1.1\n");
  const auto said =
      HasSubstr(path("lab.log") + " has lines that were left out: 1 unreadable (line 2: ");
  testing::internal::CaptureStderr();
  EXPECT_EQ(refusal(add_replay_command, {"replay", path("lab.log")}), "");
  EXPECT_THAT(testing::internal::GetCapturedStderr(), said);
  testing::internal::CaptureStderr();
  EXPECT_EQ(refusal(add_map_command, {"map", path("lab.log")}), "");
  EXPECT_THAT(testing::internal::GetCapturedStderr(), said);
}

TEST_F(CommandFilesTest, ARecordingMayBeNamedAsAScenario) {
  write_text(path("people"), "0 1 0 0\n100 1 5 5\n");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(std::filesystem::path(path("people")).parent_path());
  EXPECT_EQ(refusal(add_crowd_command, {"crowd", "people", "--scenario", "crowd.json"}), "");
  std::filesystem::current_path(before);
  EXPECT_TRUE(std::filesystem::exists(path("crowd.json")));
}

TEST_F(CommandFilesTest, AStudyThatCannotWriteItsFilesIsPrintedAllTheSame) {
  std::filesystem::create_symlink("/dev/full", path("rows.csv"));
  CLI::App app;
  int status = -1;
  add_soak_command(Command(app), status);
  testing::internal::CaptureStdout();
  std::string why;
  try {
    app.parse("soak --worlds 1 --slopes --seconds 1 --rows " + path("rows.csv"));
  } catch (const std::runtime_error& e) {
    why = e.what();
  }
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("overturned"));
  EXPECT_EQ(why, path("rows.csv") + ": cannot be written: No space left on device");
}

TEST_F(CommandFilesTest, AnOptionWithoutEffectIsRefused) {
  for (const char* option : {"--poses", "--map", "--out", "--markdown"}) {
    EXPECT_THAT(
        refusal(add_map_command, {"map", "--simulate", path("a.log"), option, path("b.yaml")}),
        AllOf(HasSubstr("--simulate"), HasSubstr(option)));
  }
  EXPECT_THAT(refusal(add_map_command, {"map", "--simulate", path("a.log"), "--json"}),
              HasSubstr("--json"));
  EXPECT_FALSE(std::filesystem::exists(path("a.log")));
  EXPECT_THAT(refusal(add_locate_command, {"locate", "x", "--markdown", path("x.md")}),
              AllOf(HasSubstr("--markdown"), HasSubstr("--study")));
  EXPECT_THAT(refusal(add_locate_command, {"locate", "x", "--study"}), HasSubstr("LOG"));
  const auto soak = [](std::vector<std::string> options) {
    options.insert(options.begin(), {"soak", "--worlds", "1"});
    return refusal(add_soak_command, options);
  };
  EXPECT_THAT(soak({"--slopes", "--controller", "dwa"}), HasSubstr("--controller"));
  EXPECT_THAT(soak({"--courses", "--list"}), HasSubstr("--list"));
  EXPECT_THAT(soak({"--physics", "kinematic"}), HasSubstr("--operator"));
  EXPECT_THAT(soak({"--robot", "jackal"}), HasSubstr("--operator"));
  EXPECT_THAT(soak({"--seconds", "5"}), HasSubstr("--operator"));
  EXPECT_THAT(soak({"--scenario", path("s.json"), "--rows", path("r.csv")}), HasSubstr("--rows"));
  EXPECT_THAT(
      refusal(add_barn_command, {"barn", "x", "--scenarios", path("s"), "--rows", path("r.csv")}),
      HasSubstr("--rows"));
  EXPECT_THAT(
      refusal(add_buildings_command, {"buildings", "--tour", "3", "--scenario", path("s.json")}),
      HasSubstr("--tour"));
  EXPECT_THAT(refusal(add_reproduce_command,
                      {"reproduce", "--arm", "--reaches", "1", "--markdown", path("x.md")}),
              HasSubstr("--markdown"));
}

TEST_F(CommandFilesTest, ASeedThatTheStoreCannotKeepIsRefused) {
  const auto run = [&](const char* seed) {
    return refusal(add_run_command, {"run", "case1", "--seed", seed, "--out", path("runs.db")});
  };
  EXPECT_EQ(run("9007199254740992"), "seed: is 9007199254740992, must be at most 9007199254740991");
  EXPECT_THAT(run("99999999999999999999"), HasSubstr("99999999999999999999 must be from 0 to"));
  EXPECT_THAT(refusal(add_export_command, {"export", "99999999999999999999"}),
              HasSubstr("99999999999999999999 must be from"));
  EXPECT_FALSE(std::filesystem::exists(path("runs.db")));
}

TEST_F(CommandFilesTest, APasswordThatNoScannerHasIsRefused) {
  EXPECT_THAT(
      refusal(add_emulate_command, {"emulate", "robot", "--links", path("l"), "--password", "abc"}),
      HasSubstr("8 characters"));
}

TEST_F(CommandFilesTest, ACommandThatSelectsNothingIsRefused) {
  const auto buildings = [](std::vector<std::string> options) {
    options.insert(options.begin(), "buildings");
    return refusal(add_buildings_command, options);
  };
  EXPECT_EQ(buildings({"--seeds", "1-1", "--kinds", "maze"}), "These options select no buildings.");
  EXPECT_EQ(buildings({"--tour", "3", "--seeds", "6-6", "--kinds", "flat"}),
            "These options select no tours.");
  EXPECT_THAT(buildings({"--seeds", "1-1", "--shard", "1/2"}),
              HasSubstr("is empty: the number of buildings is 1"));
  EXPECT_THAT(buildings({"--seeds", "1-1", "--kinds", "maze", "--scenario", path("s.json")}),
              HasSubstr("no building"));
  EXPECT_FALSE(std::filesystem::exists(path("s.json")));
}

}  // namespace
}  // namespace server
