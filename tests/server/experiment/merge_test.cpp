// tests/server/experiment/merge_test.cpp: shards make their own runs only, and together give the
// files of the whole.
#include "server/experiment/sweep/merge.hpp"

#include <memory>
#include <string>

#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/experiment/sweep/origin.hpp"
#include "server/experiment/sweep/sweep_report.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/run/text_file.hpp"

namespace server::sweep {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

json document(int repeats = 5) {
  return {{"name", "short"},
          {"scenarios", {{{"name", "free"}, {"goal", {{"x", 1}, {"y", 0.2}}}}}},
          {"controllers", {"original", "go_to_goal"}},
          {"repeats", repeats},
          {"physics", "kinematic"}};
}

Plan plan_of(const json& source) {
  return Plan(document_from_json(source, ScenarioLibrary("", "")));
}

class Merge : public testing::Test {
 protected:
  fs::path folder(const std::string& name) const { return root_.path() / name; }
  /// Runs shard `index` of 3.
  fs::path shard(std::size_t index) const {
    const fs::path made = folder("shard" + std::to_string(index));
    claim_for_shard(made, {index, 3});
    run_sweep(plan, made, {.threads = 1, .shard = {index, 3}});
    return made;
  }
  std::string files(const fs::path& made, const Rows& rows) const {
    write_report(plan, rows, results_of(plan, rows), made);
    return read_text(made / "results.json") + read_text(made / "runs.csv") +
           read_text(made / "report.md") + read_text(made / "report.html");
  }
  const Plan plan = plan_of(document());

 private:
  tests::TemporaryFolder root_{};
};

TEST_F(Merge, AShardMakesEveryThirdRunAndGoesOnWhereItStopped) {
  const fs::path made = shard(1);
  const std::string log = read_text(made / "runs.jsonl");
  Rows rows = rows_in(plan, made, made);
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows.has(i), i % 3 == 1) << i;
  const std::size_t last = log.rfind('\n', log.size() - 2) + 1;
  write_text(made / "runs.jsonl", log.substr(0, last + 5));  // torn in the last run
  shard(1);
  EXPECT_THAT(read_text(made / "runs.jsonl"), EndsWith(log.substr(last)));
  rows = rows_in(plan, made, made);
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows.has(i), i % 3 == 1) << i;
}

TEST_F(Merge, GivesTheFilesOfTheWholeAndDoesNothingTheSecondTime) {
  const std::string whole =
      files(folder("whole"), run_sweep(plan, folder("whole"), {.threads = 1}));
  const Merged first = merge_shards(plan, folder("out"), {shard(2), shard(0), shard(1)});
  EXPECT_EQ(first.added, 10U);
  EXPECT_TRUE(first.warnings.empty());
  EXPECT_EQ(files(folder("out"), first.rows), whole);
  const std::string log = read_text(folder("out") / "runs.jsonl");
  const Merged again = merge_shards(plan, folder("out"), {folder("shard0"), folder("shard1")});
  EXPECT_EQ(again.added, 0U);
  EXPECT_EQ(read_text(folder("out") / "runs.jsonl"), log);
}

TEST_F(Merge, MissingRunsHeadTheReport) {
  const Merged merged = merge_shards(plan, folder("out"), {shard(0), shard(2)});
  EXPECT_EQ(merged.added, 7U);  // 0 3 6 9 and 2 5 8
  files(folder("out"), merged.rows);
  EXPECT_THAT(read_text(folder("out") / "report.md"), HasSubstr("INCOMPLETE"));
  EXPECT_THAT(read_text(folder("out") / "report.md"), HasSubstr("3 are missing"));
}

TEST_F(Merge, NamesTheDifferenceOfAnotherDocumentOrVersion) {
  const fs::path other = folder("other");
  run_sweep(plan_of(document(6)), other, {.threads = 1});
  const auto merge = [&] { merge_shards(plan, folder("out"), {shard(0), other}); };
  EXPECT_THAT(merge, ThrowsMessage<std::runtime_error>(HasSubstr("repeats is 6 there and 5 here")));
  EXPECT_FALSE(fs::exists(folder("out")));
  std::string log = read_text(folder("shard0") / "runs.jsonl");
  const std::string version = "\"tautline\":\"";
  ASSERT_NE(log.find(version), std::string::npos);
  write_text(folder("shard0") / "runs.jsonl", log.insert(log.find(version) + version.size(), "9."));
  EXPECT_THAT([&] { merge_shards(plan, folder("out"), {folder("shard0")}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("tautline (the version) is \"9.")));
}

TEST_F(Merge, WarnsOfOtherMachinesAndOfRunsThatContradict) {
  const fs::path made = shard(0);
  const fs::path copy = folder("copy");
  make_folder(copy);
  std::string log = read_text(made / "runs.jsonl");
  const std::size_t at = log.find("\"reason\":\"");
  ASSERT_NE(at, std::string::npos);
  write_text(copy / "runs.jsonl", log.insert(at + 10, "Otherwise. "));
  write_origin({.machines = {{"Abacus 2", "glibc 1"}}}, copy);
  const Merged merged = merge_shards(plan, folder("out"), {made, copy});
  ASSERT_EQ(merged.warnings.size(), 2U);
  EXPECT_THAT(merged.warnings[0], HasSubstr("1 runs differ"));
  EXPECT_THAT(merged.warnings[1], HasSubstr("different processors"));
  EXPECT_THAT(merged.warnings[1], HasSubstr("'Abacus 2'"));
  EXPECT_EQ(read_origin(folder("out"))->machines.size(), 2U);
}

TEST_F(Merge, AFolderBelongsToOneShard) {
  const fs::path made = shard(0);
  EXPECT_THAT(
      [&] {
        claim_for_shard(made, {1, 3});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("holds shard 0/3 of an experiment")));
  EXPECT_THAT([&] { check_is_whole(made); },
              ThrowsMessage<std::runtime_error>(HasSubstr("Give --shard 0/3")));
  run_sweep(plan, folder("whole"), {.threads = 1});
  EXPECT_THAT(
      [&] {
        claim_for_shard(folder("whole"), {1, 3});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("a whole experiment")));
}

TEST(Machine, TheProcessorIsTheModelNameOfTheFirst) {
  EXPECT_EQ(processor_in("processor\t: 0\nmodel name\t: Abacus 2\nmodel name\t: 3\n"), "Abacus 2");
  EXPECT_EQ(processor_in("processor\t: 0\n"), "unknown");
  EXPECT_THAT(this_machine().mathematics, StartsWith("glibc "));
  EXPECT_EQ(this_machine(), this_machine());
}

}  // namespace
}  // namespace server::sweep
