// tests/algo/teleop/golden_robhaz_test.cpp: golden vectors of section G, Eq. 1-10, 28 and 29. Walls
// are in cm and degrees there.
#include <string>
#include <vector>

#include "tests/algo/golden.hpp"
#include <gtest/gtest.h>

#include "algo/teleop/reflected_force.hpp"
#include "algo/teleop/speed_limit.hpp"
#include "algo/teleop/wall_following.hpp"
#include "algo/teleop/wall_model.hpp"

namespace {

using algo::Parameters;
using algo::units::kRadiansPerDegree;
using golden::close;
using golden::Json;

constexpr double kCmPerMetre = 100;

const Json& robhaz_document() {
  static const Json loaded = golden::load("G_robhaz.json");
  return loaded;
}
const Json& vectors(const char* name) {
  const Json& list = robhaz_document().at(name);
  EXPECT_FALSE(list.empty()) << name;
  return list;
}
double robhaz_tolerance() {
  return golden::tolerance(robhaz_document());
}
double metres(const Json& cm) {
  return cm.get<double>() / kCmPerMetre;
}
double radians(const Json& degrees) {
  return degrees.get<double>() * kRadiansPerDegree;
}

TEST(RobhazGolden, SparsenessAndItsSpeed) {
  const Json& list = robhaz_document().at("sparseness");
  Parameters parameters;
  parameters.set(algo::kSparsenessFactor, list.at("gamma"));
  parameters.set(algo::kRingReach, list.at("D_max"));
  parameters.set(algo::kLeastSparseness, list.at("sprs_min"));
  ASSERT_FALSE(list.at("seq").empty());
  for (const Json& vector : list.at("seq")) {
    const auto step = algo::sparseness_step(
        vector.at("sprs"), golden::numbers(vector.at("D")), list.at("v_max"), parameters);
    EXPECT_TRUE(close(step.range, vector.at("A_rng"), robhaz_tolerance()));
    EXPECT_TRUE(close(step.speed, vector.at("v_sprs"), robhaz_tolerance()));
    EXPECT_TRUE(close(step.next, vector.at("sprs_next"), robhaz_tolerance()));
  }
}

/// The same, with the state carried on from one sample to the next.
TEST(RobhazGolden, SparsenessAsAStream) {
  const Json& list = robhaz_document().at("sparseness");
  Parameters parameters;
  parameters.set(algo::kSparsenessFactor, list.at("gamma"));
  parameters.set(algo::kRingReach, list.at("D_max"));
  parameters.set(algo::kLeastSparseness, list.at("sprs_min"));
  double sparseness = list.at("seq").at(0).at("sprs");
  for (const Json& vector : list.at("seq")) {
    const auto step = algo::sparseness_step(
        sparseness, golden::numbers(vector.at("D")), list.at("v_max"), parameters);
    sparseness = step.next;
    EXPECT_TRUE(close(sparseness, vector.at("sprs_next"), robhaz_tolerance()));
  }
}

TEST(RobhazGolden, SpeedBeforeAnObstacle) {
  const double v_max = robhaz_document().at("sparseness").at("v_max");
  for (const Json& vector : vectors("velocity")) {
    Parameters parameters;
    parameters.set(algo::kStopDistance, vector.at("D_min"));
    parameters.set(algo::kSlowingGain, vector.at("eta"));
    const double v = algo::slowed_speed(vector.at("v_cmd"),
                                        vector.at("v_sprs"),
                                        golden::numbers(vector.at("D")),
                                        v_max,
                                        parameters);
    EXPECT_TRUE(close(v, vector.at("v"), robhaz_tolerance()));
  }
}

TEST(RobhazGolden, Votes) {
  const Json& vector = vectors("weights");
  std::vector<double> bearings;
  for (const Json& angle : vector.at("angles")) bearings.push_back(radians(angle));
  Parameters parameters;
  parameters.set(algo::kWallSector, radians(vector.at("theta_sr")));
  std::vector<int> zeta(bearings.size());
  algo::count_votes(bearings, golden::numbers(vector.at("D")), parameters, zeta);
  EXPECT_EQ(zeta, vector.at("zeta").get<std::vector<int>>());
}

/// The first vector is the worked example of the paper's Fig. 2: 95 cm, -62.5 degrees, 5 votes.
TEST(RobhazGolden, ModifiedHoughTransform) {
  const Json& list = robhaz_document().at("hough");
  ASSERT_EQ(list.at("alpha_deg"), 5.0);
  ASSERT_EQ(list.at("beta_cm"), 10.0);
  ASSERT_FALSE(list.at("vectors").empty());
  for (const Json& vector : list.at("vectors")) {
    std::vector<algo::VotingPoint> points;
    for (std::size_t n = 0; n < vector.at("points").size(); ++n) {
      const Json& p = vector.at("points").at(n);
      points.push_back({{metres(p.at(0)), metres(p.at(1))}, vector.at("weights").at(n)});
    }
    const auto wall = algo::find_wall(points);
    const Json& out = vector.at("out");
    ASSERT_TRUE(wall);
    EXPECT_TRUE(close(wall->rho * kCmPerMetre, out.at("rho"), robhaz_tolerance()));
    EXPECT_TRUE(close(wall->theta / kRadiansPerDegree, out.at("theta"), robhaz_tolerance()));
    EXPECT_EQ(wall->votes, out.at("votes"));
    EXPECT_EQ(wall->ties, out.at("ties"));
  }
}

void expect_turn(const Json& vector, const std::string& name, algo::WallLaw law) {
  Parameters parameters;
  parameters.set(algo::kWallDistance, metres(vector.at("D_ref")));
  parameters.set(algo::kWallSector, radians(vector.at("theta_sr")));
  const algo::WallModel wall{.rho = metres(vector.at("rho")), .theta = radians(vector.at("theta"))};
  const auto turn = algo::follow_wall(wall, radians(vector.at("w_max")), parameters, law);
  const Json& out = vector.at(name);
  EXPECT_TRUE(close(turn.offset * kCmPerMetre, out.at("D_diff"), robhaz_tolerance())) << name;
  EXPECT_TRUE(close(turn.aside / kRadiansPerDegree, out.at("theta_wall"), robhaz_tolerance()))
      << name;
  EXPECT_TRUE(close(turn.xi_1, out.at("xi1"), robhaz_tolerance())) << name;
  EXPECT_TRUE(close(turn.xi_2, out.at("xi2"), robhaz_tolerance())) << name;
  EXPECT_TRUE(close(turn.omega / kRadiansPerDegree, out.at("omega"), robhaz_tolerance())) << name;
}

TEST(RobhazGolden, FollowsAWallInBothReadings) {
  for (const Json& vector : vectors("wall")) {
    expect_turn(vector, "corrected", algo::WallLaw::Corrected);
    expect_turn(vector, "literal", algo::WallLaw::Literal);
  }
}

/// Eq. 28, 29: the band between the bounds on the turn rate.
TEST(RobhazGolden, BandBetweenTwoBounds) {
  for (const Json& vector : vectors("turnover")) {
    const Json& out = vector.at("out");
    const auto band = algo::band_between(out.at("w_lb"), out.at("w_ub"), vector.at("w_max"));
    EXPECT_TRUE(close(band.offset, out.at("q_offset"), robhaz_tolerance()));
    EXPECT_TRUE(close(band.half_width, out.at("W_DB"), robhaz_tolerance()));
  }
}

TEST(RobhazGolden, Force) {
  constexpr double kBangBang = 0;
  for (const Json& vector : vectors("force")) {
    const algo::ForceBand band{.offset = vector.at("q_offset"), .half_width = vector.at("W_DB")};
    const algo::ForceLevels levels{.above = vector.at("F_P"), .below = vector.at("F_N")};
    const double force = algo::reflected_force(vector.at("q"), band, levels, kBangBang);
    EXPECT_TRUE(close(force, vector.at("F"), robhaz_tolerance()));
  }
}

}  // namespace
