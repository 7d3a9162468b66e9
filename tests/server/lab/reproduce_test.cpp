// tests/server/lab/reproduce_test.cpp: the file, the limits and one scenario end to end.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "algo/driving.hpp"
#include "algo/strip/strip_law.hpp"
#include "server/lab/reproduce/conditions.hpp"
#include "server/lab/reproduce/full_strip.hpp"
#include "server/lab/reproduce/markdown.hpp"
#include "server/lab/reproduce/pictures.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/scenario_library.hpp"

namespace server::reproduce {
namespace {

using algo::Outcome;
using experiment::Row;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

json paper() {
  return json::parse(embedded_study());
}

/// The papers' conditions with one short scenario: 1 m to the goal, nothing in the way.
json short_file() {
  json file = paper();
  file["scenarios"] = json::array({{{"name", "free"},
                                    {"goal", {{"x", 1}, {"y", 0}}},
                                    {"parameters", {{"k_c", 0.8}, {"k_r", 0.6}, {"v_max", 0.2}}}}});
  file["limits"] = json::array();
  file["sweeps"] = json::array();
  return file;
}

std::string complaint(const json& file) {
  try {
    study_file_from_json(file);
  } catch (const DocumentError& e) {
    return e.what();
  }
  return "none";
}

std::string complaint_with(const char* pointer, const json& value) {
  json file = paper();
  file[json::json_pointer(pointer)] = value;
  return complaint(file);
}

// ---- the file ----------------------------------------------------------------------------------

TEST(StudyFile, TheEmbeddedOneIsRead) {
  const StudyFile file = embedded_study_file();
  EXPECT_EQ(file.scenarios.size(), 9u);
  EXPECT_DOUBLE_EQ(file.conditions.period, 0.05);
  ASSERT_TRUE(file.conditions.slow);
  EXPECT_DOUBLE_EQ(file.conditions.slow->v_max, 0.04);
  EXPECT_DOUBLE_EQ(file.conditions.slow->period, 0.1);
  EXPECT_DOUBLE_EQ(file.conditions.noise, 0.015);
  EXPECT_DOUBLE_EQ(file.conditions.range_max, 8.0);
  EXPECT_EQ(file.conditions.filter, "pseudomedian");
  EXPECT_EQ(file.conditions.filter_half_width, 1);
  EXPECT_DOUBLE_EQ(file.conditions.time_limit_factor, 5);
  const sim::Scenario& case3 = file.scenarios[2];
  EXPECT_EQ(case3.name, "case3");
  EXPECT_DOUBLE_EQ(case3.goal->position_W.x(), 5.0);
  EXPECT_DOUBLE_EQ(case3.parameters[algo::kRepulsionGain], 0.3);
  EXPECT_EQ(case3.obstacles.size(), 3u);
  EXPECT_EQ(file.limits.size(), 154u);
  const auto of_case3 = [](const Limit& limit) { return limit.scenario == "case3"; };
  EXPECT_EQ(std::ranges::count_if(file.limits, of_case3), 20);
  ASSERT_EQ(file.sweeps.size(), 4u);
  EXPECT_EQ(file.sweeps[1].parameter, &algo::kSafetyDistance);
  EXPECT_THAT(file.sweeps[1].values, ElementsAre(0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.2));
}

/// The nine scenes are also built in for the page: both definitions must give the same world.
TEST(StudyFile, ItsScenariosAreTheBuiltInOnes) {
  const ScenarioLibrary library("", "");
  for (const sim::Scenario& ours : embedded_study_file().scenarios) {
    const sim::Scenario built_in = library.load(ours.name);
    EXPECT_EQ(ours.obstacles, built_in.obstacles) << ours.name;
    EXPECT_EQ(ours.goal->position_W, built_in.goal->position_W) << ours.name;
    EXPECT_EQ(ours.start, built_in.start) << ours.name;
    EXPECT_EQ(ours.parameters, built_in.parameters) << ours.name;
  }
}

TEST(StudyFile, BecomesARunUnderThePapersConditions) {
  const StudyFile file = embedded_study_file();
  const RunSpec spec =
      make_run(file.conditions, file.scenarios[4], "original", kPaper, 7);  // exp1, 40 mm/s
  EXPECT_EQ(spec.scenario.physics, sim::PhysicsKind::Kinematic);
  EXPECT_DOUBLE_EQ(spec.scenario.period, 0.1);
  EXPECT_DOUBLE_EQ(spec.scenario.time_limit, 5 * 2.0 / 0.04);
  EXPECT_EQ(spec.seed, 7u);
  ASSERT_EQ(spec.scenario.robot.sensors.lasers.size(), 1u);
  const sim::LaserConfig& laser = spec.scenario.robot.sensors.lasers[0];
  EXPECT_FALSE(laser.rolling);
  EXPECT_EQ(laser.noise_shape, sim::NoiseShape::Uniform);
  EXPECT_DOUBLE_EQ(laser.noise, 0.015);
  EXPECT_EQ(laser.bias, 0);
  EXPECT_EQ(laser.dropout, 0);
  const RunSpec quiet = make_run(file.conditions, file.scenarios[0], "original", kNoiseFree, 1);
  EXPECT_EQ(quiet.scenario.robot.sensors.lasers[0].noise, 0);
  EXPECT_DOUBLE_EQ(quiet.scenario.period, 0.05);
  const RunSpec full = make_run(file.conditions, file.scenarios[0], "original", kFullSimulator, 1);
  EXPECT_EQ(full.scenario.physics, sim::PhysicsKind::Bullet);
  EXPECT_DOUBLE_EQ(full.scenario.period, 0.026);
  EXPECT_TRUE(full.scenario.robot.sensors.lasers[0].rolling);
}

TEST(StudyFile, AMalformedOneSaysWhere) {
  json file = paper();
  file["extra"] = 1;
  EXPECT_THAT(complaint(file), HasSubstr("unknown field 'extra'"));
  file = paper();
  file["scenarios"][1].erase("goal");
  EXPECT_EQ(complaint(file), "scenarios/1/goal: is missing");
  file = paper();
  file["scenarios"][1]["name"] = "case1";
  EXPECT_EQ(complaint(file), "scenarios/1/name: 'case1' is used twice");

  EXPECT_THAT(complaint_with("/scenarios/2/parameters/k_r", "much"),
              HasSubstr("scenarios/2: para"));
  EXPECT_THAT(complaint_with("/scenarios/0/obstacles/0/radius", -1), HasSubstr("obstacles/0"));
  EXPECT_THAT(complaint_with("/scenarios/0/obstacles/0/colour", "red"), HasSubstr("'colour'"));
  EXPECT_THAT(complaint_with("/scenarios/0/goal", {1, 2, 3}), HasSubstr("scenarios/0: goal"));
  EXPECT_THAT(complaint_with("/conditions/period", "fast"),
              HasSubstr("conditions/period: must be"));
  EXPECT_THAT(complaint_with("/conditions/period", 0.5),
              HasSubstr("conditions/period: is 0.5, must"));
  EXPECT_THAT(complaint_with("/conditions/filter", "soft"), HasSubstr("'soft' is unknown"));
  EXPECT_THAT(complaint_with("/scenarios", json::array()), HasSubstr("has no entries"));
  EXPECT_THAT(complaint_with("/limits/3/controller", "best"),
              HasSubstr("limits/3/controller: 'best' is no reading"));
  EXPECT_THAT(complaint_with("/limits/3/scenario", "case9"),
              HasSubstr("limits/3/scenario: no scenario"));
  EXPECT_THAT(complaint_with("/limits/2/figure", "speed"),
              HasSubstr("limits/2/figure: 'speed' is no column"));
  EXPECT_THAT(complaint_with("/limits/2/at_most", 1), HasSubstr("must have one of at_least"));
  EXPECT_THAT(complaint_with("/limits/2/outcome", "stuck"), HasSubstr("must be asked one of"));
  EXPECT_THAT(complaint_with("/limits/0/outcome", "lost"), HasSubstr("'lost' is unknown"));
  EXPECT_THAT(complaint_with("/sweeps/0/parameter", "beauty"), HasSubstr("'beauty' is unknown"));
  EXPECT_THAT(complaint_with("/sweeps/0/controllers/1", "best"),
              HasSubstr("sweeps/0/controllers/1: 'best' is no reading"));
  EXPECT_THAT(complaint_with("/sweeps/0/values", {1}), HasSubstr("sweeps/0/values: must be two"));
}

TEST(StudyFile, AnInvalidScenarioIsReportedBeforeAnyRun) {
  json overlapping = paper();
  overlapping["scenarios"][1]["obstacles"][0] = {
      {"id", 1}, {"type", "cylinder"}, {"x", 0.3}, {"y", 0}, {"radius", 0.1}};
  EXPECT_THAT(
      [&] { check_scenarios(study_file_from_json(overlapping)); },
      ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("scenarios/1 (case2): Obstacle 1")));
  StudyFile unsafe = embedded_study_file();
  unsafe.conditions.safety_distance = 0.3;  // S = 0.2 > K_r d_safe = 0.18
  EXPECT_THAT([&] { check_scenarios(unsafe); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("strip_step")));
}

Row run_of(Outcome outcome, double time, double path, double clearance, double depth) {
  return {.outcome = outcome,
          .figures = {{"time_s", time},
                      {"path_m", path},
                      {"min_clearance_m", clearance},
                      {"safety_depth_m", depth},
                      {"turning_rad", 0.0},
                      {"bending_rad2_per_m", 0.0}}};
}

void set(Row& run, std::string_view column, double value) {
  for (auto& [name, figure] : run.figures) {
    if (name == column) figure = value;
  }
}

Series two_runs(const char* reading) {
  return {
      "case1",
      reading,
      {run_of(Outcome::Reached, 10, 4.0, 0.70, 0.01), run_of(Outcome::Stuck, 20, 5.0, 0.60, 0.05)}};
}

// ---- the limits --------------------------------------------------------------------------------

TEST(Accept, AFailedLimitIsReportedWithItsFigure) {
  const auto asked = [](Limit limit) {
    limit.scenario = "case1";
    limit.controller = "modified";
    return limit;
  };
  StudyFile file;
  file.limits = {asked({.outcome = Outcome::Reached}),
                 asked({.collisions = 0}),
                 asked({.figure = "path_m", .at_most = 4.5}),
                 asked({.figure = "path_m", .at_most = 4.499}),
                 asked({.figure = "min_clearance_m", .at_least = 0.6}),
                 asked({.figure = "min_clearance_m", .at_least = 0.601}),
                 asked({.noise_free = true, .outcome = Outcome::Reached})};
  const std::vector<Series> rows{two_runs("modified")};
  const std::vector<Check> checks = evaluate(file, rows, {});
  ASSERT_EQ(checks.size(), 7u);
  EXPECT_FALSE(checks[0].held);  // one of two is stuck
  EXPECT_EQ(checks[0].figure, "1 reached, 1 stuck");
  EXPECT_TRUE(checks[1].held);
  EXPECT_TRUE(checks[2].held);
  EXPECT_FALSE(checks[3].held);
  EXPECT_EQ(checks[3].asked, "path_mm at most 4499");
  EXPECT_EQ(checks[3].figure, "4500");
  EXPECT_TRUE(checks[4].held);
  EXPECT_FALSE(checks[5].held);
  EXPECT_FALSE(checks[6].held);  // there is no run without noise
  EXPECT_EQ(checks[6].subject, "modified, noise-free");
  EXPECT_FALSE(all_held(checks));
}

TEST(Accept, AComparisonIsStrict) {
  StudyFile file;
  file.limits = {
      {.scenario = "case1", .controller = "modified", .figure = "time_s", .below = "original"}};
  std::vector<Series> rows{two_runs("modified"), two_runs("original")};
  EXPECT_FALSE(all_held(evaluate(file, rows, {})));  // equal is not lower
  set(rows[1].runs[0], "time_s", 10.1);
  EXPECT_TRUE(all_held(evaluate(file, rows, {})));
  EXPECT_EQ(evaluate(file, rows, {})[0].subject, "modified < original");
  rows.pop_back();
  EXPECT_FALSE(all_held(evaluate(file, rows, {})));  // no rows to compare with
}

TEST(Claims, OnlyWithOurExtensionWhenNoPrintedReadingHolds) {
  const auto row = [](const char* reading, Outcome outcome) {
    return Series{"case1", reading, {run_of(outcome, 1, 1, 1, 0)}};
  };
  std::vector<Series> rows{row("original", Outcome::Stuck),
                           row("modified_published", Outcome::Stuck),
                           row("modified_linear", Outcome::Stuck),
                           row("modified_c1", Outcome::Stuck),
                           row("modified", Outcome::Reached)};
  std::vector<Claim> claims = judge_claims(rows);
  ASSERT_EQ(claims.size(), 1u);
  EXPECT_EQ(claims[0].verdict, Verdict::OnlyWithExtension);
  EXPECT_THAT(claims[0].held_by, ElementsAre("modified"));
  rows[1].runs[0].outcome = Outcome::Reached;
  EXPECT_EQ(judge_claims(rows)[0].verdict, Verdict::Reproduced);
  rows[0].runs[0].outcome = Outcome::Reached;  // the original is not stuck: no claim holds
  EXPECT_EQ(judge_claims(rows)[0].verdict, Verdict::NotReproduced);
}

/// exp1's goal is 773 mm from the cylinder, and a run may end 100 mm beyond it.
TEST(FullStrip, IntrusionDueToTheGoalIsReportedApart) {
  const Depths least = least_depths(embedded_study_file());
  EXPECT_NEAR(least.at("exp1"), 0.127, 0.001);
  EXPECT_EQ(least.at("case1"), 0);
  const Series row{"exp1", "strip", {run_of(Outcome::Reached, 1, 1, 1, 0.159)}};
  EXPECT_THAT(strip_sentences(strip_beside({&row, 1}, {}, least)),
              HasSubstr("exp1 by 159 mm (127 mm at least"));
}

TEST(FullStrip, IsComparedWithTheReadingsThatReach) {
  const auto row = [](const char* reading, Outcome outcome, double turning, double time) {
    Series made{"case1", reading, {run_of(outcome, time, 1, 1, 0)}};
    set(made.runs[0], "turning_rad", turning);
    set(made.runs[0], "bending_rad2_per_m", turning);
    return made;
  };
  std::vector<Series> strip{row("strip", Outcome::Reached, 2, 50)};
  const std::vector<Series> readings{row("original", Outcome::Stuck, 0, 10),
                                     row("modified", Outcome::Reached, 3, 80),
                                     row("via_kept", Outcome::Reached, 1, 50)};
  const StripBeside beside = strip_beside(strip, readings);
  EXPECT_EQ(beside.rows, 2u);
  EXPECT_THAT(beside.turns_less, ElementsAre("case1 via_kept"));
  EXPECT_THAT(beside.faster, ElementsAre("case1 via_kept"));  // equal is not faster
  EXPECT_THAT(strip_sentences(beside), HasSubstr("turns less in 1 of 2 (not: case1 via_kept)"));
  EXPECT_EQ(strip_table(strip, readings).rows[0][2], "1 stuck");
  strip[0].runs[0].outcome = Outcome::Collided;
  EXPECT_EQ(strip_beside(strip, readings).rows, 0u);
  EXPECT_THAT(strip_sentences(strip_beside(strip, readings)), HasSubstr("every run: case1"));
}

TEST(Sweeps, RisingAllowsNoisePerStepButNeedsATotalRise) {
  EXPECT_TRUE(rises({100, 110, 200}, 15));
  EXPECT_TRUE(rises({100, 90, 200}, 15));
  EXPECT_FALSE(rises({100, 80, 200}, 15));
  EXPECT_FALSE(rises({100, 105, 110}, 15));
  EXPECT_FALSE(rises({}, 15));
}

// ---- end to end --------------------------------------------------------------------------------

TEST(Study, OneScenarioEndToEnd) {
  json file = short_file();
  const auto asked = [](const char* controller, json limit) {
    limit["scenario"] = "free";
    limit["controller"] = controller;
    return limit;
  };
  file["limits"] = {asked("modified", {{"outcome", "reached"}}),
                    asked("modified", {{"collisions", 0}}),
                    asked("modified", {{"figure", "time_s"}, {"at_most", 6}}),
                    asked("modified", {{"figure", "path_m"}, {"at_most", 1}}),
                    asked("original", {{"outcome", "reached"}, {"noise_free", true}})};
  const StudyFile read = study_file_from_json(file);
  Study study = run_study(read, {.seeds = 2, .full_simulator = true, .threads = 2});
  EXPECT_EQ(study.paper.size(), readings().size());
  EXPECT_EQ(study.noise_free.size(), readings().size());
  EXPECT_EQ(study.full.size(), readings().size());
  ASSERT_EQ(study.strip.size(), 1u);
  EXPECT_EQ(outcomes_text(study.strip[0]), "2 reached");
  EXPECT_EQ(study.strip_full.size(), 1u);
  EXPECT_EQ(study.checks.size(), 5u);
  EXPECT_TRUE(all_held(study.checks)) << to_text(study);
  const Series& modified = *find_series(study.paper, "free", "modified");
  EXPECT_EQ(outcomes_text(modified), "2 reached");
  // Straight on at 200 mm/s until within 100 mm of 1000 mm, in steps of 10 mm; slower within S.
  EXPECT_NEAR(modified.runs[0]["path_m"], 0.905, 0.01);
  EXPECT_GT(modified.runs[0].track_W.size(), 80u);
  EXPECT_TRUE(modified.runs[1].track_W.empty());
  EXPECT_TRUE(to_json(study)["paper_conditions"][0]["metrics"]["min_clearance_m"].is_null());

  file["limits"][3]["at_most"] = 0.1;
  study.checks = evaluate(study_file_from_json(file), study.paper, study.noise_free);
  EXPECT_FALSE(all_held(study.checks));
  EXPECT_THAT(to_text(study), HasSubstr("FAILED"));
}

TEST(Study, DoesNotDependOnTheNumberOfThreads) {
  json file = paper();
  file["scenarios"] = json::array({file["scenarios"][4]});  // exp1
  file["limits"] = json::array();
  const StudyFile read = study_file_from_json(file);
  const auto text = [&](unsigned threads) {
    return to_json(run_study(read, {.seeds = 2, .full_simulator = false, .threads = threads}))
        .dump();
  };
  EXPECT_EQ(text(1), text(3));
}

TEST(Markdown, WritesTheDocumentAndAPictureOfEachLayout) {
  const StudyFile file = study_file_from_json(short_file());
  const Study study = run_study(file, {.seeds = 1, .full_simulator = false});
  const auto folder =
      std::filesystem::temp_directory_path() / ("tautline_reproduce_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::vector<Section> sections = study_sections(file, study, kPictures);
  sections.push_back({"A further study", "With its own words.\n"});
  write_reproduction((folder / "reproduction.md").string(), file, study, sections);
  const auto content = [](const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  };
  const std::string document = content(folder / "reproduction.md");
  EXPECT_THAT(document, HasSubstr("## Table A: paper conditions"));
  EXPECT_THAT(document, HasSubstr("## A further study\n\nWith its own words.\n"));
  EXPECT_THAT(document, HasSubstr("(pictures/reproduction/free.svg)"));
  const std::string picture = content(folder / kPictures / "free.svg");
  EXPECT_THAT(picture, HasSubstr("<svg xmlns="));
  EXPECT_THAT(picture, HasSubstr("modified: reached"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace server::reproduce
