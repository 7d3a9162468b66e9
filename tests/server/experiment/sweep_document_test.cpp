// tests/server/experiment/sweep_document_test.cpp: the document of an experiment: what it expands
// to, and the sentence about each field that is wrong.
#include "server/experiment/sweep/sweep_document.hpp"

#include <algorithm>
#include <cmath>

#include "tests/folders.hpp"
#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/run/robot_library.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/text_file.hpp"

namespace server::sweep {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::StartsWith;

Document read(const json& document) {
  return document_from_json(document, ScenarioLibrary("", ""));
}

json least() {
  return {{"name", "small"}, {"scenarios", {"case1"}}, {"controllers", {"modified"}}};
}

TEST(SweepDocument, TheLeastDocumentIsOneRun) {
  const Document document = read(least());
  EXPECT_EQ(document.runs(), 1U);
  EXPECT_EQ(document.controllers[0].label, "modified");
  EXPECT_EQ(document.scenarios[0].name, "case1");
  EXPECT_FALSE(document.comparisons.has_value());
}

TEST(SweepDocument, HasTheProductOfItsParts) {
  const Document document =
      read({{"name", "all"},
            {"scenarios",
             {"case1",
              {{"name", "mine"}, {"goal", {{"x", 2}, {"y", 0}}}},
              {{"random_layouts", {{"count", 3}, {"seed", 7}, {"obstacles", 2}, {"k_r", 0.6}}}}}},
            {"controllers",
             {{{"name", "modified"}, {"label", "ours"}, {"parameters", {{"k_c", 0.5}}}}, "vff"}},
            {"sweep", {{"grid", {{"k_r", {0.2, 0.4}}, {"v_max", {0.1, 0.2, 0.3}}}}}},
            {"repeats", 4},
            {"seed", 100},
            {"physics", "kinematic"},
            {"filter", "median"},
            {"time_limit", 60},
            {"comparisons", {{"baseline", "vff"}}}});
  EXPECT_EQ(document.runs(), 5U * 2 * 6 * 4);
  EXPECT_EQ(document.scenarios[2].name, "random-2-0007");
  EXPECT_THAT(document.comparisons.value().others, ElementsAre("ours"));
  for (const sim::Scenario& scenario : document.scenarios) {
    EXPECT_EQ(scenario.physics, sim::PhysicsKind::Kinematic);
    EXPECT_EQ(scenario.filter, "median");
    EXPECT_EQ(scenario.time_limit, 60);
  }
  EXPECT_EQ(document.points[1], (Point{{"k_r", 0.2}, {"v_max", 0.2}}));
}

TEST(SweepDocument, NoiseAndLimitsAreSetInEveryScenarioAndInItsFile) {
  json document = least();
  document["scenarios"] = {"case1",
                           {{"name", "slow"},
                            {"goal", {{"x", 2}, {"y", 0}}},
                            {"drive", {{"max_v", 0.1}, {"yaw_slip", 0.2}}}}};
  document["noise"] = {{"laser", 0.03}, {"odometry_scale", 0.02}};
  document["limits"] = {{"max_omega", 0.5}, {"ramps", true}};
  for (const sim::Scenario& each : read(document).scenarios) {
    EXPECT_EQ(each.robot.sensors.lasers.at(0).noise, 0.03) << each.name;
    EXPECT_EQ(each.drive.odometry_scale, 0.02);
    EXPECT_EQ(each.drive.max_omega, 0.5);
    EXPECT_TRUE(each.drive.ramps);
    EXPECT_EQ(each.drive.yaw_slip, each.name == "slow" ? 0.2 : 0);  // its own stay
    const sim::Scenario again = scenario_from_json(to_json(each), RobotLibrary());
    EXPECT_EQ(again.robot.sensors.lasers.at(0).noise, 0.03);
    EXPECT_EQ(again.drive, each.drive);
  }
}

TEST(SweepDocument, ATimeFactorIsOfTheScenariosOwnLimit) {
  json document = least();
  document["scenarios"] = {
      {{"name", "own"}, {"goal", {{"x", 2}, {"y", 0}}}, {"time_limit", 40}},
      {{"name", "usual"}, {"goal", {{"x", 2}, {"y", 0}}}, {"parameters", {{"v_max", 0.1}}}}};
  document["time_factor"] = 0.5;
  const Document found = read(document);
  EXPECT_EQ(found.scenarios[0].time_limit, 20);
  EXPECT_EQ(found.scenarios[1].time_limit, 50);  // of 5 x 2 m / 0.1 m/s
}

TEST(SweepDocument, RandomLayoutsMayHaveAnotherRobot) {
  json document = least();
  document["scenarios"] = {{{"random_layouts", {{"count", 1}}}},
                           {{"random_layouts", {{"count", 1}, {"robot", "jackal"}}}}};
  const Document found = read(document);
  EXPECT_EQ(found.scenarios[1].name, "random-3-0001-jackal");
  EXPECT_EQ(found.scenarios[1].robot.name, "jackal");
  EXPECT_EQ(to_json(found.scenarios[1])["obstacles"], to_json(found.scenarios[0])["obstacles"]);
}

constexpr const char* kWorlds = R"({"worlds": [
  {"id": 7, "start": [0, 0, 1.57], "goal": [0, 6], "optimal_path_length": 6,
   "obstacles": [[-1.5, 3], [1.5, 3]]},
  {"id": 9, "start": [0, 0, 1.57], "goal": [0, 6], "optimal_path_length": 6, "obstacles": []}]})";

json with_worlds(const std::string& file) {
  json document = least();
  document["scenarios"] = {{{"barn", {{"worlds", file}}}}};
  return document;
}

Document read_with_files(const json& document) {
  return document_from_json(document, ScenarioLibrary("", ""), {}, Files::Allowed);
}

TEST(SweepDocument, BarnWorldsAreScenarios) {
  const tests::TemporaryFolder folder;
  const auto file = folder.path() / "worlds.json";
  write_text(file, kWorlds);
  json document = with_worlds(file.string());
  const Document all = read_with_files(document);
  ASSERT_EQ(all.runs(), 2U);
  EXPECT_EQ(all.scenarios[0].name, "barn-7");
  EXPECT_EQ(all.scenarios[0].obstacles.size(), 2U);
  EXPECT_EQ(all.scenarios[0].robot.name, "jackal");
  document["scenarios"][0]["barn"]["count"] = 1;
  document["scenarios"][0]["barn"]["stress"] = true;
  const Document one = read_with_files(document);
  ASSERT_EQ(one.runs(), 1U);
  EXPECT_EQ(one.scenarios[0].drive.yaw_slip, 0.1);
}

TEST(SweepDocument, NoFileIsReadUnlessTheCallerAllowsIt) {
  const tests::TemporaryFolder folder;
  const auto file = folder.path() / "worlds.json";
  write_text(file, kWorlds);
  const auto refusal = [](const json& document, Files files) -> std::string {
    try {
      document_from_json(document, ScenarioLibrary("", ""), {}, files);
    } catch (const DocumentError& e) {
      return e.what();
    }
    return "accepted";
  };
  // The same sentence whether there is a file or none: it tells nothing of this computer.
  for (const std::string& each :
       {file.string(), std::string("/etc/passwd"), folder.path().string() + "/none"}) {
    EXPECT_EQ(
        refusal(with_worlds(each), Files::Refused),
        "scenarios/0/barn/worlds: is a file, which only `tautline sweep` reads; put its worlds "
        "in as scenarios instead");
  }
  const std::string none = folder.path().string() + "/none";
  EXPECT_THAT(refusal(with_worlds(none), Files::Allowed),
              StartsWith("scenarios/0/barn/worlds: " + none));
  // No other part of a document names a file.
  json document = least();
  document["scenarios"] = {
      {{"name", "mine"}, {"goal", {{"x", 1}, {"y", 0}}}, {"robot", file.string()}}};
  EXPECT_THAT(refusal(document, Files::Refused), StartsWith("scenarios/0/robot: "));
  document["scenarios"] = {{{"name", "mine"}, {"goal", {{"x", 1}, {"y", 0}}}, {"log", "/a.log"}}};
  EXPECT_THAT(refusal(document, Files::Refused), StartsWith("scenarios/0: unknown field 'log'"));
  document["scenarios"] = {file.string()};
  EXPECT_THAT(refusal(document, Files::Refused), StartsWith("scenarios/0: There is no scenario"));
}

TEST(SweepDocument, DrawsAreSeededAndInTheirRange) {
  json document = least();
  document["sweep"] = {{"random", {{"count", 50}, {"parameters", {{"k_r", {0.2, 0.4}}}}}}};
  const std::vector<Point> points = read(document).points;
  EXPECT_EQ(points, read(document).points);
  for (const Point& point : points) {
    EXPECT_GE(point.at("k_r"), 0.2);
    EXPECT_LT(point.at("k_r"), 0.4);
  }
  document["sweep"]["random"]["seed"] = 2;
  EXPECT_NE(points, read(document).points);
}

TEST(SweepDocument, ALatinHypercubeHasOneDrawInEachPart) {
  json document = least();
  document["sweep"] = {
      {"latin_hypercube",
       {{"count", 20}, {"parameters", {{"k_r", {0.2, 0.4}}, {"filter_half_width", {1, 3}}}}}}};
  std::vector<double> parts;
  for (const Point& point : read(document).points) {
    parts.push_back(std::floor((point.at("k_r") - 0.2) / 0.2 * 20));
    EXPECT_EQ(point.at("filter_half_width"), std::round(point.at("filter_half_width")));
  }
  std::ranges::sort(parts);
  for (std::size_t i = 0; i < parts.size(); ++i) EXPECT_EQ(parts[i], static_cast<double>(i));
}

TEST(SweepDocument, TheExampleOfTheDocumentationIsGood) {
  const auto file = tests::folder().parent_path() / "docs/experiments/canonical.json";
  EXPECT_EQ(read(json::parse(read_text(file))).runs(), 600U);
}

/// A change to the least document, and the start of the sentence about it.
struct Malformed {
  const char* patch = nullptr;  // fields to replace
  const char* error = nullptr;
};

const Malformed kMalformed[] = {
    {R"({"name": null})", "name: must be text"},
    {R"({"name": "No Name"})", "name: must be 1 to 64"},
    {R"({"colour": 1})", "document: unknown field 'colour'"},
    {R"({"scenarios": []})", "scenarios: is empty"},
    {R"({"scenarios": "case1"})", "scenarios: must be a list"},
    {R"({"scenarios": ["case1", 7]})", "scenarios/1: must be an object"},
    {R"({"scenarios": ["nowhere"]})", "scenarios/0: There is no scenario 'nowhere'"},
    {R"({"scenarios": ["case1", "case1"]})", "scenarios/1: the scenario 'case1' stands twice"},
    {R"({"scenarios": [{"name": "mine"}]})", "scenarios/0: has no goal"},
    {R"({"scenarios": [{"name": "mine", "goal": {"x": 1, "y": 0}, "period": 9}]})",
     "scenarios/0/period: is 9, must lie in"},
    {R"({"scenarios": [{"name": "mine", "wheels": 3}]})", "scenarios/0: unknown field 'wheels'"},
    {R"({"scenarios": [{"random_layouts": {"count": 0}}]})",
     "scenarios/0/random_layouts/count: must be at least 1"},
    {R"({"scenarios": [{"random_layouts": {"count": 2, "k_r": -1}}]})",
     "scenarios/0/random_layouts/k_r: "},
    {R"({"scenarios": [{"random_layouts": {"count": 2, "obstacles": 13}}]})",
     "scenarios/0/random_layouts/obstacles: is 13, must be at most 12"},
    {R"({"scenarios": [{"random_layouts": {"count": 2, "obstacles": 3, "density": 0.1}}]})",
     "scenarios/0/random_layouts/density: stands beside obstacles; give one of them"},
    {R"({"scenarios": [{"random_layouts": {"count": 2, "density": 1}}]})",
     "scenarios/0/random_layouts/density: "},
    {R"({"scenarios": [{"random_layouts": {"count": 2, "obstacles": 12, "gap": 3}}]})",
     "scenarios/0/random_layouts: 12 obstacles with free gaps of 3 m find no place"},
    {R"({"controllers": [{"name": "vff", "repeats": 0}]})",
     "controllers/0/repeats: must be at least 1"},
    {R"({"controllers": [{"name": "vff", "scenarios": ["nowhere"]}]})",
     "controllers/0/scenarios: no scenario of the document has the name 'nowhere'"},
    {R"({"controllers": [{"name": "vff", "scenarios": []}]})", "controllers/0/scenarios: is empty"},
    {R"({"scenarios": [{"random_layouts": {"count": 2, "crowd": 1}}]})",
     "scenarios/0/random_layouts: unknown field 'crowd'"},
    {R"({"controllers": []})", "controllers: is empty"},
    {R"({"controllers": ["vff", "teleport"]})", "controllers/1/name: 'teleport' is unknown"},
    {R"({"controllers": ["vff", "vff"]})", "controllers/1: the label 'vff' stands twice"},
    {R"({"controllers": [{"label": "x"}]})", "controllers/0/name: is missing"},
    {R"({"controllers": [{"name": "vff", "label": "a|b"}]})",
     "controllers/0/label: must not be empty, nor have a |"},
    {R"({"controllers": [{"name": "vff", "gain": 1}]})", "controllers/0: unknown field 'gain'"},
    {R"({"controllers": [{"name": "vff", "parameters": {"k_x": 1}}]})",
     "controllers/0/parameters/k_x: there is no such parameter"},
    {R"({"controllers": [{"name": "vff", "parameters": {"k_r": "big"}}]})",
     "controllers/0/parameters/k_r: must be a number"},
    {R"({"controllers": [{"name": "vff", "parameters": {"k_r": 0.3, "strip.k_r": 0.3}}]})",
     "controllers/0/parameters/strip.k_r: is k_r by another name"},
    {R"({"sweep": {}})", "sweep: must have exactly one of"},
    {R"({"sweep": {"zigzag": {}}})", "sweep: unknown field 'zigzag'"},
    {R"({"sweep": {"grid": {}}})", "sweep/grid: names no parameter"},
    {R"({"sweep": {"grid": {"k_r": []}}})", "sweep/grid/k_r: has no value"},
    {R"({"sweep": {"grid": {"k_r": [0.2, -5]}}})", "sweep/grid/k_r/1: "},
    {R"({"sweep": {"grid": {"k_r": [0.2, 0.2]}}})", "sweep/grid/k_r: has a value twice"},
    {R"({"sweep": {"list": []}})", "sweep/list: is empty"},
    {R"({"sweep": {"list": [{"k_r": 0.2}, {"k_c": 0.2}]}})",
     "sweep/list/1: must name the same parameters"},
    {R"({"sweep": {"random": {"parameters": {"k_r": [0.1, 0.2]}}}})",
     "sweep/random/count: is missing"},
    {R"({"sweep": {"random": {"count": 2, "parameters": {"k_r": [0.3, 0.2]}}}})",
     "sweep/random/parameters/k_r: must be [least, largest]"},
    {R"({"sweep": {"latin_hypercube": {"count": 2, "parameters": {"k_r": [0.3]}}}})",
     "sweep/latin_hypercube/parameters/k_r: must be [least, largest]"},
    {R"({"controllers": [{"name": "vff", "parameters": {"k_r": 0.3}}],
         "sweep": {"grid": {"k_r": [0.2, 0.4]}}})",
     "controllers/0/parameters/k_r: is swept too"},
    {R"({"repeats": 0})", "repeats: must be at least 1"},
    {R"({"repeats": 2.5})", "repeats: must be a whole number"},
    {R"({"seed": -1})", "seed: must be a whole number"},
    {R"({"physics": "newton"})", "physics: is 'newton', must be bullet or kinematic"},
    {R"({"filter": "sieve"})", "filter: 'sieve' is unknown"},
    {R"({"time_limit": 0})", "time_limit: is 0, must lie in"},
    {R"({"time_limit": 9, "time_factor": 2})", "time_factor: cannot stand beside time_limit"},
    {R"({"noise": {"laser": 2}})", "noise/laser: is 2, must lie in"},
    {R"({"noise": {"max_v": 2}})", "noise: unknown field 'max_v'"},
    {R"({"noise": {"odometry_scale": -1}})", "noise/odometry_scale: is -1, must lie in"},
    {R"({"limits": {"max_v": 0}})", "limits/max_v: is 0, must lie in"},
    {R"({"limits": {"odometry_noise": 0}})", "limits: unknown field 'odometry_noise'"},
    {R"({"scenarios": [{"random_layouts": {"count": 1, "robot": "tank"}}]})",
     "scenarios/0/random_layouts/robot: 'tank' is unknown"},
    {R"({"scenarios": [{"barn": {"worlds": "a.json", "count": 0}}]})",
     "scenarios/0/barn/count: must be at least 1"},
    {R"({"scenarios": [{"barn": {"world": "a.json"}}]})",
     "scenarios/0/barn: unknown field 'world'"},
    {R"({"comparisons": {"baseline": "vff"}})",
     "comparisons/baseline: no controller has the label 'vff'"},
    {R"({"comparisons": {"baseline": "modified"}})",
     "comparisons/baseline: has no other controller"},
    {R"({"comparisons": {"baseline": "modified", "others": ["modified"]}})",
     "comparisons/others/0: is the baseline itself"},
    {R"({"repeats": 10000, "controllers": ["modified", "vff"],
         "scenarios": [{"random_layouts": {"count": 10000}}]})",
     "document: asks for 200000000 runs (scenarios 10000, controllers 2, swept settings 1, "
     "repeats 10000); at most 100000 are allowed"},
};

TEST(SweepDocument, SaysWhichFieldIsWrong) {
  for (const Malformed& each : kMalformed) {
    json document = least();
    const json patch = json::parse(each.patch);
    for (const auto& [key, value] : patch.items()) document[key] = value;
    try {
      read(document);
      ADD_FAILURE() << "accepted " << each.patch;
    } catch (const DocumentError& e) {
      EXPECT_THAT(e.what(), StartsWith(each.error)) << each.patch;
    }
  }
  EXPECT_THROW(read(json::array()), DocumentError);
}

}  // namespace
}  // namespace server::sweep
