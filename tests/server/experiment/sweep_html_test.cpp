// tests/server/experiment/sweep_html_test.cpp: the HTML report stands alone, and the pictures show
// the right arms.
#include "server/experiment/sweep/sweep_html.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/experiment/sweep/sweep_figures.hpp"

namespace server::sweep {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

json pictured() {
  return {{"name", "pictured"},
          {"scenarios", {{{"name", "free"}, {"goal", {{"x", 1}, {"y", 0}}}}}},
          {"controllers", {{{"name", "original"}, {"label", "<b>&amp"}}, "strip"}}};
}

Plan plan_from(const json& source) {
  return Plan(document_from_json(source, ScenarioLibrary("", "")));
}

/// The arm `a` reaches in a + 1 of its repeats.
Rows rows_of(const Plan& plan) {
  Rows rows(plan.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RunPlace at = plan.place(i);
    rows.set(i,
             experiment::Row{
                 .outcome = at.repeat <= at.arm ? algo::Outcome::Reached : algo::Outcome::Stuck,
                 .figures = {{"time_s", 10.0}, {"path_m", 2.0}, {"min_clearance_m", 0.5}}});
  }
  return rows;
}

std::string html_of(const Plan& plan, const Rows& rows) {
  const Results results = results_of(plan, rows);
  return to_html(plan, rows, results, pictures_of(plan, rows, results));
}

std::string html_of(const json& source) {
  const Plan plan = plan_from(source);
  const Rows rows = rows_of(plan);
  return html_of(plan, rows);
}

std::vector<std::string> pictures_for(const json& source) {
  const Plan plan = plan_from(source);
  const Rows rows = rows_of(plan);
  std::vector<std::string> files;
  for (const Picture& each : pictures_of(plan, rows, results_of(plan, rows))) {
    files.push_back(each.file);
  }
  return files;
}

TEST(SweepHtml, LoadsNothingAndEscapesLabels) {
  const std::string html = html_of(pictured());
  EXPECT_THAT(html, HasSubstr("<td>&lt;b&gt;&amp;amp</td>"));
  EXPECT_THAT(html, Not(HasSubstr("<b>")));
  for (const char* const outside : {"src=", "href=", "@import", "url("}) {
    EXPECT_THAT(html, Not(HasSubstr(outside)));
  }
  EXPECT_THAT(html, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(html, Not(HasSubstr("INCOMPLETE")));
}

TEST(SweepHtml, AnIncompleteExperimentSaysSoFirst) {
  const Plan plan = plan_from(pictured());
  const Rows rows(plan.size());
  const std::string html = html_of(plan, rows);
  EXPECT_LT(html.find("INCOMPLETE: of 2 runs, 2 are missing"), html.find("<table>"));
  EXPECT_THAT(html, HasSubstr("<td>missing</td>"));
}

TEST(SweepHtml, TheTableOfRunsIsBounded) {
  json source = pictured();
  source["repeats"] = kMostListed / 2;
  EXPECT_THAT(html_of(source), HasSubstr("Press a heading to sort."));
  source["repeats"] = kMostListed / 2 + 1;
  EXPECT_THAT(html_of(source), HasSubstr("The 1002 runs are in runs.csv."));
}

TEST(SweepFigures, AGridOverTwoParametersHasAHeatMapOfEachController) {
  json source = pictured();
  EXPECT_THAT(
      pictures_for(source),
      testing::ElementsAre("success.svg", "time_s.svg", "path_m.svg", "min_clearance_m.svg"));
  source["sweep"] = {{"grid", {{"k_r", {0.3, 0.4}}, {"v_max", {0.1, 0.2, 0.3}}}}};
  EXPECT_THAT(pictures_for(source), testing::Contains("heat_map_2.svg"));
  EXPECT_THAT(html_of(source), HasSubstr(">v_max [m/s]<"));
  source["sweep"] = {{"grid", {{"v_max", {0.1, 0.2, 0.3}}}}};
  EXPECT_THAT(pictures_for(source), Not(testing::Contains("heat_map_1.svg")));
}

TEST(SweepFigures, MoreArmsThanFitAreNotDrawn) {
  json source = pictured();
  source["sweep"] = {{"random", {{"count", kMostDrawn}, {"parameters", {{"v_max", {0.1, 0.3}}}}}}};
  EXPECT_THAT(pictures_for(source), testing::IsEmpty());
}

}  // namespace
}  // namespace server::sweep
