// tests/algo/terrain/tilt_prediction_test.cpp: the prediction against ground whose shape is known.
#include "algo/terrain/tilt_prediction.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "algo/units.hpp"

namespace {

using algo::Attitude;
using algo::Stance;
using algo::TiltLaw;
using algo::TiltPrediction;
using algo::TrackPoints;
using algo::Vec3;
using namespace algo::units;

constexpr Stance kTracks{.mass_height = 0.90, .width = 0.48, .length = 0.60};
constexpr double kDt = 0.025;  // [s]

TEST(TiltPrediction, LevelFrameAndBack) {
  const Attitude attitude{.roll = 8_deg, .pitch = -12_deg};
  const Vec3 p(0.8, -0.2, 0.1);
  EXPECT_NEAR((algo::from_level(attitude, algo::to_level(attitude, p)) - p).norm(), 0, 1e-15);
  EXPECT_GT(algo::to_level({.pitch = -10_deg}, {1, 0, 0}).z(), 0.17);  // nose up
  EXPECT_GT(algo::to_level({.roll = 10_deg}, {0, 1, 0}).z(), 0.17);    // left side up
}

/// On a slope of 20 degrees, nose up: the ground 0.5 m further is 0.5 m nearer after 0.5 m. The
/// print subtracts a level way from a point in the robot's frame.
TEST(TiltPrediction, MovesAPointInTheLevelFrame) {
  const Attitude up{.pitch = -20_deg};
  const Vec3 corrected = algo::moved_into({0.8, 0.1, 0}, up, up, 0.5);
  EXPECT_NEAR((corrected - Vec3(0.3, 0.1, 0)).norm(), 0, 1e-12);
  const Vec3 literal = algo::moved_into({0.8, 0.1, 0}, up, up, 0.5, TiltLaw::Literal);
  EXPECT_NEAR(literal.x(), 0.8 - 0.5 * std::cos(20_deg), 1e-12);
  EXPECT_NEAR(literal.z(), -0.5 * std::sin(20_deg), 1e-12);
  // Both agree where the robot is level.
  const Vec3 flat = algo::moved_into({0.8, 0.1, 0.05}, {}, {}, 0.5);
  EXPECT_EQ(flat, algo::moved_into({0.8, 0.1, 0.05}, {}, {}, 0.5, TiltLaw::Literal));
}

/// Drives level along x, with a line 0.8 m ahead of the robot on ground of the height z(x, y).
struct Straight {
  TiltPrediction prediction{kTracks};
  double x = 0;

  void drive(double way, const std::function<double(double, double)>& z, double v = 0.4) {
    const double end = x + way;
    while (x < end) {
      prediction.move({v, 0}, 0, {}, kDt);
      x += v * kDt;
      const auto point = [&](double y) { return Vec3(0.8, y, z(x + 0.8, y)); };
      prediction.take({point(0.24), point(-0.24)});
    }
  }
  /// The prediction nearest to `ahead` [m].
  Attitude at(double ahead) const {
    Attitude found;
    double best = 1;
    prediction.within(0.9, [&](const algo::PredictedTilt& there) {
      if (std::abs(there.ahead - ahead) > best) return;
      best = std::abs(there.ahead - ahead);
      found = there.attitude;
    });
    EXPECT_LT(best, 0.03) << "nothing is predicted " << ahead << " m ahead";
    return found;
  }
};

TEST(TiltPrediction, FindsABankAtItsPlace) {
  Straight robot;
  robot.drive(2, [](double x, double y) { return x > 2.2 ? y * std::tan(10_deg) : 0.0; });
  EXPECT_NEAR(robot.at(0.7).roll, 10_deg, 1e-3);
  EXPECT_NEAR(robot.at(0.1).roll, 0, 1e-3);
  EXPECT_NEAR(robot.at(0.7).pitch, 0, 1e-3);
}

/// The whole slope is predicted once both lines lie on it, a track's length apart.
TEST(TiltPrediction, FindsASlopeNoseUp) {
  Straight robot;
  robot.drive(3, [](double x, double) { return x > 2 ? (x - 2) * std::tan(10_deg) : 0.0; });
  EXPECT_NEAR(robot.prediction.newest()->attitude.pitch, -10_deg, 1e-3);
  EXPECT_NEAR(robot.prediction.newest()->ahead, 0.8, 1e-9);
}

/// In the corrected reading the robot may be on the slope itself.
TEST(TiltPrediction, SeesNoChangeOnAnEvenSlope) {
  TiltPrediction prediction(kTracks);
  const Attitude up{.roll = 0, .pitch = -15_deg};
  for (int k = 0; k < 200; ++k) {
    prediction.move({0.5, 0}, 0, up, kDt);
    prediction.take({{0.8, 0.24, 0}, {0.8, -0.24, 0}});
  }
  EXPECT_NEAR(prediction.newest()->attitude.pitch, -15_deg, 1e-9);
  EXPECT_NEAR(prediction.height(), 200 * 0.5 * kDt * std::sin(15_deg), 1e-9);
  int lines = 0;
  prediction.within(0.5, [&](const algo::PredictedTilt& there) {
    ++lines;
    EXPECT_NEAR(there.attitude.pitch, -15_deg, 1e-9);
    EXPECT_NEAR(there.attitude.roll, 0, 1e-9);
  });
  EXPECT_GT(lines, 10);
}

TEST(TiltPrediction, TakesAWallForNoGround) {
  Straight robot;
  robot.drive(1.5, [](double, double) { return 0; });
  // Every centimetre driven, the line climbs two on a wall that stays where it is.
  for (int k = 0; k < 25; ++k) {
    robot.prediction.move({0.4, 0}, 0, {}, kDt);
    const double d = 0.01 * (k + 1);
    robot.prediction.take({{0.8 - d, 0.24, 2 * d}, {0.8 - d, -0.24, 2 * d}});
  }
  EXPECT_FALSE(robot.prediction.newest());
  robot.prediction.within(0.9, [](const algo::PredictedTilt& there) {
    EXPECT_LT(std::abs(there.attitude.pitch), 8_deg);
  });
}

/// A robot that has turned aside no longer drives onto what it saw ahead.
TEST(TiltPrediction, ForgetsWhatIsNoLongerAhead) {
  Straight robot;
  robot.drive(1, [](double, double y) { return y * std::tan(10_deg); });
  int ahead = 0;
  robot.prediction.within(0.5, [&](const algo::PredictedTilt&) { ++ahead; });
  EXPECT_GT(ahead, 5);
  for (int k = 0; k < 60; ++k) robot.prediction.move({0, 1}, 0.025 * k, {}, kDt);
  robot.prediction.within(0.8,
                          [](const algo::PredictedTilt& there) { EXPECT_LT(there.ahead, 0.25); });
}

/// Lines that come while the robot stands replace each other: those of the way stay.
TEST(TiltPrediction, KeepsItsLinesWhileItStands) {
  Straight robot;
  robot.drive(1, [](double x, double y) { return x > 1.5 ? y * std::tan(6_deg) : 0.0; });
  for (int k = 0; k < 1000; ++k) {
    robot.prediction.move({}, 0, {}, kDt);
    robot.prediction.take({{0.8, 0.24, 0.025}, {0.8, -0.24, -0.025}});
  }
  EXPECT_NEAR(robot.at(0.55).roll, 6_deg, 2e-3);
  EXPECT_NEAR(robot.at(0.1).roll, 0, 1e-3);
}

}  // namespace
