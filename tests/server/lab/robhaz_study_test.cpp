// tests/server/lab/robhaz_study_test.cpp: the course of Park et al. 2005, Fig. 10 and 11: the hand,
// the findings, and that a run repeats bit for bit.
#include "server/lab/reproduce/robhaz_study.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algo/teleop/sonar_ring.hpp"
#include "server/run/json_reader.hpp"

namespace server::reproduce {
namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// Made once: four drives of half a minute.
const RobhazStudy& course_study() {
  static const RobhazStudy made = study_robhaz(embedded_robhaz_course());
  return made;
}

std::size_t index_of(std::string_view reading) {
  const auto& runs = course_study().runs;
  return static_cast<std::size_t>(std::ranges::find(runs, reading, &CourseRun::reading) -
                                  runs.begin());
}

const CourseFinding& finding(std::string_view reading, std::size_t section) {
  return course_study().findings.at(index_of(reading)).at(section);
}
constexpr std::size_t kG = 6;

// ---- The hand ----

TEST(SimulatedHand, WithoutAForceItStaysWhereItsDriverMeansItToBe) {
  SimulatedHand hand({.time_constant = 0.15, .forward_compliance = 1, .turn_compliance = 1});
  for (int k = 0; k < 200; ++k) hand.feel({0, 0.6, -0.2}, 0, 0, 0.02);
  EXPECT_NEAR(hand.stick().forward, 0.6, 1e-9);
  EXPECT_NEAR(hand.stick().turn, -0.2, 1e-9);
  EXPECT_EQ(hand.stick().mode, algo::StickMode::Wall);
}

/// First order: 1 - 1/e of the way after one time constant, whatever the step.
TEST(SimulatedHand, ItGivesWayByItsComplianceInItsTimeConstant) {
  for (const int steps : {1, 10}) {
    SimulatedHand hand({.time_constant = 0.15, .forward_compliance = 0.1, .turn_compliance = 0.5});
    for (int k = 0; k < steps; ++k) hand.feel({}, -1, 0.5, 0.15 / steps);
    EXPECT_NEAR(hand.stick().forward, -0.1 * (1 - std::exp(-1.0)), 1e-12);
    EXPECT_NEAR(hand.stick().turn, 0.25 * (1 - std::exp(-1.0)), 1e-12);
  }
}

TEST(SimulatedHand, TheStickHasAnEnd) {
  SimulatedHand hand({.time_constant = 0.01, .forward_compliance = 5, .turn_compliance = 5});
  for (int k = 0; k < 100; ++k) hand.feel({0, 1, 0}, 1, -1, 0.02);
  EXPECT_EQ(hand.stick().forward, 1);
  EXPECT_EQ(hand.stick().turn, -1);
}

TEST(SimulatedHand, TheScriptHoldsUntilItsNextLine) {
  const std::vector<Intention> script{{1, 0.5, 0}, {2, 0, 1}};
  EXPECT_EQ(intention_at(script, 0.5).forward, 0);
  EXPECT_EQ(intention_at(script, 1).forward, 0.5);
  EXPECT_EQ(intention_at(script, 1.99).forward, 0.5);
  EXPECT_EQ(intention_at(script, 5).turn, 1);
}

// ---- The course ----

TEST(RobhazStudy, TheCorrectedReadingShowsAllEightSections) {
  const auto& findings = course_study().findings.at(index_of("corrected"));
  ASSERT_EQ(findings.size(), 8U);
  std::string sections;
  for (const CourseFinding& each : findings) {
    EXPECT_TRUE(each.holds) << each.section << ": " << each.figures;
    EXPECT_LT(each.from, each.to) << each.section;
    sections += each.section;
  }
  EXPECT_EQ(sections, "ABCDEFGH");
  EXPECT_TRUE(all_hold(course_study()));
}

TEST(RobhazStudy, NoReadingTouchesAnything) {
  for (const CourseRun& run : course_study().runs) {
    EXPECT_FALSE(run.collided) << run.reading;
    for (const CourseSample& s : run.samples) EXPECT_GT(s.clearance, 0) << run.reading;
    EXPECT_EQ(run.samples.size(), 300U) << "every T_s for 30 s";
  }
}

/// The paper's own conditions.
TEST(RobhazStudy, TheConditionsAreThePapers) {
  const CourseRun& run = course_study().runs.front();
  EXPECT_DOUBLE_EQ(run.v_max, 0.4);
  EXPECT_NEAR(run.w_max * 180 / std::numbers::pi, 25, 1e-9);
  EXPECT_EQ(course_study().course.scenario.robot.name, "robhaz");
  EXPECT_EQ(course_study().course.seconds, 30);
}

/// Only the force moves the hand in G: a hand that does not give way stays at its script.
TEST(RobhazStudy, AStiffHandDoesNotFollowTheWall) {
  EXPECT_TRUE(finding("corrected", kG).holds);
  EXPECT_FALSE(finding("stiff hand", kG).holds);
  for (const CourseSample& s : course_study().runs.at(index_of("stiff hand")).samples) {
    if (std::isfinite(s.w_d) && s.stamp > finding("stiff hand", kG).from + 1.5) {
      EXPECT_NEAR(s.w_cmd, 0, 1e-3);
    }
  }
}

TEST(RobhazStudy, RepeatsBitForBit) {
  EXPECT_EQ(to_json(study_robhaz(embedded_robhaz_course())).dump(), to_json(course_study()).dump());
}

TEST(RobhazStudy, AFindingThatIsNotThereDoesNotHold) {
  CourseRun still = course_study().runs.front();
  for (CourseSample& s : still.samples) {
    s.theta = s.rho = s.w_d = NAN;
    s.v_cmd = s.v = 0;
    s.v_sprs = 0.4;
  }
  for (const CourseFinding& each : judge_course(still)) EXPECT_FALSE(each.holds) << each.section;
  still.samples.clear();
  for (const CourseFinding& each : judge_course(still)) EXPECT_FALSE(each.holds) << each.section;
}

/// One fault each in a run that otherwise shows all.
TEST(RobhazStudy, EachRuleNoticesItsFault) {
  const auto holds = [](std::size_t section, auto&& spoil) {
    CourseRun run = course_study().runs.front();
    for (CourseSample& s : run.samples) spoil(s);
    return judge_course(run).at(section).holds;
  };
  EXPECT_TRUE(holds(kG, [](CourseSample&) {}));
  EXPECT_FALSE(holds(3, [](CourseSample& s) { s.theta = std::abs(s.theta); }));
  EXPECT_FALSE(holds(4, [](CourseSample& s) { s.v *= 0.9; }));
  EXPECT_FALSE(holds(5, [](CourseSample& s) { s.v = std::max(s.v, 0.03); }));
  EXPECT_FALSE(holds(kG, [](CourseSample& s) { s.w += 1e-3; }));
  EXPECT_FALSE(holds(kG, [](CourseSample& s) { s.dead_band_left = 1; }));
  EXPECT_FALSE(holds(kG, [](CourseSample& s) { s.w_cmd = 0; }));
  EXPECT_FALSE(holds(7, [](CourseSample& s) { s.force_left = 0.1; }));
}

TEST(RobhazStudy, AFailureOfAnotherReadingIsPrintedAndNotAsserted) {
  RobhazStudy study = course_study();
  study.findings.back().front().holds = false;
  EXPECT_TRUE(all_hold(study));
  EXPECT_THAT(to_text(study), HasSubstr("does not hold"));
  study.findings.front().front().holds = false;
  EXPECT_FALSE(all_hold(study));
  EXPECT_THAT(to_text(study), HasSubstr("An asserted finding FAILS."));
  EXPECT_EQ(to_json(study)["all_hold"], false);
}

TEST(RobhazCourse, BadCoursesAreRefusedWithTheirPlace) {
  const auto sentence = [](const json& patch) -> std::string {
    json document = json::parse(embedded_robhaz());
    document.merge_patch(patch);
    try {
      robhaz_course_from_json(document);
    } catch (const DocumentError& e) {
      return e.what();
    }
    return "read";
  };
  EXPECT_EQ(sentence(json::object()), "read");
  EXPECT_THAT(sentence({{"hand", {{"turn_compliance", -1}}}}), HasSubstr("hand/turn_compliance"));
  EXPECT_THAT(sentence({{"seconds", 0}}), HasSubstr("seconds"));
  EXPECT_THAT(sentence({{"speed", 1}}), HasSubstr("speed"));
  const json line = {{"stamp", 1}, {"forward", 0}, {"turn", 0}};
  EXPECT_THAT(sentence({{"script", {line, line}}}), HasSubstr("script/1/stamp"));
}

TEST(RobhazCourse, ARefusedStickEndsTheDriveWithTheReason) {
  RobhazCourse course = embedded_robhaz_course();
  try {
    drive_course(course, {{&algo::kStopDistance, 0.2}});
    FAIL() << "the stop distance lies within the hull";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("teleop.d_min"));
  }
}

// ---- The document ----

TEST(RobhazDocument, TheSectionIsReplacedInPlaceAndItsPicturesExist) {
  const fs::path folder = fs::temp_directory_path() / "tautline_robhaz_document";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const fs::path file = folder / "page.md";
  const auto text_of = [](const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  };
  std::ofstream(file) << "# Kept\n";
  write_markdown(course_study(), file);
  const std::string once = text_of(file);
  EXPECT_THAT(once, testing::StartsWith("# Kept\n\n<!-- robhaz study"));
  write_markdown(course_study(), file);
  EXPECT_EQ(text_of(file), once);
  for (const Picture& picture : draw(course_study())) {
    EXPECT_THAT(once, HasSubstr("(pictures/reproduction/" + picture.file + ")"));
    EXPECT_EQ(text_of(folder / "pictures/reproduction" / picture.file), picture.svg);
    EXPECT_EQ(picture.svg.find("nan"), std::string::npos) << picture.file;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace server::reproduce
