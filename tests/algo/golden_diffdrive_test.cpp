// tests/algo/golden_diffdrive_test.cpp: golden vectors of section I: differential drive, in SI.
#include <cstdint>

#include "tests/algo/golden.hpp"
#include <gtest/gtest.h>

#include "algo/diff_drive.hpp"

namespace {

using golden::Json;

const Json& diffdrive_document() {
  static const Json loaded = golden::load("I_diffdrive.json");
  return loaded;
}
double diffdrive_tolerance() {
  return golden::tolerance(diffdrive_document());
}

algo::DriveGeometry geometry(const Json& vector) {
  return {vector.at("r"), vector.at("l")};
}

algo::Pose2 pose(const Json& p) {
  return {p.at(0), p.at(1), p.at(2)};
}

void expect_pose(const algo::Pose2& actual, const Json& expected) {
  EXPECT_TRUE(golden::close(actual.x, expected.at(0), diffdrive_tolerance()));
  EXPECT_TRUE(golden::close(actual.y, expected.at(1), diffdrive_tolerance()));
  EXPECT_TRUE(golden::close_angle(actual.heading, expected.at(2), diffdrive_tolerance()));
}

TEST(DiffDriveGolden, ForwardKinematics) {
  ASSERT_FALSE(diffdrive_document().at("fk").empty());
  for (const Json& vector : diffdrive_document().at("fk")) {
    const algo::Twist2 twist =
        algo::forward_kinematics(geometry(vector), {vector.at("q_l"), vector.at("q_r")});
    EXPECT_TRUE(golden::close(twist.v, vector.at("v"), diffdrive_tolerance()));
    EXPECT_TRUE(golden::close(twist.omega, vector.at("w"), diffdrive_tolerance()));
  }
}

TEST(DiffDriveGolden, InverseKinematics) {
  ASSERT_FALSE(diffdrive_document().at("ik").empty());
  for (const Json& vector : diffdrive_document().at("ik")) {
    const algo::WheelSpeeds speeds =
        algo::inverse_kinematics(geometry(vector), {vector.at("v"), vector.at("w")});
    EXPECT_TRUE(golden::close(speeds.left, vector.at("q_l"), diffdrive_tolerance()));
    EXPECT_TRUE(golden::close(speeds.right, vector.at("q_r"), diffdrive_tolerance()));
  }
}

TEST(DiffDriveGolden, Odometry) {
  ASSERT_FALSE(diffdrive_document().at("odometry").empty());
  for (const Json& vector : diffdrive_document().at("odometry")) {
    expect_pose(algo::integrate_arc(
                    pose(vector.at("pose")), {vector.at("v"), vector.at("w")}, vector.at("dt")),
                vector.at("out"));
  }
}

TEST(DiffDriveGolden, Encoder) {
  ASSERT_FALSE(diffdrive_document().at("encoder").empty());
  for (const Json& vector : diffdrive_document().at("encoder")) {
    const algo::WheelCounts counts{vector.at("n_l").get<std::int64_t>(),
                                   vector.at("n_r").get<std::int64_t>()};
    expect_pose(
        algo::integrate_counts(geometry(vector), vector.at("cpr"), pose(vector.at("pose")), counts),
        vector.at("out"));
  }
}

}  // namespace
