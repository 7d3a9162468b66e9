// tests/server/cli/sweep_test.cpp: the exit status of `tautline sweep` and what it prints.
#include <algorithm>
#include <string>
#include <vector>

#include "tests/temporary_folder.hpp"
#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/cli/cli.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class SweepCommandTest : public testing::Test {
 protected:
  /// Runs the command in the folder, and returns its standard output.
  std::string sweep(const std::string& document, const std::vector<std::string>& options = {}) {
    const std::filesystem::path file = folder_.path() / "document.json";
    write_text(file, document);
    CLI::App app;
    add_sweep_command(Command(app), status);
    std::vector<std::string> arguments{"sweep", file.string(), "--out", out().string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    std::ranges::reverse(arguments);  // CLI11 takes them from the end
    testing::internal::CaptureStdout();
    try {
      app.parse(arguments);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    return testing::internal::GetCapturedStdout();
  }
  /// Runs `tautline report` on the folder of the results.
  void report() {
    CLI::App app;
    add_report_command(Command(app), status);
    std::vector<std::string> arguments{out().string(), "report"};
    testing::internal::CaptureStdout();
    try {
      app.parse(arguments);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    testing::internal::GetCapturedStdout();
  }
  std::filesystem::path out() const { return folder_.path() / "out"; }
  int status = -1;

 private:
  tests::TemporaryFolder folder_{};
};

constexpr const char* kDocument = R"({"name": "near",
  "scenarios": [{"name": "near", "goal": {"x": 1, "y": 0}}],
  "controllers": ["go_to_goal"], "repeats": 2, "physics": "kinematic"})";

TEST_F(SweepCommandTest, LeavesItsFiles) {
  EXPECT_THAT(sweep(kDocument, {"--workers", "2"}), HasSubstr("2/2, 1.00 [0.34, 1.00]"));
  EXPECT_EQ(status, kReached);
  for (const char* const file : {"results.json",
                                 "runs.csv",
                                 "report.md",
                                 "report.tex",
                                 "report.html",
                                 "pictures/time_s.svg",
                                 "scenarios/near.json"}) {
    EXPECT_TRUE(std::filesystem::exists(out() / file)) << file;
  }
}

TEST_F(SweepCommandTest, ADryRunChecksAndWritesNothing) {
  EXPECT_THAT(sweep(kDocument, {"--dry-run"}), HasSubstr("runs      2\nCPU time  at most"));
  EXPECT_EQ(status, kReached);
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(SweepCommandTest, NamesTheFieldThatIsWrong) {
  EXPECT_THAT(
      [&] { sweep(R"({"name": "x", "repeats": 2})", {"--dry-run"}); },
      ThrowsMessage<std::runtime_error>(HasSubstr("document.json: controllers: is missing")));
  EXPECT_THAT([&] { sweep("{"); }, ThrowsMessage<std::runtime_error>(HasSubstr("document.json: ")));
}

TEST_F(SweepCommandTest, AReportIsWrittenAgainFromTheFinishedRuns) {
  sweep(kDocument);
  const std::string before = read_text(out() / "results.json");
  std::filesystem::remove(out() / "results.json");
  std::filesystem::remove(out() / "report.html");
  report();
  EXPECT_EQ(status, kReached);
  EXPECT_EQ(read_text(out() / "results.json"), before);
  EXPECT_TRUE(std::filesystem::exists(out() / "report.html"));
}

TEST_F(SweepCommandTest, AFolderOfAnotherDocumentIsRefusedWithTheOptionThatHelps) {
  sweep(kDocument);
  std::string other = kDocument;
  other.replace(other.find("\"repeats\": 2"), 12, "\"repeats\": 3");
  EXPECT_THAT([&] { sweep(other); },
              ThrowsMessage<std::runtime_error>(
                  HasSubstr("repeats is 2 there and 3 here. Choose another folder with --out")));
}

TEST_F(SweepCommandTest, TheExitStatusTellsMissingAndFailedRuns) {
  sweep(kDocument);
  const std::string log = read_text(out() / "runs.jsonl");
  const std::size_t last = log.find("{\"broken\"", log.find("{\"broken\"") + 1);
  ASSERT_NE(last, std::string::npos);
  write_text(out() / "runs.jsonl", log.substr(0, last));
  report();
  EXPECT_EQ(status, kIncomplete);
  write_text(
      out() / "runs.jsonl",
      log + R"({"run":1,"outcome":"failed","reason":"Lost.","broken":true,"figures":[]})" + "\n");
  report();
  EXPECT_EQ(status, kBadInput);
  EXPECT_THAT(read_text(out() / "report.md"), HasSubstr("0 are missing and 1 failed"));
}

TEST_F(SweepCommandTest, AFolderWithoutRunsHasNoReport) {
  make_folder(out());
  EXPECT_THAT([&] { report(); }, ThrowsMessage<std::runtime_error>(HasSubstr("runs.jsonl")));
  write_text(out() / "runs.jsonl", "{}\n");
  EXPECT_THAT([&] { report(); },
              ThrowsMessage<std::runtime_error>(HasSubstr("is no file of finished runs")));
}

}  // namespace
}  // namespace server
