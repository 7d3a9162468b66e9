// tests/algo/baselines/parts_test.cpp: the mathematics of the baseline controllers, part by part.
#include <cmath>
#include <numbers>
#include <random>

#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

#include "algo/baselines/certainty_grid.hpp"
#include "algo/baselines/dwa.hpp"
#include "algo/baselines/edge_detection.hpp"
#include "algo/baselines/histogram_grid.hpp"
#include "algo/baselines/vff.hpp"
#include "algo/baselines/vfh.hpp"
#include "algo/diff_drive.hpp"
#include "algo/parameters.hpp"
#include "algo/pipeline/controllers.hpp"

namespace {

using algo::Vec2;

TEST(RollingGrid, KeepsTheCellsItStillCoversAndDropsTheRest) {
  algo::RollingGrid<int> grid(0.1, 9);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> step(-0.5, 0.5);
  Vec2 p{0, 0};
  grid.centre_on(p);
  for (int k = 0; k < 200; ++k) {
    // Every cell holds its own number; cells that stay covered must keep it.
    const auto number = [](algo::Cell c) { return 1 + 1000 * c.i + c.j; };
    const algo::Cell old = grid.first();
    for (int j = old.j; j < old.j + 9; ++j) {
      for (int i = old.i; i < old.i + 9; ++i) grid[{i, j}] = number({i, j});
    }
    p += Vec2{step(random), step(random)};
    grid.centre_on(p);
    const algo::Cell now = grid.first();
    for (int j = now.j; j < now.j + 9; ++j) {
      for (int i = now.i; i < now.i + 9; ++i) {
        const bool kept = i >= old.i && i < old.i + 9 && j >= old.j && j < old.j + 9;
        ASSERT_EQ((grid[{i, j}]), kept ? number({i, j}) : 0) << i << ' ' << j;
      }
    }
  }
}

TEST(RollingGrid, ACellFarBeyondTheMapIsStillValid) {
  algo::RollingGrid<int> grid(0.1, 9);
  grid.centre_on({1e300, -1e300});
  EXPECT_TRUE(grid.covers(grid.cell_of({1e300, -1e300})));
}

TEST(HistogramGrid, CountsToFifteen) {
  algo::HistogramGrid grid;
  grid.centre_on({0, 0});
  for (int k = 0; k < 40; ++k) grid.add({1.04, 0.01});
  double sum = 0;
  grid.for_each_in_window({0, 0}, [&](const Vec2& offset, double c) {
    sum += c;
    EXPECT_NEAR(offset.x(), 1.05, 1e-12);
  });
  EXPECT_EQ(sum, 15);
}

/// Sonar readings beside a scan are checked too.
TEST(Baseline, ASonarReadingThatIsNotFiniteGivesZero) {
  algo::Scene scene;
  algo::RobotSpec spec;
  spec.radius = 0.35;
  for (const algo::ControllerInfo& about : algo::builtin_controllers().entries()) {
    if (!about.by_sonar) continue;
    algo::Observation observation;
    observation.sonar.push_back({{0.35, 0, 0}, 1, 2.0, 5.0, algo::Beam::Ok});
    algo::ControlInput in;
    in.scene = &scene;
    in.observation = &observation;
    in.spec = &spec;
    in.goal = algo::SetGoal{{4, 0}, std::nullopt};
    const auto controller = algo::builtin_controllers().at(about.name).make();
    controller->reset({});
    algo::ControlOutput out;
    controller->update(in, {}, out);
    EXPECT_GT(out.twist.v, 0) << about.name;
    observation.sonar[0].range = std::nan("");
    controller->update(in, {}, out);
    EXPECT_EQ(out.twist, algo::Twist2{}) << about.name;
    observation.sonar[0].status = algo::Beam::Free;  // then its range is no distance
    controller->update(in, {}, out);
    EXPECT_GT(out.twist.v, 0) << about.name;
  }
}

TEST(Vff, SpeedFallsAgainstThePushAndNotAcrossIt) {
  EXPECT_EQ(algo::vff_speed({0, 0}, 0, 0.5), 0.5);
  EXPECT_NEAR(algo::vff_speed({-2, 0}, 0, 0.5), 0, 1e-12);
  EXPECT_NEAR(algo::vff_speed({0, 3}, 0, 0.5), 0.5, 1e-12);
  EXPECT_NEAR(algo::vff_speed({-1, 1}, 0, 0.5), 0.5 * (1 - std::numbers::sqrt2 / 2), 1e-12);
}

/// Free at `from`..`to` inclusive, cyclic, blocked elsewhere.
algo::PolarDensity valley(int from, int to) {
  algo::PolarDensity density;
  density.fill(1000);
  for (int k = from; k <= to; ++k) density[static_cast<std::size_t>((k + 72) % 72)] = 0;
  return density;
}

TEST(Vfh, SteersByTheWidthOfTheValley) {
  EXPECT_EQ(algo::steering_sector(valley(10, 14), 300, 0), 12) << "narrow: its middle";
  EXPECT_EQ(algo::steering_sector(valley(10, 50), 300, 0), 19) << "wide: 9 in from the border";
  EXPECT_EQ(algo::steering_sector(valley(10, 50), 300, 60), 41);
  EXPECT_EQ(algo::steering_sector(valley(10, 50), 300, 30), 30) << "wide enough: the target";
  EXPECT_EQ(algo::steering_sector(valley(10, 50), 300, 12), 19) << "inside, near the border";
  EXPECT_EQ(algo::steering_sector(valley(-4, 4), 300, 20), 0) << "across sector 0";
  EXPECT_EQ(algo::steering_sector(valley(0, 71), 300, 33), 33) << "all free";
  EXPECT_FALSE(algo::steering_sector(valley(5, 4), 300, 33)) << "none free";
}

TEST(CertaintyGrid, TheProbabilitiesMatchTheFormula) {
  const algo::RangeSector sector{
      .mount_W = {}, .width = 0.5, .range = 2, .nearest = 0.2, .hit = true};
  EXPECT_NEAR(algo::empty_probability(sector, 0.2, 0), 1, 1e-12);
  EXPECT_NEAR(algo::empty_probability(sector, 1.05, 0), 1 - 0.25, 1e-12);
  EXPECT_NEAR(algo::empty_probability(sector, 1.05, 0.125), 0.75 * 0.75, 1e-12);
  EXPECT_EQ(algo::empty_probability(sector, 1.05, 0.26), 0);
  EXPECT_EQ(algo::empty_probability(sector, 1.95, 0), 0);
  EXPECT_NEAR(algo::occupied_probability(sector, 2, 0), 1, 1e-12);
  EXPECT_NEAR(algo::occupied_probability(sector, 2.05, 0), 0.75, 1e-12);
  EXPECT_EQ(algo::occupied_probability(sector, 2.11, 0), 0);
}

TEST(CertaintyGrid, AReadingFillsItsArcToOneAndClearsTheWayToIt) {
  for (const double axis : {0.0, 0.6, 1.5, 2.4, -0.7, -2.0, 3.1}) {
    algo::CertaintyGrid grid;
    grid.centre_on({0, 0});
    grid.add({{0.03, 0.02, axis}, 0.5, 2.0, 0, true});
    double occupied = 0;
    const algo::Cell first = grid.first();
    for (int j = first.j; j < first.j + algo::CertaintyGrid::kSide; ++j) {
      for (int i = first.i; i < first.i + algo::CertaintyGrid::kSide; ++i) {
        occupied += std::max(0.0, grid.certainty({i, j}));
      }
    }
    EXPECT_NEAR(occupied, 1, 1e-4) << axis;
    const Vec2 between = Vec2(0.03, 0.02) + 1.0 * algo::direction(axis);
    EXPECT_LT(grid.certainty(grid.cell_of(between)), -0.5) << axis;
  }
}

TEST(CertaintyGrid, AFreeReadingOccupiesNothing) {
  algo::CertaintyGrid grid;
  grid.centre_on({0, 0});
  grid.add({{}, 0.5, 2.0, 0, false});
  const algo::Cell first = grid.first();
  for (int j = first.j; j < first.j + algo::CertaintyGrid::kSide; ++j) {
    for (int i = first.i; i < first.i + algo::CertaintyGrid::kSide; ++i) {
      EXPECT_LE(grid.certainty({i, j}), 0);
    }
  }
}

TEST(EdgeDetection, FindsTheEdgesOfAPost) {
  algo::LaserScan scan;
  const worlds::World world{{{{2, 0}, 0.3}}, {}};
  worlds::scan_world({}, world, 8.0, scan);
  const algo::EdgePair edges = algo::bounding_edges(scan, 180);
  ASSERT_TRUE(edges.left && edges.right);
  // The tangents lie at asin(0.3 / 2) = 8.63 degrees.
  EXPECT_NEAR(scan.angle(edges.left->beam), std::asin(0.15), 0.009);
  EXPECT_NEAR(scan.angle(edges.right->beam), -std::asin(0.15), 0.009);
  EXPECT_NEAR(edges.left->range, std::sqrt(4 - 0.09), 0.1);
  const Vec2 beside = algo::beside_edge({}, scan, *edges.left, algo::Side::Left);
  EXPECT_NEAR((beside - Vec2(2, 0)).norm(), 0.75, 0.02);
  EXPECT_GT(beside.y(), 0.6);
}

TEST(EdgeDetection, AWallAcrossTheFieldHasNoEdges) {
  algo::LaserScan scan;
  const worlds::World world{{}, {{{1, -9}, {1.1, -9}, {1.1, 9}, {1, 9}}}};
  worlds::scan_world({}, world, 80.0, scan);
  scan.resize(361);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    scan.set_ok(i, 1.0);
  }
  EXPECT_FALSE(algo::bounding_edges(scan, 180).left);
  EXPECT_FALSE(algo::bounding_edges(scan, 180).right);
}

/// [m] driven and [rad] turned until the hull first contains the point, by small steps.
algo::ArcRoom stepped(const algo::Hull& hull, const algo::Twist2& twist, const Vec2& point) {
  const double dt = 1e-3;
  for (int k = 0; k < 8000; ++k) {
    const algo::Pose2 pose = algo::integrate_arc({}, twist, k * dt);
    const Vec2 way = point - pose.position();
    const Vec2 ahead = algo::direction(pose.heading);
    const Vec2 seen{way.dot(ahead), ahead.x() * way.y() - ahead.y() * way.x()};
    const bool in = hull.half_length > 0 ? std::abs(seen.x()) < hull.half_length &&
                                               std::abs(seen.y()) < hull.half_width
                                         : seen.norm() < hull.radius;
    if (in) return {twist.v * k * dt, std::abs(twist.omega) * k * dt};
  }
  return {};
}

TEST(Dwa, ClearanceOnAnArcMatchesSmallSteps) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  std::uniform_real_distribution<double> speed(0.2, 1.0);
  std::uniform_real_distribution<double> turn(-1.5, 1.5);
  int touched = 0;
  for (const algo::Hull& hull : {algo::Hull{0.35, 0, 0}, algo::Hull{0.33, 0.25, 0.2}}) {
    for (int k = 0; k < 300; ++k) {
      const algo::Twist2 twist{k % 10 == 0 ? 0 : speed(random), k % 7 == 0 ? 0 : turn(random)};
      const Vec2 point{place(random), place(random)};
      const algo::ArcRoom small = stepped(hull, twist, point);
      const algo::ArcRoom room = algo::arc_room(hull, twist, point);
      if (std::isinf(small.angle) && std::isinf(small.distance)) continue;  // not within 8 s
      ++touched;
      if (twist.v > 0) {
        EXPECT_NEAR(room.distance, small.distance, 0.004);
      }
      if (twist.omega != 0) {
        EXPECT_NEAR(room.angle, small.angle, 0.02);
      }
    }
  }
  EXPECT_GT(touched, 100);
}

TEST(Dwa, OnlySpeedsThatCanStopAreAdmissible) {
  algo::RobotSpec spec;
  spec.max_acceleration = 0.5;
  spec.max_angular_acceleration = 2;
  const algo::ArcRoom room{0.25, 1};
  EXPECT_TRUE(algo::admissible({0.5, 0}, room, spec, 0));  // 0.5^2 = 2 0.5 0.25
  EXPECT_FALSE(algo::admissible({0.51, 0}, room, spec, 0));
  EXPECT_FALSE(algo::admissible({0.5, 0}, room, spec, 0.01));
  EXPECT_TRUE(algo::admissible({0, 2}, room, spec, 0));
  EXPECT_FALSE(algo::admissible({0, 2.1}, room, spec, 0));
  EXPECT_TRUE(algo::admissible({0, 0}, {0, 0}, spec, 0));
}

TEST(Dwa, TheWindowIsReachableByAccelerationWithinTheLimits) {
  algo::RobotSpec spec;
  spec.max_acceleration = 0.4;
  spec.max_angular_acceleration = 2;
  algo::Parameters parameters;  // 0.3 m/s and 1 rad/s
  const algo::DynamicWindow window = algo::dynamic_window({0.25, -0.2}, spec, parameters);
  EXPECT_NEAR(window.v_from, 0.15, 1e-12);
  EXPECT_NEAR(window.v_to, 0.3, 1e-12);
  EXPECT_NEAR(window.omega_from, -0.7, 1e-12);
  EXPECT_NEAR(window.omega_to, 0.3, 1e-12);
}

}  // namespace
