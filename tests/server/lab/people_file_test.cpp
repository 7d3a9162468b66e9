// tests/server/lab/people_file_test.cpp: recordings of people, good and bad.
#include "server/lab/crowd/people_file.hpp"

#include <sstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace server::crowd {
namespace {

using ::testing::HasSubstr;

Recording people_in(const std::string& text) {
  std::istringstream lines(text);
  return read_people(lines, "square.txt");
}

std::string people_fault(const std::string& text) {
  try {
    people_in(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST(PeopleFile, ReadsEachPersonAsTheyWalk) {
  const Recording square = people_in(
      "0\t7.0\t1.5\t-2\n"
      "10 8 4 4\r\n"
      "\n"
      "20 7.0 3.5 2\n"
      "10.0 7.0 2.5 -2\n");
  ASSERT_EQ(square.walkers.size(), 2U);
  const Walker& seven = square.walkers[0];
  EXPECT_EQ(seven.id, "7.0");
  EXPECT_DOUBLE_EQ(seven.from(), 0);
  EXPECT_DOUBLE_EQ(seven.until(), 0.8) << "25 frames are a second";
  EXPECT_TRUE(seven.at(0.2).isApprox(algo::Vec2(2, -2)));
  EXPECT_TRUE(seven.at(0.6).isApprox(algo::Vec2(3, 0)));
  EXPECT_TRUE(seven.there(0.8));
  EXPECT_FALSE(seven.there(0.81));
  EXPECT_TRUE(square.walkers[1].there(0.4)) << "in one frame alone";
  EXPECT_DOUBLE_EQ(square.until, 0.8);
  EXPECT_EQ(square.low, algo::Vec2(1.5, -2));
  EXPECT_EQ(square.high, algo::Vec2(4, 4));
}

TEST(PeopleFile, ARepeatedLineCountsOnce) {
  const Recording square = people_in("0 1 2 3\n10 1 3 3\n0 1 2.0 3\n10 1 3 3\n10 1 3 3\n");
  ASSERT_EQ(square.walkers.size(), 1U);
  EXPECT_EQ(square.walkers[0].keys.size(), 2U);
}

TEST(PeopleFile, AByteOrderMarkIsNoPartOfTheFirstFrame) {
  EXPECT_EQ(people_in("\xEF\xBB\xBF"
                      "0 1 2 3\n")
                .walkers.size(),
            1U);
  EXPECT_THAT(people_fault("0 1 2 3\n\xEF\xBB\xBF"
                           "1 1 2 3\n"),
              HasSubstr("no number of a frame"));
}

TEST(PeopleFile, SaysWhichLineIsWrong) {
  EXPECT_THAT(people_fault("0 1 2 3\n0 2 3\n"), HasSubstr("square.txt, line 2: 3 words"));
  EXPECT_THAT(people_fault("zero 1 2 3\n"), HasSubstr("line 1: 'zero' is no number of a frame"));
  EXPECT_THAT(people_fault("0 1 2 nan\n"), HasSubstr("'2 nan' is no place"));
  EXPECT_THAT(people_fault("0 1 2 1e300\n"), HasSubstr("no place"));
  EXPECT_THAT(people_fault("0 1 2 3x\n"), HasSubstr("no place"));
  EXPECT_THAT(
      people_fault("0 1 2 3\n5 1 2 3\n0 1 4 5\n"),
      HasSubstr("square.txt, line 3: person 1 is at another place in frame 0 than in line 1"));
  EXPECT_THAT(people_fault("\n \n"), HasSubstr("holds nobody"));
  EXPECT_THROW(read_people(std::filesystem::path("/no/such/file")), std::runtime_error);
  EXPECT_THROW(read_people(std::filesystem::temp_directory_path()), std::runtime_error);
}

}  // namespace
}  // namespace server::crowd
