// tests/drivers/published_senses_test.cpp: readings that a process beside the robot publishes.
#include "drivers/published_senses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/drivers/fake_robot.hpp"
#include "tests/drivers/robot_error.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/robot_file.hpp"

namespace drivers {
namespace {

using ::testing::HasSubstr;

const algo::LineCamera kCamera{0.1, 0.45, 0.3, 0.2, 0.6, 600, 640, 480};

struct Published {
  explicit Published(PublishedEntry entry) : senses(entry, kCamera, clock) {}
  algo::Observation seen() {
    algo::Observation out;
    senses.observe(100, out);
    return out;
  }
  std::vector<algo::DeviceReport> report() const {
    std::vector<algo::DeviceReport> out;
    senses.report(out);
    return out;
  }

  double time = 110;
  FakeClock clock{time};
  PublishedSenses senses;
};

TEST(PublishedSenses, AReadingKeepsItsAge) {
  Published p({.inclinometer = true});
  EXPECT_FALSE(p.seen().inclinometer);
  EXPECT_EQ(p.senses.publish_tilt(0.1, -0.2, 0.25), std::nullopt);
  EXPECT_EQ(p.seen().inclinometer, (algo::Inclinometer{9.75, 0.1, -0.2}));
  EXPECT_TRUE(p.report().at(0).well);
  p.time = 113;
  // It grows old and is never made younger.
  EXPECT_EQ(p.seen().inclinometer, (algo::Inclinometer{9.75, 0.1, -0.2}));
  EXPECT_FALSE(p.report().at(0).well);
  EXPECT_EQ(p.report().at(0).sentence, "Its newest reading is 3.2 s old.");
}

TEST(PublishedSenses, AnOlderReadingThanTheNewestIsRefused) {
  Published p({.inclinometer = true});
  EXPECT_EQ(p.senses.publish_tilt(0.1, 0, 0), std::nullopt);
  p.time = 110.1;
  EXPECT_THAT(*p.senses.publish_tilt(0.9, 0, 0.2), HasSubstr("A newer reading"));
  EXPECT_EQ(p.seen().inclinometer->roll, 0.1);
  EXPECT_EQ(p.senses.publish_tilt(0.2, 0, 0.05), std::nullopt);
  EXPECT_EQ(p.seen().inclinometer->roll, 0.2);
}

TEST(PublishedSenses, MeaninglessReadingsAreRefused) {
  Published p({.inclinometer = true, .line = true});
  EXPECT_THAT(*p.senses.publish_tilt(0, 2, 0), HasSubstr("pi/2"));
  EXPECT_THAT(*p.senses.publish_tilt(std::nan(""), 0, 0), HasSubstr("pi/2"));
  EXPECT_THAT(*p.senses.publish_tilt(0, 0, -0.1), HasSubstr("0 to 10 s"));
  EXPECT_THAT(*p.senses.publish_tilt(0, 0, 11), HasSubstr("0 to 10 s"));
  EXPECT_THAT(*p.senses.publish_tilt(0, 0, std::nan("")), HasSubstr("0 to 10 s"));
  const std::vector<algo::LinePixel> outside{{0, 0}, {321, 0}};
  EXPECT_THAT(*p.senses.publish_line(outside, 0), HasSubstr("(321, 0) is outside of the image"));
  const std::vector<algo::LinePixel> unreal{{0, std::numeric_limits<float>::quiet_NaN()}};
  EXPECT_TRUE(p.senses.publish_line(unreal, 0));
  const std::vector<algo::LinePixel> many(PublishedSenses::kMostPixels + 1);
  EXPECT_THAT(*p.senses.publish_line(many, 0), HasSubstr("4096 points at most"));
  EXPECT_FALSE(p.seen().inclinometer);
  EXPECT_FALSE(p.seen().line.fresh);
}

TEST(PublishedSenses, OnlyWhatTheFileNamesIsTaken) {
  Published none({});
  EXPECT_FALSE(none.senses.any());
  EXPECT_THAT(*none.senses.publish_tilt(0, 0, 0), HasSubstr("inclinometer is published"));
  EXPECT_THAT(*none.senses.publish_line({}, 0), HasSubstr("laser line is published"));
  EXPECT_FALSE(none.seen().inclinometer);
  EXPECT_TRUE(none.report().empty());
}

TEST(PublishedSenses, ALineIsObservedOnce) {
  Published p({.line = true});
  const std::vector<algo::LinePixel> pixels{{-320, 1.5F}, {12, -240}};
  EXPECT_EQ(p.senses.publish_line(pixels, 0.02), std::nullopt);
  const algo::Observation seen = p.seen();
  ASSERT_TRUE(seen.line.fresh);
  EXPECT_NEAR(seen.line.stamp, 9.98, 1e-12);
  EXPECT_TRUE(std::ranges::equal(seen.line.pixels, pixels));
  EXPECT_FALSE(p.seen().line.fresh);
  p.time += 0.1;
  EXPECT_EQ(p.senses.publish_line({}, 0), std::nullopt);  // nothing of it is seen
  EXPECT_TRUE(p.seen().line.fresh);
}

/// One that drove on whenever its process is started again would drive off by itself.
TEST(PublishedSenses, ARobotIsArmedWithAnInclinometerOnly) {
  RobotFile file = fake_robot_file();
  file.published.inclinometer = true;
  FakeRobot f(false, file);
  const std::string never = "The inclinometer: Nobody has published a reading yet.";
  f.step();
  EXPECT_EQ(f.robot->health().trouble, never);
  EXPECT_EQ(f.robot->arm(), "It cannot be armed now. " + never);
  EXPECT_EQ(f.robot->publishing()->publish_tilt(0, 0, 0), std::nullopt);
  f.arm();
  f.steps(0.3);
  EXPECT_TRUE(f.moves());
  f.steps(0.3);
  EXPECT_FALSE(f.moves());
  EXPECT_FALSE(f.armed());
  EXPECT_THAT(f.robot->health().trouble, HasSubstr("The inclinometer: Its newest reading is 0."));
  EXPECT_EQ(f.robot->publishing()->publish_tilt(0, 0, 0), std::nullopt);
  f.step();
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(
      f.robot->health().trouble,
      "Motors off. What happened: The inclinometer: Its newest reading is 0.5 s old. It is over "
      "now. Arm it again.");
  f.arm();
  EXPECT_TRUE(f.moves());
}

TEST(PublishedSenses, ARobotOfRealDevicesObservesThem) {
  FakeRobot f;
  EXPECT_EQ(f.robot->publishing(), nullptr);
  double time = 50;
  std::vector<std::unique_ptr<Scanner>> scanners;
  scanners.push_back(std::make_unique<FakeScanner>(time));
  RobotFile file = fake_robot_file();
  file.published.inclinometer = true;
  SerialRobot robot(std::move(file),
                    std::move(scanners),
                    std::make_unique<FakeBase>(time),
                    std::make_unique<FakeClock>(time));
  algo::Observation seen;
  robot.reset(seen);
  ASSERT_NE(robot.publishing(), nullptr);
  EXPECT_EQ(robot.publishing()->publish_tilt(0.1, 0.2, 0), std::nullopt);
  robot.step({}, seen);
  ASSERT_TRUE(seen.inclinometer);
  EXPECT_EQ(seen.inclinometer->pitch, 0.2);
  EXPECT_NEAR(seen.inclinometer->stamp, 0, 1e-9);
  EXPECT_EQ(robot.health().devices.at(1).name, "inclinometer");
}

}  // namespace
}  // namespace drivers
