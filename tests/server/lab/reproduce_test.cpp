// tests/server/lab/reproduce_test.cpp: the file, the figures, the limits and one scenario end to
// end.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "server/experiment/svg_plot.hpp"
#include "server/lab/reproduce/conditions.hpp"
#include "server/lab/reproduce/full_strip.hpp"
#include "server/lab/reproduce/markdown.hpp"
#include "server/lab/reproduce/pictures.hpp"
#include "server/lab/reproduce/triangulate.hpp"
#include "server/run/json_reader.hpp"

namespace server::reproduce {
namespace {

using algo::Outcome;
using nlohmann::json;
using ::testing::HasSubstr;

json paper() {
  return json::parse(embedded_paper());
}

/// The paper's conditions with one short layout: 1 m to the goal, nothing in the way.
json short_file() {
  json file = paper();
  file["scenarios"] = json::array({{{"name", "free"},
                                    {"goal", {1000, 0}},
                                    {"K_c", 0.8},
                                    {"K_r", 0.6},
                                    {"v_max", 200},
                                    {"obstacles", json::array()}}});
  return file;
}

std::string complaint(const json& file) {
  try {
    paper_file_from_json(file);
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

TEST(PaperFile, TheEmbeddedOneIsReadInSi) {
  const PaperFile file = embedded_paper_file();
  EXPECT_EQ(file.layouts.size(), 9u);
  EXPECT_DOUBLE_EQ(file.common.period, 0.05);
  ASSERT_TRUE(file.common.slow);
  EXPECT_DOUBLE_EQ(file.common.slow->v_max, 0.04);
  EXPECT_DOUBLE_EQ(file.common.slow->period, 0.1);
  EXPECT_DOUBLE_EQ(file.common.noise, 0.015);
  EXPECT_DOUBLE_EQ(file.common.range_max, 8.0);
  EXPECT_EQ(file.common.filter, "pseudomedian");
  EXPECT_EQ(file.common.filter_half_width, 1);
  EXPECT_DOUBLE_EQ(file.common.time_limit_factor, 5);
  const Layout& case3 = file.layouts[2];
  EXPECT_EQ(case3.name, "case3");
  EXPECT_DOUBLE_EQ(case3.goal_W.x(), 5.0);
  EXPECT_DOUBLE_EQ(case3.repulsion_gain, 0.3);
  EXPECT_EQ(case3.obstacles.size(), 3u);
  EXPECT_EQ(case3.accept.size(), 3u);
  EXPECT_EQ(case3.accept_compare.size(), 3u);
}

TEST(PaperFile, BecomesARunUnderThePapersConditions) {
  const PaperFile file = embedded_paper_file();
  const RunSpec spec = make_run(file, file.layouts[4], "original", kPaper, 7);  // exp1, 40 mm/s
  EXPECT_EQ(spec.scenario.vehicle, sim::Vehicle::Kinematic);
  EXPECT_DOUBLE_EQ(spec.scenario.period, 0.1);
  EXPECT_DOUBLE_EQ(spec.scenario.time_limit, 5 * 2.0 / 0.04);
  EXPECT_EQ(spec.seed, 7u);
  ASSERT_EQ(spec.scenario.lasers.size(), 1u);
  const sim::LaserConfig& laser = spec.scenario.lasers[0];
  EXPECT_FALSE(laser.rolling);
  EXPECT_EQ(laser.noise_shape, sim::NoiseShape::Uniform);
  EXPECT_DOUBLE_EQ(laser.noise, 0.015);
  EXPECT_EQ(laser.bias, 0);
  EXPECT_EQ(laser.dropout, 0);
  const RunSpec quiet = make_run(file, file.layouts[0], "original", kNoiseFree, 1);
  EXPECT_EQ(quiet.scenario.lasers[0].noise, 0);
  EXPECT_DOUBLE_EQ(quiet.scenario.period, 0.05);
  const RunSpec full = make_run(file, file.layouts[0], "original", kFullSimulator, 1);
  EXPECT_EQ(full.scenario.vehicle, sim::Vehicle::Bullet);
  EXPECT_DOUBLE_EQ(full.scenario.period, 0.026);
  EXPECT_TRUE(full.scenario.lasers[0].rolling);
}

TEST(PaperFile, AMalformedOneSaysWhere) {
  json file = paper();
  file["extra"] = 1;
  EXPECT_THAT(complaint(file), HasSubstr("unknown field 'extra'"));
  file = paper();
  file["scenarios"][1].erase("goal");
  EXPECT_EQ(complaint(file), "scenarios/1/goal: is missing");
  file = paper();
  file["scenarios"][1]["name"] = "case1";
  EXPECT_EQ(complaint(file), "scenarios/1/name: 'case1' is used twice");

  EXPECT_THAT(complaint_with("/scenarios/2/K_r", "much"), HasSubstr("scenarios/2/K_r: must be a"));
  EXPECT_THAT(complaint_with("/scenarios/0/obstacles/0/radius", -1), HasSubstr("obstacles/0"));
  EXPECT_THAT(complaint_with("/scenarios/0/obstacles/0/colour", "red"), HasSubstr("'colour'"));
  EXPECT_THAT(complaint_with("/scenarios/0/goal", {1, 2, 3}), HasSubstr("scenarios/0/goal"));
  EXPECT_THAT(complaint_with("/common/dt", "fast"), HasSubstr("common/dt: 'fast' must begin as"));
  EXPECT_THAT(complaint_with("/common/lidar/beams", 181), HasSubstr("this program has 361 only"));
  EXPECT_THAT(complaint_with("/common/d_r", 1000), HasSubstr("must be d_safe + 350 = 1350"));
  EXPECT_THAT(complaint_with("/scenarios", json::array()), HasSubstr("has no entries"));
  EXPECT_THAT(complaint_with("/scenarios/0/accept/best", json::object()),
              HasSubstr("scenarios/0/accept/best: is no reading"));
  EXPECT_THAT(complaint_with("/scenarios/0/accept/modified/speed_at_most", 1),
              HasSubstr("scenarios/0/accept/modified/speed_at_most: must be"));
  EXPECT_THAT(complaint_with("/scenarios/0/accept/modified/outcome", "lost"),
              HasSubstr("'lost' is unknown"));
  EXPECT_THAT(complaint_with("/scenarios/1/accept_compare/0/metric", "beauty"),
              HasSubstr("accept_compare/0/metric: 'beauty' is no metric"));
}

TEST(PaperFile, ALayoutThatCannotBeRunIsSaidBeforeAnyRun) {
  json overlapping = paper();
  overlapping["scenarios"][1]["obstacles"][0] = {
      {"type", "cylinder"}, {"x", 300}, {"y", 0}, {"radius", 100}};
  EXPECT_THAT(
      [&] { check_layouts(paper_file_from_json(overlapping)); },
      ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("scenarios/1 (case2): Obstacle 1")));
  json unsafe = paper();  // S = 200 = K_r d_safe
  unsafe["scenarios"][0]["K_r"] = 0.2;
  EXPECT_THAT([&] { check_layouts(paper_file_from_json(unsafe)); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("strip_step")));
}

TEST(PaperFile, APolygonMaySayItsFirstVertexAgain) {
  json file = paper();
  json& points = file["scenarios"][8]["obstacles"][0]["points"];
  points.push_back(points[0]);
  const PaperFile read = paper_file_from_json(file);
  EXPECT_EQ(algo::outline_W(read.layouts[8].obstacles[0]).size(), 4u);
}

TEST(PaperFile, APolygonMayHaveANotch) {
  // An L of three unit squares: area 3, its inner corner at (1, 1) free on one side.
  const std::vector<algo::Vec2> outline{{0, 0}, {0, 2}, {1, 2}, {1, 1}, {2, 1}, {2, 0}};
  const auto parts = convex_parts(outline);
  ASSERT_TRUE(parts);
  double area = 0;
  for (const auto& part : *parts) {
    ASSERT_EQ(part.size(), 3u);
    const algo::Vec2 a = part[1] - part[0];
    const algo::Vec2 b = part[2] - part[0];
    EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0);
    area += (a.x() * b.y() - a.y() * b.x()) / 2;
  }
  EXPECT_DOUBLE_EQ(area, 3);
  EXPECT_FALSE(convex_parts({{0, 0}, {1, 1}, {1, 0}, {0, 1}}));  // a bow tie
  EXPECT_FALSE(convex_parts({{0, 0}, {1, 1}, {2, 2}}));

  json file = paper();
  json& points = file["scenarios"][8]["obstacles"][0]["points"];
  points = {{2000, 2000}, {3000, 2000}, {3000, 3000}, {2500, 2500}, {2000, 3000}};
  const PaperFile read = paper_file_from_json(file);
  ASSERT_EQ(read.layouts[8].obstacles.size(), 3u);
  double nearest = 10;
  for (const algo::Obstacle& part : read.layouts[8].obstacles) {
    nearest = std::min(nearest, algo::signed_distance(part, {2.5, 2.9}));
  }
  // In the notch: to the edge from (2.5, 2.5) at 45 degrees, 0.4 sin 45.
  EXPECT_NEAR(nearest, 0.4 / std::numbers::sqrt2, 1e-9);
  points = {{2000, 2000}, {3000, 3000}, {3000, 2000}, {2000, 3000}};
  EXPECT_THAT(complaint(file), HasSubstr("obstacles/0/points: must be the outline of a solid"));
}

// ---- the figures -------------------------------------------------------------------------------

struct PathFiguresTest : ::testing::Test {
  void at(double x, double y, double distance) {
    algo::Telemetry t;
    t.ground_truth = algo::GroundTruth{{x, y, 0}, distance, distance - 0.35, false};
    recorder.add(t, 1.0);
  }
  PathRecorder recorder{0.35, 0.1};
};

TEST_F(PathFiguresTest, BodyCircleIsMeasuredFromTheHull) {
  at(0, 0, 1.30);  // the start is no tick gone by, but it is as deep as it is: 1.35 - 1.30
  at(0.1, 0, 1.20);
  at(0.2, 0, 1.10);
  at(0.3, 0, 1.40);
  EXPECT_NEAR(recorder.figures().body_intrusion, 0.25, 1e-12);      // 1.35 - 1.10
  EXPECT_NEAR(recorder.figures().body_infringed_time, 0.2, 1e-12);  // two ticks
}

TEST_F(PathFiguresTest, BendingIsSquaredTurnOverTheLaterSegment) {
  // East 0.1 m, then north 0.2 m: (pi/2)^2 / 0.2; then 45 degrees on over 0.1 sqrt 2.
  at(0, 0, 5), at(0.1, 0, 5), at(0.1, 0.2, 5), at(0, 0.3, 5);
  const double quarter = std::numbers::pi / 2;
  const double eighth = std::numbers::pi / 4;
  EXPECT_NEAR(recorder.figures().bending,
              quarter * quarter / 0.2 + eighth * eighth / (0.1 * std::numbers::sqrt2),
              1e-9);
}

TEST_F(PathFiguresTest, StepsBelowFiftyMillimetresAreMerged) {
  // 30 mm and 30 mm east count as one segment of 60 mm; the jog of 10 mm north is not kept.
  at(0, 0, 5), at(0.03, 0, 5), at(0.06, 0, 5), at(0.06, 0.01, 5), at(0.12, 0, 5);
  EXPECT_NEAR(recorder.figures().bending, 0, 1e-12);
}

TEST(PathFigures, ShareOfTheStripBeforeItsVia) {
  PathRecorder recorder(0.35, 0.1);
  const auto tick = [&](double via, double push) {
    algo::Telemetry t;
    t.ground_truth = algo::GroundTruth{{0, 0, 0}, 2, 1.65, false};
    for (const double x : {0.0, via, 0.2}) t.output.strip.append().position_W = {x, 0};
    t.output.external_left_W = {0, push};
    recorder.add(t, 1.0);
  };
  tick(0.1, 1), tick(0.15, 1), tick(0.05, 1);  // shares 0.5, 0.75, 0.25
  tick(0.0, 0);                                // nothing pushes: not counted
  EXPECT_NEAR(recorder.figures().share_mean, 0.5, 1e-12);
  EXPECT_NEAR(recorder.figures().share_deviation, 0.25, 1e-12);
}

TEST(Standing, APauseIsARestThatTheRobotDrivesOnFrom) {
  // At most 1 m/s and 1 rad/s, ticks of 0.05 s: at rest below 2.5 mm and 2.5 mrad a tick.
  StandingRecorder recorder({.v_max = 1, .omega_max = 1}, 0.05);
  algo::Pose2 pose{};
  const auto ticks = [&](int count, double v, double omega) {
    for (int i = 0; i < count; ++i) {
      pose = {pose.x + 0.05 * v, pose.y, pose.heading + 0.05 * omega};
      algo::Telemetry t;
      t.ground_truth = algo::GroundTruth{pose, 2, 1.65, false};
      recorder.add(t);
    }
  };
  ticks(1, 0, 0);                        // the start
  ticks(10, 0.01, 0);                    // 0.5 s of rest before the first motion: no pause
  ticks(5, 1, 0), ticks(4, 0.01, 0);     // 0.2 s of rest
  ticks(5, 0, 1), ticks(1, 0, 0);        // turning is no rest; 0.05 s is no pause
  ticks(5, 0.1, 0), ticks(20, 0, 0.01);  // creeping is no rest; the last rest has no end
  EXPECT_EQ(recorder.figures().pauses, 1U);
  EXPECT_NEAR(recorder.figures().pause_time, 0.2, 1e-9);
  EXPECT_NEAR(recorder.figures().time, 0.5 + 0.2 + 0.05 + 1.0, 1e-9);
}

RunFigures run_of(Outcome outcome, double time, double path, double clearance, double depth) {
  RunFigures figures{.outcome = outcome};
  figures.metrics.time = time;
  figures.metrics.path_length = path;
  figures.metrics.min_clearance = clearance;
  figures.metrics.intrusion = depth;
  return figures;
}

Row two_runs(const char* reading) {
  return {
      "case1",
      reading,
      {run_of(Outcome::Reached, 10, 4.0, 0.70, 0.01), run_of(Outcome::Stuck, 20, 5.0, 0.60, 0.05)}};
}

TEST(Figures, MeansWorstAndLeastAsTheFileDefinesThem) {
  const Row row = two_runs("modified");
  const auto value = [&](const char* metric) { return figure(row, *find_metric(metric)); };
  EXPECT_DOUBLE_EQ(value("time_s"), 15);
  EXPECT_DOUBLE_EQ(value("path_mm"), 4500);
  EXPECT_DOUBLE_EQ(value("min_clearance_mm"), 600);
  EXPECT_DOUBLE_EQ(value("safety_depth_mm"), 50);
  EXPECT_DOUBLE_EQ(value("reached"), 1);
  EXPECT_DOUBLE_EQ(value("runs"), 2);
  EXPECT_EQ(outcomes_text(row), "1 reached, 1 stuck");
  EXPECT_FALSE(common_outcome(row));
  // "Holds for every seed": an upper limit is held against the largest clearance.
  EXPECT_DOUBLE_EQ(figure_against(row, *find_metric("min_clearance_mm"), false), 700);
  EXPECT_DOUBLE_EQ(figure_against(row, *find_metric("min_clearance_mm"), true), 600);
}

// ---- the limits --------------------------------------------------------------------------------

Layout layout_asking(const Acceptance& accept) {
  Layout layout{.name = "case1"};
  layout.accept = {accept};
  return layout;
}

TEST(Accept, ALimitThatFailsIsSaidWithItsFigure) {
  PaperFile file;
  file.layouts = {layout_asking({.reading = "modified",
                                 .outcome = Outcome::Reached,
                                 .collisions = 0,
                                 .limits = {{"path_mm", false, 4500},
                                            {"path_mm", false, 4499},
                                            {"min_clearance_mm", true, 600},
                                            {"min_clearance_mm", true, 601}}})};
  const std::vector<Row> rows{two_runs("modified")};
  const std::vector<Check> checks = evaluate(file, rows, {});
  ASSERT_EQ(checks.size(), 6u);
  EXPECT_FALSE(checks[0].held);  // one of two is stuck
  EXPECT_EQ(checks[0].figure, "1 reached, 1 stuck");
  EXPECT_TRUE(checks[1].held);
  EXPECT_TRUE(checks[2].held);
  EXPECT_FALSE(checks[3].held);
  EXPECT_EQ(checks[3].asked, "path_mm at most 4499");
  EXPECT_EQ(checks[3].figure, "4500");
  EXPECT_TRUE(checks[4].held);
  EXPECT_FALSE(checks[5].held);
  EXPECT_FALSE(all_held(checks));
}

TEST(Accept, AComparisonIsStrict) {
  PaperFile file;
  file.layouts = {{.name = "case1"}};
  file.layouts[0].accept_compare = {{"time_s", "modified", "original"}};
  std::vector<Row> rows{two_runs("modified"), two_runs("original")};
  EXPECT_FALSE(all_held(evaluate(file, rows, {})));  // equal is not lower
  rows[1].runs[0].metrics.time = 10.1;
  EXPECT_TRUE(all_held(evaluate(file, rows, {})));
  rows.pop_back();
  EXPECT_FALSE(all_held(evaluate(file, rows, {})));  // nothing to compare with
}

TEST(Claims, OnlyWithOurExtensionWhenNoPrintedReadingHolds) {
  const auto row = [](const char* reading, Outcome outcome) {
    return Row{"case1", reading, {run_of(outcome, 1, 1, 1, 0)}};
  };
  std::vector<Row> rows{row("original", Outcome::Stuck),
                        row("modified_published", Outcome::Stuck),
                        row("modified_linear", Outcome::Stuck),
                        row("modified_c1", Outcome::Stuck),
                        row("modified", Outcome::Reached)};
  std::vector<Claim> claims = judge_claims(rows);
  ASSERT_EQ(claims.size(), 1u);
  EXPECT_EQ(claims[0].verdict, Verdict::OnlyWithExtension);
  EXPECT_THAT(claims[0].held_by, ::testing::ElementsAre("modified"));
  rows[1].runs[0].outcome = Outcome::Reached;
  EXPECT_EQ(judge_claims(rows)[0].verdict, Verdict::Reproduced);
  rows[0].runs[0].outcome = Outcome::Reached;  // the original is not stuck: nothing of it holds
  EXPECT_EQ(judge_claims(rows)[0].verdict, Verdict::NotReproduced);
}

/// exp1's goal is 773 mm from the cylinder, and a run may end 100 mm beyond it.
TEST(FullStrip, IsNotBlamedForWhereAGoalLies) {
  const Depths least = least_depths(embedded_paper_file());
  EXPECT_NEAR(least.at("exp1"), 127, 1);
  EXPECT_EQ(least.at("case1"), 0);
  const Row row{"exp1", "strip", {run_of(Outcome::Reached, 1, 1, 1, 0.159)}};
  EXPECT_THAT(strip_sentences(strip_beside({&row, 1}, {}, least)),
              HasSubstr("exp1 by 159 mm (127 mm at least"));
}

TEST(FullStrip, IsHeldAgainstTheReadingsThatReach) {
  const auto row = [](const char* reading, Outcome outcome, double turning, double time) {
    Row made{"case1", reading, {run_of(outcome, time, 1, 1, 0)}};
    made.runs[0].metrics.turning = turning;
    made.runs[0].path.bending = turning;
    return made;
  };
  std::vector<Row> strip{row("strip", Outcome::Reached, 2, 50)};
  const std::vector<Row> readings{row("original", Outcome::Stuck, 0, 10),
                                  row("modified", Outcome::Reached, 3, 80),
                                  row("via_kept", Outcome::Reached, 1, 50)};
  const StripBeside beside = strip_beside(strip, readings);
  EXPECT_EQ(beside.rows, 2u);
  EXPECT_THAT(beside.turns_less, ::testing::ElementsAre("case1 via_kept"));
  EXPECT_THAT(beside.faster, ::testing::ElementsAre("case1 via_kept"));  // equal is not faster
  EXPECT_THAT(strip_sentences(beside), HasSubstr("turns less in 1 of 2 (not: case1 via_kept)"));
  EXPECT_EQ(strip_table(strip, readings).rows[0][2], "1 stuck");
  strip[0].runs[0].outcome = Outcome::Collided;
  EXPECT_EQ(strip_beside(strip, readings).rows, 0u);
  EXPECT_THAT(strip_sentences(strip_beside(strip, readings)), HasSubstr("every run: case1"));
}

TEST(Sweeps, RisingAllowsTheNoiseAtAStepAndWantsMoreInAll) {
  EXPECT_TRUE(rises({100, 110, 200}, 15));
  EXPECT_TRUE(rises({100, 90, 200}, 15));
  EXPECT_FALSE(rises({100, 80, 200}, 15));
  EXPECT_FALSE(rises({100, 105, 110}, 15));
  EXPECT_FALSE(rises({}, 15));
}

// ---- end to end --------------------------------------------------------------------------------

TEST(Study, OneScenarioEndToEnd) {
  json file = short_file();
  file["scenarios"][0]["accept"] = {{"modified",
                                     {{"outcome", "reached"},
                                      {"collisions", 0},
                                      {"time_s_at_most", 6},
                                      {"path_mm_at_most", 1000}}}};
  file["scenarios"][0]["accept_noise_free"] = {{"original", {{"outcome", "reached"}}}};
  const PaperFile read = paper_file_from_json(file);
  Study study = run_study(read, {.seeds = 2, .full_simulator = true, .threads = 2});
  EXPECT_EQ(study.paper.size(), readings().size());
  EXPECT_EQ(study.noise_free.size(), readings().size());
  EXPECT_EQ(study.full.size(), readings().size());
  ASSERT_EQ(study.strip.size(), 1u);
  EXPECT_EQ(outcomes_text(study.strip[0]), "2 reached");
  EXPECT_EQ(study.strip_full.size(), 1u);
  EXPECT_EQ(study.checks.size(), 5u);
  EXPECT_TRUE(all_held(study.checks)) << to_text(study);
  const Row& modified = *find_row(study.paper, "free", "modified");
  EXPECT_EQ(outcomes_text(modified), "2 reached");
  // Straight on at 200 mm/s until within 100 mm of 1000 mm, in steps of 10 mm; slower within S.
  EXPECT_NEAR(modified.runs[0].metrics.path_length, 0.905, 0.01);
  EXPECT_GT(modified.runs[0].track_W.size(), 80u);
  EXPECT_TRUE(modified.runs[1].track_W.empty());
  EXPECT_TRUE(to_json(study)["paper_conditions"][0]["metrics"]["min_clearance_mm"].is_null());

  file["scenarios"][0]["accept"]["modified"]["path_mm_at_most"] = 100;
  study.checks = evaluate(paper_file_from_json(file), study.paper, study.noise_free);
  EXPECT_FALSE(all_held(study.checks));
  EXPECT_THAT(to_text(study), HasSubstr("FAILED"));
}

TEST(Study, DoesNotDependOnTheNumberOfThreads) {
  json file = paper();
  file["scenarios"] = json::array({file["scenarios"][4]});  // exp1
  const PaperFile read = paper_file_from_json(file);
  const auto text = [&](unsigned threads) {
    return to_json(run_study(read, {.seeds = 2, .full_simulator = false, .threads = threads}))
        .dump();
  };
  EXPECT_EQ(text(1), text(3));
}

TEST(Markdown, WritesTheDocumentAndAPictureOfEachLayout) {
  const PaperFile file = paper_file_from_json(short_file());
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

TEST(SvgPlot, PutsMetresUpsideUpAndEscapesWords) {
  // 2 m x 1 m on 220 px with 10 px of margin: 100 px a metre; y = 1 is at the top margin.
  SvgPlot plot({0, 0}, {2, 1}, 220, 0);
  plot.circle({1, 1}, 0.5, "fill=\"none\"");
  const std::vector<algo::Vec2> line{{0, 0}, {2, 0.5}};
  plot.polyline(line, "stroke=\"red\"");
  const std::string document = plot.document("a < b & c");
  EXPECT_THAT(document, HasSubstr("<circle cx=\"110.0\" cy=\"10.0\" r=\"50.0\""));
  EXPECT_THAT(document, HasSubstr("points=\"10.0,110.0 210.0,60.0\""));
  EXPECT_THAT(document, HasSubstr("<title>a &lt; b &amp; c</title>"));
}

}  // namespace
}  // namespace server::reproduce
