// tests/server/lab/crossing_test.cpp: a robot among recorded people.
#include "server/lab/crowd/crossing.hpp"

#include <numbers>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "server/run/scenario_library.hpp"

namespace server::crowd {
namespace {

/// Two people far aside, who make a scene of 10 x 6 m that lasts 100 s, and `more` lines.
Recording square_with(const std::string& more) {
  std::istringstream lines("0 a 0 0\n2500 a 0 0\n0 b 10 6\n2500 b 10 6\n" + more);
  return read_people(lines, "square.txt");
}

RunSpec crosser() {
  return make_spec(ScenarioLibrary({}, {}).load("people"), {});
}

/// Somebody who walks from `from` to `to` within `seconds`, from the start on.
std::string walk(const algo::Vec2& from, const algo::Vec2& to, double seconds) {
  return fmt::format(
      "0 w {} {}\n{} w {} {}\n", from.x(), from.y(), seconds / kFrameTime, to.x(), to.y());
}

TEST(CrowdCrossing, TheWaysLeadThroughTheMiddleFromEachSide) {
  const Recording square = square_with("");
  const Way east = way_of(square, 0);
  EXPECT_TRUE(east.start_W.position().isApprox(algo::Vec2(0.5, 3)));
  EXPECT_TRUE(east.goal_W.isApprox(algo::Vec2(9.5, 3)));
  EXPECT_DOUBLE_EQ(east.begin, 0);
  const Way north = way_of(square, 1);
  EXPECT_TRUE(north.start_W.position().isApprox(algo::Vec2(5, 0.5)));
  EXPECT_NEAR(north.start_W.heading, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(north.begin, 40.0 / 99, 1e-12);
  EXPECT_TRUE(way_of(square, 2).goal_W.isApprox(algo::Vec2(0.5, 3)));
  EXPECT_TRUE(way_of(square, 99).start_W.position().isApprox(algo::Vec2(5, 5.5)));
  EXPECT_DOUBLE_EQ(way_of(square, 99).begin, 40);
}

TEST(CrowdCrossing, ASceneThatIsTooSmallOrTooShortIsRefused) {
  std::istringstream small("0 a 0 0\n2500 a 1 1\n");
  EXPECT_THROW(way_of(read_people(small, "small"), 0), std::runtime_error);
  std::istringstream brief("0 a 0 0\n25 a 9 9\n");
  try {
    way_of(read_people(brief, "brief"), 0);
    ADD_FAILURE() << "the crossings have no time";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "brief lasts 1 s; the crossings need 60 s");
  }
}

TEST(CrowdCrossing, WithoutPeopleInTheWayItIsThatOfTheRobotAlone) {
  const Recording square = square_with("");
  const Way way = way_of(square, 0);
  const Crossing among = cross(square, way, crosser(), Driver::Controller);
  const Crossing alone = cross(square, way, crosser(), Driver::Alone);
  EXPECT_TRUE(among.crossed);
  EXPECT_NEAR(among.time, alone.time, 0.5);
  EXPECT_EQ(among.contacts_at_rest + (among.moving_contact ? 1 : 0), 0);
  EXPECT_EQ(alone.personal, 0);
  EXPECT_EQ(among.track_W.size(), static_cast<std::size_t>(std::lround(among.time / 0.05)) + 1);
}

TEST(CrowdCrossing, TheSameCrossingTwiceIsTheSame) {
  const Recording square = square_with(walk({8, 1}, {2, 5}, 12));
  const Way way = way_of(square, 0);
  const Crossing one = cross(square, way, crosser(), Driver::Controller);
  EXPECT_EQ(one.track_W, cross(square, way, crosser(), Driver::Controller).track_W);
  EXPECT_TRUE(one.crossed);
}

TEST(CrowdCrossing, SomebodyTooNearAtTheBeginIsLeftOut) {
  const Recording square = square_with(walk({1.5, 3}, {1.5, 3}, 90));
  EXPECT_TRUE(cross(square, way_of(square, 0), crosser(), Driver::Controller).crossed);
}

TEST(CrowdCrossing, SomebodyWhoWalksIntoAStandingRobotIsAContactAtRestAndIsTakenOut) {
  // One stands in the way for good; another comes from the side.
  const Recording square = square_with("0 s 2.6 3\n2500 s 2.6 3\n500 w 1.2 0.5\n1000 w 1.2 5.5\n");
  const Crossing end = cross(square, way_of(square, 0), crosser(), Driver::Standing);
  EXPECT_FALSE(end.moving_contact);
  EXPECT_EQ(end.contacts_at_rest, 1);
  EXPECT_FALSE(end.crossed);
  EXPECT_NEAR(end.time, kMostTime, 0.1);
  EXPECT_GT(end.intrusion, 0);
  EXPECT_GT(end.personal, end.intrusion);
}

/// Two bodies that meet within a tick have bounced apart at its end, and the robot moves then.
TEST(CrowdCrossing, SomebodyWhoRunsIntoAStandingRobotIsAContactAtRest) {
  for (const double speed : {1.0, 1.5, 2.0, 2.5}) {
    const double walk = 5 / speed;  // [s]
    const Recording square =
        square_with("0 s 2.6 3\n2500 s 2.6 3\n" +
                    fmt::format("500 w 1.2 0.5\n{:.0f} w 1.2 5.5\n", 500 + walk / kFrameTime));
    const Crossing end = cross(square, way_of(square, 0), crosser(), Driver::Standing);
    EXPECT_FALSE(end.moving_contact) << "at " << speed << " m/s";
    EXPECT_EQ(end.contacts_at_rest, 1) << "at " << speed << " m/s";
  }
}

}  // namespace
}  // namespace server::crowd
