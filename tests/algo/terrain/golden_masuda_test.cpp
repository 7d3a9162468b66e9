// tests/algo/terrain/golden_masuda_test.cpp: golden vectors of section H: slopes, steps, trenches.
#include <string>

#include "tests/algo/golden.hpp"
#include <gtest/gtest.h>

#include "algo/terrain/class_vote.hpp"
#include "algo/terrain/ground_class.hpp"
#include "algo/terrain/ground_value.hpp"
#include "algo/units.hpp"

namespace {

using algo::GroundClass;
using golden::Json;

constexpr double kCm = 0.01;  // the vectors' centimetres in metres
constexpr double kDegree = algo::units::kRadiansPerDegree;

GroundClass class_named(const std::string& text) {
  for (std::size_t k = 0; k < algo::kGroundClasses; ++k) {
    const auto kind = static_cast<GroundClass>(k);
    if (name(kind) == text) return kind;
  }
  throw std::runtime_error("no class is named " + text);
}

TEST(MasudaGolden, Classify) {
  const Json document = golden::load("H_masuda.json");
  ASSERT_FALSE(document.at("classify").empty());
  for (const Json& v : document.at("classify")) {
    const algo::GroundThresholds limits{v.at("X1T").get<double>() * kCm,
                                        v.at("X2T").get<double>() * kCm};
    const auto a = v.at("dX1").get<double>() * kCm;
    const auto b = v.at("dX2").get<double>() * kCm;
    EXPECT_EQ(name(algo::classify(a, b, limits)), v.at("class").get<std::string>()) << v;
  }
}

TEST(MasudaGolden, Slope) {
  const Json document = golden::load("H_masuda.json");
  ASSERT_FALSE(document.at("values").empty());
  for (const Json& v : document.at("values")) {
    const double slope = algo::ground_slope(v.at("X1_minus_X2").get<double>() * kCm,
                                            0,
                                            v.at("L").get<double>() * kCm,
                                            v.at("alpha_deg").get<double>() * kDegree);
    EXPECT_TRUE(golden::close(slope / kDegree, v.at("theta_deg"), golden::tolerance(document)));
  }
}

TEST(MasudaGolden, Height) {
  const Json document = golden::load("H_masuda.json");
  ASSERT_FALSE(document.at("height").empty());
  for (const Json& v : document.at("height")) {
    const double height = algo::ground_height(v.at("X2").get<double>() * kCm,
                                              v.at("X2o").get<double>() * kCm,
                                              v.value("alpha_deg", 45.0) * kDegree);
    EXPECT_TRUE(golden::close(height / kCm, v.at("h_cm"), golden::tolerance(document)));
  }
}

TEST(MasudaGolden, Vote) {
  const Json document = golden::load("H_masuda.json");
  ASSERT_FALSE(document.at("vote").empty());
  for (const Json& v : document.at("vote")) {
    algo::ClassVote vote;
    for (const Json& trial : v.at("trials")) vote.add(class_named(trial.get<std::string>()));
    EXPECT_EQ(name(vote.winner()), v.at("result").get<std::string>()) << v;
  }
}

}  // namespace
