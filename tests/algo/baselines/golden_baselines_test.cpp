// tests/algo/baselines/golden_baselines_test.cpp: golden vectors of section F: potential field, VFF
// and VFH.
#include <cmath>
#include <limits>

#include "tests/algo/golden.hpp"
#include <gtest/gtest.h>

#include "algo/baselines/potential_field.hpp"
#include "algo/baselines/vff.hpp"
#include "algo/baselines/vfh.hpp"

namespace {

using algo::Vec2;
using golden::Json;

const Json& baselines_document() {
  static const Json loaded = golden::load("F_baselines.json");
  return loaded;
}
double baselines_tolerance() {
  return golden::tolerance(baselines_document());
}

Vec2 point(const Json& p) {
  return {p.at(0).get<double>(), p.at(1).get<double>()};
}

void expect_point(const Vec2& actual, const Json& expected) {
  EXPECT_TRUE(golden::close(actual.x(), expected.at(0), baselines_tolerance()));
  EXPECT_TRUE(golden::close(actual.y(), expected.at(1), baselines_tolerance()));
}

/// The grid about the robot with C readings in each of the vector's cells.
algo::HistogramGrid grid_of(const Json& vector) {
  EXPECT_EQ(vector.at("cell_m").get<double>(), algo::HistogramGrid::kCell);
  EXPECT_EQ(vector.at("ws").get<int>(), algo::HistogramGrid::kWindow);
  algo::HistogramGrid grid;
  grid.centre_on(point(vector.at("robot")));
  for (const Json& cell : vector.at("cells")) {
    const Vec2 centre =
        Vec2(cell.at(0).get<int>() + 0.5, cell.at(1).get<int>() + 0.5) * algo::HistogramGrid::kCell;
    for (int reading = 0; reading < cell.at(2).get<int>(); ++reading) grid.add(centre);
  }
  return grid;
}

TEST(BaselinesGolden, PotentialField) {
  ASSERT_FALSE(baselines_document().at("apf").empty());
  for (const Json& vector : baselines_document().at("apf")) {
    const algo::PotentialSettings settings{.k_a = vector.at("k"),
                                           .f_max = std::numeric_limits<double>::infinity(),
                                           .eta = vector.at("eta"),
                                           .rho_0 = vector.at("rho0")};
    const Vec2 p = point(vector.at("p"));
    Vec2 force = algo::attraction(settings, p, point(vector.at("goal")));
    for (const Json& obstacle : vector.at("obs")) {
      force += algo::repulsion(settings, p, point(obstacle));
    }
    expect_point(force, vector.at("F"));
  }
}

TEST(BaselinesGolden, Vff) {
  ASSERT_FALSE(baselines_document().at("vff").empty());
  for (const Json& vector : baselines_document().at("vff")) {
    const algo::VffForces forces = algo::vff_forces(grid_of(vector),
                                                    point(vector.at("robot")),
                                                    point(vector.at("goal")),
                                                    vector.at("Fcr"),
                                                    vector.at("Fct"));
    expect_point(forces.repulsion, vector.at("Fr"));
    expect_point(forces.attraction, vector.at("Ft"));
    expect_point(forces.sum(), vector.at("R"));
  }
}

TEST(BaselinesGolden, Vfh) {
  ASSERT_FALSE(baselines_document().at("vfh").empty());
  for (const Json& vector : baselines_document().at("vfh")) {
    const Vec2 robot = point(vector.at("robot"));
    const Vec2 way = point(vector.at("goal")) - robot;
    const algo::PolarDensity density = algo::polar_density(grid_of(vector), robot);
    const algo::PolarDensity smoothed = algo::smooth(density);
    for (std::size_t k = 0; k < density.size(); ++k) {
      EXPECT_TRUE(golden::close(density[k], vector.at("H").at(k), baselines_tolerance())) << k;
      EXPECT_TRUE(golden::close(smoothed[k], vector.at("H_smooth").at(k), baselines_tolerance()))
          << k;
    }
    const int target = algo::sector_of(std::atan2(way.y(), way.x()));
    EXPECT_EQ(target, vector.at("k_target").get<int>());
    const auto sector = algo::steering_sector(smoothed, vector.at("thr"), target);
    ASSERT_TRUE(sector);
    EXPECT_TRUE(golden::close_angle(algo::sector_centre(*sector),
                                    vector.at("steer_deg").get<double>() * algo::kSectorWidth / 5,
                                    baselines_tolerance()));
    const double ahead = smoothed[static_cast<std::size_t>(target)];
    EXPECT_TRUE(golden::close(algo::vfh_speed(ahead, vector.at("hm"), vector.at("vmax")),
                              vector.at("speed"),
                              baselines_tolerance()));
  }
}

}  // namespace
