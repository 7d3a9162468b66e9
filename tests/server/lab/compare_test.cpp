// tests/server/lab/compare_test.cpp: the scenes, the verdicts and one comparison
// from end to end.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "server/lab/compare/report.hpp"
#include "server/lab/reproduce/marked.hpp"

namespace server::compare {
namespace {

using algo::Outcome;
using algo::Vec2;
using experiment::Row;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

double nearest_surface(const std::vector<algo::Obstacle>& obstacles, const Vec2& p_W) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const algo::Obstacle& obstacle : obstacles) {
    nearest = std::min(nearest, signed_distance(obstacle, p_W));
  }
  return nearest;
}

// ---- the scenes --------------------------------------------------------------------------------

TEST(Bottleneck, GapsFromEightyCentimetresInStepsOfTwenty) {
  const std::vector<double> gaps = bottleneck_gaps();
  ASSERT_EQ(gaps.size(), 9U);
  EXPECT_DOUBLE_EQ(gaps.front(), 0.8);
  EXPECT_NEAR(gaps.back(), 2.4, 1e-12);
  EXPECT_EQ(bottleneck_name(gaps.front()), "gap-0800");
  EXPECT_EQ(bottleneck_name(gaps[2]), "gap-1200");  // 1.2000000000000002
}

TEST(Bottleneck, TheGapIsTheOnlyWay) {
  for (const double gap : bottleneck_gaps()) {
    const sim::Scenario scene = bottleneck(gap);
    const Vec2 goal = scene.goal->position_W;
    EXPECT_NEAR(nearest_surface(scene.obstacles, {goal.x() / 2, 0}), gap / 2, 1e-9);
    // Along the dividing wall everything except the gap lies within an obstacle.
    for (int mm = -4000; mm <= 4000; mm += 50) {
      const double y = mm / 1000.0;
      const double distance = nearest_surface(scene.obstacles, {goal.x() / 2, y});
      EXPECT_EQ(distance > 1e-9, std::abs(y) < gap / 2 - 1e-9) << gap << " at " << y;
    }
    for (const Vec2& place : {Vec2(0, 0), goal}) {
      EXPECT_GT(nearest_surface(scene.obstacles, place), 1.35);
    }
    // The hall has no door: a closed ring within the thickness of its walls is solid.
    for (int mm = -2000; mm <= 8000; mm += 50) {
      EXPECT_LT(nearest_surface(scene.obstacles, {mm / 1000.0, 4.1}), 0);
      EXPECT_LT(nearest_surface(scene.obstacles, {mm / 1000.0, -4.1}), 0);
    }
    for (int mm = -4000; mm <= 4000; mm += 50) {
      EXPECT_LT(nearest_surface(scene.obstacles, {-2.1, mm / 1000.0}), 0);
      EXPECT_LT(nearest_surface(scene.obstacles, {8.1, mm / 1000.0}), 0);
    }
  }
}

TEST(Contestants, ThoseThatCanAlsoDriveBySonar) {
  const std::vector<std::string> only{"vff", "strip"};
  std::vector<std::string> labels;
  for (const Contestant& each : contestants(only)) labels.push_back(label(each));
  EXPECT_THAT(labels, ElementsAre("strip", "vff", "vff by sonar"));
  const std::vector<std::string> unknown{"vfg"};
  EXPECT_THROW(contestants(unknown), std::runtime_error);
  for (const Contestant& each : contestants({})) {
    const RunSpec spec = make_run(bottleneck(1.0), each, 3);  // refuses laser controllers
    EXPECT_EQ(spec.scenario.robot.sensors.has_laser(), each.sensing == Sensing::Laser);
    EXPECT_EQ(spec.seed, 3U);
  }
}

TEST(CanonicalScenes, TheNineOfThePapers) {
  std::vector<std::string> names;
  for (const sim::Scenario& scene : canonical_scenes()) names.push_back(scene.name);
  EXPECT_THAT(
      names,
      ElementsAre("case1", "case2", "case3", "case4", "exp1", "exp2", "exp3", "exp4", "wall"));
}

// ---- the verdicts ------------------------------------------------------------------------------

/// A run of 100 s with `pauses` pauses of 0.5 s.
Row ended(Outcome outcome, double pauses = 0) {
  return {.outcome = outcome,
          .figures = {{"time_s", 100.0}, {"pauses", pauses}, {"pause_s", 0.5 * pauses}}};
}

Series row(const char* scene, const char* contestant, std::vector<Row> runs) {
  return {scene, contestant, std::move(runs)};
}

/// The bottlenecks of `contestant`, one run each: one letter per gap.
void add_bottlenecks(std::vector<Series>& rows, const char* contestant, std::string_view letters) {
  const std::vector<double> gaps = bottleneck_gaps();
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const Outcome outcome = letters[i] == 'r'   ? Outcome::Reached
                            : letters[i] == 's' ? Outcome::Stuck
                            : letters[i] == 't' ? Outcome::OutOfTime
                                                : Outcome::Collided;
    rows.push_back({bottleneck_name(gaps[i]), contestant, {ended(outcome)}});
  }
}

const Finding& about(const std::vector<Finding>& findings, const std::string& words) {
  for (const Finding& each : findings) {
    if (each.claim.find(words) != std::string::npos) return each;
  }
  throw std::runtime_error("no finding about " + words);
}

TEST(Passage, TheSmallestGapFromWhichAllAreReached) {
  std::vector<Series> rows;
  add_bottlenecks(rows, "vff", "srCtrrrrr");
  add_bottlenecks(rows, "vfh", "rrrrrrrrs");
  const Passage vff = passage_of(rows, "vff");
  ASSERT_TRUE(vff.smallest);
  EXPECT_NEAR(*vff.smallest, 1.6, 1e-9);  // 1.0 m was passed, but not 1.2 and 1.4
  EXPECT_EQ(vff.passed, 6U);
  EXPECT_EQ(vff.stuck, 1U);
  EXPECT_EQ(vff.out_of_time, 1U);
  EXPECT_EQ(vff.collided, 1U);
  ASSERT_EQ(vff.traps.size(), 2U);
  EXPECT_NEAR(vff.traps[1], 1.4, 1e-9);
  EXPECT_FALSE(passage_of(rows, "vfh").smallest);
  EXPECT_EQ(passage_of(rows, "dwa").runs, 0U);
}

TEST(Findings, BottlenecksTrapAControllerStuckAtSomeGapInEveryRun) {
  std::vector<Series> rows;
  add_bottlenecks(rows, "vff", "ssrrrrrrr");
  add_bottlenecks(rows, "vff by sonar", "ttrrrrrrr");
  add_bottlenecks(rows, "potential_field", "srrrrrrrr");
  add_bottlenecks(rows, "potential_field by sonar", "rrrrrrrrr");
  add_bottlenecks(rows, "edge_detection", "CCCrrrrrr");
  const std::vector<Finding> findings = judge({}, rows);
  ASSERT_EQ(findings.size(), 3U);  // no certainty grid, no worlds
  EXPECT_EQ(about(findings, "trap VFF").verdict, Verdict::Reproduced);
  EXPECT_THAT(about(findings, "trap VFF").because, HasSubstr("in every run at 0.8, 1.0 m"));
  EXPECT_EQ(about(findings, "trap the potential field").verdict, Verdict::InPart);
  EXPECT_EQ(about(findings, "trap edge detection").verdict, Verdict::NotReproduced);
  EXPECT_THAT(about(findings, "trap edge detection").because, HasSubstr("3 collided"));
}

struct PausingWorlds : ::testing::Test {
  std::vector<Series> rows{row("case1", "go_to_goal", {ended(Outcome::Collided)}),
                           row("case2", "go_to_goal", {ended(Outcome::Reached)}),
                           row("case1", "edge_detection", {ended(Outcome::Reached, 2)}),
                           row("case2", "edge_detection", {ended(Outcome::Reached, 0)}),
                           row("case1", "vff", {ended(Outcome::Reached, 1)}),
                           row("case2", "vff", {ended(Outcome::Reached)})};
  Verdict edge() { return about(judge(rows, {}), "Edge detection").verdict; }
  Verdict vff() { return about(judge(rows, {}), "VFF").verdict; }
};

TEST_F(PausingWorlds, EdgeDetectionStopsWhereItsPathIsBlocked) {
  EXPECT_EQ(edge(), Verdict::Reproduced);  // case2, where nothing is in the way, does not count
  rows[4].runs[0] = ended(Outcome::Reached, 3);
  EXPECT_EQ(edge(), Verdict::InPart);  // another one rests longer
  rows[4].runs[0] = ended(Outcome::Stuck, 3);
  EXPECT_EQ(edge(), Verdict::Reproduced);  // another claim covers trapped runs
  rows[2].runs[0] = ended(Outcome::Reached, 0);
  EXPECT_EQ(edge(), Verdict::NotReproduced);
}

TEST_F(PausingWorlds, VffDoesNotStopIfNoRunPausesOrSticks) {
  EXPECT_EQ(vff(), Verdict::InPart);
  rows[4].runs[0] = ended(Outcome::OutOfTime);
  EXPECT_EQ(vff(), Verdict::Reproduced);
  rows[4].runs[0] = ended(Outcome::Stuck);
  EXPECT_EQ(vff(), Verdict::InPart);
  rows[5].runs[0] = ended(Outcome::Reached, 1);
  EXPECT_EQ(vff(), Verdict::NotReproduced);
}

TEST(Findings, WithoutRunsThereIsNoVerdict) {
  EXPECT_TRUE(judge({}, {}).empty());
}

TEST(StripOnLayouts, NinetyNinePercentAndNoCollisionPass) {
  LayoutSet set;
  set.paper = {row("random-2-0001", "strip", std::vector<Row>(99, ended(Outcome::Reached))),
               row("random-2-0001", "original", {ended(Outcome::Collided)})};
  set.full = {row("random-2-0001", "strip", {ended(Outcome::Stuck)})};
  EXPECT_TRUE(strip_on_layouts({set}).held());
  EXPECT_EQ(strip_on_layouts({set}).runs, 100U);
  set.full[0].runs[0] = ended(Outcome::Collided);
  EXPECT_FALSE(strip_on_layouts({set}).held());
  set.full[0].runs.assign(2, ended(Outcome::OutOfTime));
  EXPECT_FALSE(strip_on_layouts({set}).held());
}

// ---- documents and the whole -------------------------------------------------------------------

TEST(Marked, OnlyTextBetweenTheMarksIsReplaced) {
  std::string text = "a <1> old <2> b";
  EXPECT_TRUE(reproduce::replace_marked(text, {"<1>", "<2>"}, "<1> new <2>"));
  EXPECT_EQ(text, "a <1> new <2> b");
  EXPECT_FALSE(reproduce::replace_marked(text, {"<3>", "<2>"}, ""));
  EXPECT_FALSE(reproduce::replace_marked(text, {"<1>", "<3>"}, ""));
  EXPECT_EQ(text, "a <1> new <2> b");
}

TEST(Compare, TheBlindOneFromEndToEnd) {
  Options options;
  options.seeds = 1;
  options.layouts = 1;
  options.layout_seeds = 1;
  options.only = {"go_to_goal"};
  options.worlds = false;
  options.judges = {"barn_score", "metrics"};
  options.threads = 2;
  const Comparison comparison = compare(options);
  EXPECT_THAT(comparison.labels, ElementsAre("go_to_goal", "go_to_goal by sonar"));
  // Straight through the middle of every gap.
  EXPECT_EQ(passage_of(comparison.bottlenecks, "go_to_goal").passed, 9U);
  ASSERT_EQ(comparison.layouts.size(), 3U);
  EXPECT_EQ(strip_on_layouts(comparison.layouts).runs, 6U);
  EXPECT_TRUE(strip_on_layouts(comparison.layouts).held());
  const nlohmann::json document = to_json(comparison);
  EXPECT_EQ(document["bottlenecks"].size(), 18U);
  EXPECT_EQ(document["random_layouts"][2]["obstacles"], 4);
  // A requested judge adds its columns, unless it is included already.
  EXPECT_GT(document["bottlenecks"][0]["metrics"]["barn_score"], 0.0);
  const experiment::Table rows = rows_table(comparison);
  EXPECT_EQ(rows.rows.size(), 18U);
  EXPECT_EQ(std::ranges::count(rows.header, "time_s"), 1);
  EXPECT_EQ(std::ranges::count(rows.header, "barn_time_s"), 1);

  const auto folder =
      std::filesystem::temp_directory_path() / ("tautline_compare_" + std::to_string(::getpid()));
  write_markdown(comparison, folder.string());
  std::ostringstream text;
  text << std::ifstream(folder / "comparison.md").rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("## Bottlenecks"));
  EXPECT_THAT(text.str(), HasSubstr("| go_to_goal by sonar | r |"));
  EXPECT_THAT(to_text(comparison), HasSubstr("4 obstacles, K_r 0.3"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace server::compare
