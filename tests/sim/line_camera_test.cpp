// tests/sim/line_camera_test.cpp: the simulated laser line and the inclinometer.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "algo/units.hpp"
#include "server/run/robot_library.hpp"
#include "sim/inclinometer_model.hpp"
#include "sim/line_camera_model.hpp"
#include "sim/world.hpp"

namespace sim {
namespace {

using algo::Vec3;
using namespace algo::units;

LineCameraConfig exact_camera() {
  LineCameraConfig config = *server::builtin_robot("robhaz").sensors.line_camera;
  config.noise = 0;
  config.dropout = 0;
  config.period = 0;
  return config;
}

/// Eq. 11 and 12, written out once more.
Vec3 point_R(const algo::LineCamera& c, const algo::LinePixel& pixel) {
  const double scale = c.baseline / (c.focal / std::tan(c.angle) + pixel.v);
  const double x = scale * c.focal;
  const double z = scale * pixel.v;
  return {c.x + std::cos(c.pitch) * x + std::sin(c.pitch) * z,
          scale * pixel.u,
          c.height - std::sin(c.pitch) * x + std::cos(c.pitch) * z};
}

struct Seen {
  explicit Seen(const LineCameraConfig& config, std::uint64_t seed = 1) : camera(config, seed) {}
  algo::Observation& look(double stamp = 0) {
    observation.clear_sensors();
    observation.stamp = stamp;
    trail.reset(vehicle.pose_W, stamp);
    const Surroundings around{stamp, vehicle, trail, obstacles};
    camera.sense(around, observation);
    return observation;
  }

  LineCameraModel camera;
  VehicleState vehicle{};
  PoseTrail trail{0.01, 1};
  ObstacleSet obstacles{};
  algo::Observation observation{};
};

TEST(LineCamera, SeesItsLineOnFlatGroundWhereItShould) {
  const LineCameraConfig config = exact_camera();
  Seen seen(config);
  seen.vehicle.pose_W = {3, -2, 1.1};
  const auto& line = seen.look().line;
  ASSERT_TRUE(line.fresh);
  ASSERT_EQ(line.pixels.size(), LineCameraModel::kColumns);
  for (const algo::LinePixel& pixel : line.pixels) {
    const Vec3 p = point_R(config, pixel);
    EXPECT_NEAR(p.x(), 0.8, 0.003);  // half a pixel is 2 mm
    EXPECT_NEAR(p.z(), 0, 0.003);
    EXPECT_EQ(pixel.v, std::round(pixel.v));
  }
  EXPECT_GT(point_R(config, line.pixels[0]).y(), 0.24) << "beyond the left track";
  EXPECT_LT(point_R(config, line.pixels[63]).y(), -0.24);
}

/// A tilted robot sees level ground, and a level one a slope.
TEST(LineCamera, MeetsGroundThatIsNotParallelToTheRobot) {
  const LineCameraConfig config = exact_camera();
  Seen tilted(config);
  tilted.vehicle.roll = 5_deg;
  tilted.vehicle.pitch = -4_deg;
  for (const algo::LinePixel& pixel : tilted.look().line.pixels) {
    const Vec3 p = point_R(config, pixel);
    const double y = std::cos(5_deg) * p.y() - std::sin(5_deg) * p.z();
    const double z = std::sin(5_deg) * p.y() + std::cos(5_deg) * p.z();
    EXPECT_NEAR(-std::sin(-4_deg) * p.x() + std::cos(-4_deg) * z, 0, 0.004);
    EXPECT_LT(std::abs(y), 0.5);
  }
  Seen slope(config);
  algo::Obstacle ramp{.id = 1, .pose_W = {0.5 + 2, 0, 0}, .shape = algo::Ramp{4, 3, 0}};
  ramp.height = 4 * std::tan(10_deg);
  slope.camera.add(ramp);
  for (const algo::LinePixel& pixel : slope.look().line.pixels) {
    const Vec3 p = point_R(config, pixel);
    EXPECT_NEAR(p.z(), (p.x() - 0.5) * std::tan(10_deg), 0.004);
  }
  slope.camera.remove(1);
  EXPECT_NEAR(point_R(config, slope.look().line.pixels[30]).z(), 0, 0.003);
}

/// The camera is below the laser: an edge hides from it what the laser lights behind it.
TEST(LineCamera, DoesNotSeeWhatIsHidden) {
  const LineCameraConfig config = exact_camera();
  Seen seen(config);
  algo::Obstacle post{.id = 1, .pose_W = {0.65, 0, 0}, .shape = algo::Box{0.02, 0.2}};
  post.height = 0.2;
  seen.camera.add(post);
  // At 0.65 m the laser's light is 0.27 m high, and the camera's sight of the line 0.14 m.
  const auto& line = seen.look().line;
  for (const algo::LinePixel& pixel : line.pixels) {
    const Vec3 p = point_R(config, pixel);
    const bool behind = std::abs(p.y()) < 0.07 && p.x() > 0.74;
    EXPECT_FALSE(behind) << p.transpose();
  }
  EXPECT_LT(line.pixels.size(), LineCameraModel::kColumns);
  EXPECT_GT(line.pixels.size(), 30U);
}

TEST(LineCamera, HasTheErrorsOfItsFile) {
  LineCameraConfig config = exact_camera();
  config.noise = 0.5;
  config.dropout = 0.02;
  config.period = 0.05;
  Seen seen(config);
  double sum = 0;
  double squares = 0;
  std::size_t count = 0;
  int images = 0;
  const double exact = 600 * 0.0027865 / 0.65069;  // the line at 0.8 m
  for (int k = 0; k < 2000; ++k) {
    const auto& line = seen.look(0.025 * k).line;
    if (!line.fresh) continue;
    ++images;
    for (const algo::LinePixel& pixel : line.pixels) {
      sum += pixel.v - exact;
      squares += (pixel.v - exact) * (pixel.v - exact);
      ++count;
    }
  }
  EXPECT_EQ(images, 1000);
  EXPECT_NEAR(static_cast<double>(count) / 64000, 0.98, 0.003);
  EXPECT_NEAR(sum / static_cast<double>(count), 0, 0.1);
  // Noise of 0.5, and a pixel's 1 / sqrt(12).
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(count)), 0.58, 0.02);
}

TEST(LineCamera, TheSameSeedSeesTheSame) {
  const auto pixels = [](std::uint64_t seed) {
    LineCameraConfig config = exact_camera();
    config.noise = 0.5;
    Seen seen(config, seed);
    std::vector<float> out;
    for (const algo::LinePixel& pixel : seen.look().line.pixels) out.push_back(pixel.v);
    return out;
  };
  EXPECT_EQ(pixels(4), pixels(4));
  EXPECT_NE(pixels(4), pixels(5));
}

TEST(LineCamera, RefusesNonsense) {
  LineCameraConfig config = exact_camera();
  config.angle = 0;
  EXPECT_THROW(LineCameraModel(config, 1), std::invalid_argument);
  EXPECT_EQ(*defect(config), "angle_deg must be between 0 and 90");
}

TEST(InclinometerModel, LagsAndHasNoise) {
  VehicleState vehicle;
  PoseTrail trail(0.01, 1);
  const ObstacleSet obstacles;
  algo::Observation observation;
  InclinometerModel exact({.noise = 0, .lag = 0.05}, 1);
  const auto read = [&](InclinometerModel& model, double stamp) {
    const Surroundings around{stamp, vehicle, trail, obstacles};
    model.sense(around, observation);
    return observation.inclinometer;
  };
  EXPECT_EQ(read(exact, 0)->roll, 0);
  vehicle.roll = 0.1;
  vehicle.pitch = -0.2;
  EXPECT_NEAR(read(exact, 0.05)->roll, 0.1 * (1 - std::exp(-1.0)), 1e-12);
  EXPECT_NEAR(observation.inclinometer->pitch, -0.2 * (1 - std::exp(-1.0)), 1e-12);

  InclinometerModel noisy({.noise = 0.2_deg, .lag = 0, .period = 0.1}, 1);
  double squares = 0;
  int readings = 0;
  for (int k = 0; k < 20000; ++k) {
    const auto got = read(noisy, 0.01 * k);
    if (!got) continue;
    ++readings;
    squares += (got->roll - 0.1) * (got->roll - 0.1);
  }
  EXPECT_EQ(readings, 2000);
  EXPECT_NEAR(std::sqrt(squares / readings) / kRadiansPerDegree, 0.2, 0.01);
}

/// The spec tells the pipeline what the robot stands on, where there is something to fall by.
TEST(TallRobot, HasAStanceInBulletAlone) {
  Scenario scenario;
  scenario.robot = server::builtin_robot("robhaz_tall");
  const World world(scenario, 1);
  ASSERT_TRUE(world.spec().stance);
  EXPECT_EQ(*world.spec().stance, (algo::Stance{0.90, 0.48, 0.60}));
  ASSERT_TRUE(world.spec().line);
  EXPECT_EQ(world.spec().line->columns, 640);
  scenario.physics = PhysicsKind::Kinematic;
  EXPECT_FALSE(World(scenario, 1).spec().stance);
  scenario.robot = server::builtin_robot("jackal");
  scenario.physics = PhysicsKind::Bullet;
  EXPECT_FALSE(World(scenario, 1).spec().stance);
}

/// stop() on a robot that would tip over leaves it its ramp.
TEST(TallRobot, StopsByItsRamp) {
  for (const char* name : {"robhaz_tall", "jackal"}) {
    Scenario scenario;
    scenario.robot = server::builtin_robot(name);
    World world(scenario, 1);
    algo::Observation seen;
    world.reset(seen);
    for (int k = 0; k < 80; ++k) world.step({.base = {0.8, 0}}, seen);
    world.stop();
    double hardest = 0;
    double before = seen.odometry.twist.v;
    double most_pitch = 0;
    for (int k = 0; k < 60; ++k) {
      world.step({}, seen);
      hardest = std::max(hardest, (before - seen.odometry.twist.v) / scenario.period);
      before = seen.odometry.twist.v;
      most_pitch = std::max(most_pitch, std::abs(world.state().pitch));
    }
    if (scenario.robot.sensors.inclinometer) {
      EXPECT_LT(hardest, 1.1) << name;
      EXPECT_LT(most_pitch, 1_deg);
    } else {
      EXPECT_GT(hardest, 5) << name << " stops at once, as before";
    }
    EXPECT_NEAR(before, 0, 1e-3);
  }
}

}  // namespace
}  // namespace sim
