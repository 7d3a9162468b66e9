// tests/algo/golden.hpp: reads the golden vectors and compares with them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "tests/folders.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "algo/types.hpp"

namespace golden {

using Json = nlohmann::json;

inline constexpr double kMm = 1e-3;  // the vectors' millimetres in metres

/// File `name` of tests/golden, or of the folder TAUTLINE_GOLDEN_DIR names.
inline Json load(const std::string& name) {
  const char* const other = std::getenv("TAUTLINE_GOLDEN_DIR");
  const std::string folder = other != nullptr ? other : (tests::folder() / "golden").string();
  std::ifstream file(folder + "/" + name);
  if (!file) throw std::runtime_error("cannot read " + folder + "/" + name);
  return Json::parse(file);
}

inline double tolerance(const Json& document) {
  return document.value("tolerance", 1e-9);
}

/// Absolute below 1, else relative, in the file's own unit.
inline ::testing::AssertionResult close(double actual, double expected, double tolerance) {
  const double allowed = tolerance * std::max(1.0, std::abs(expected));
  if (std::abs(actual - expected) <= allowed) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << actual << " instead of " << expected << ", off by " << actual - expected;
}

/// A point of the file in mm against one in metres.
inline ::testing::AssertionResult close_mm(const algo::Vec2& actual,
                                           const Json& expected,
                                           double tolerance) {
  for (std::size_t k = 0; k < 2; ++k) {
    auto result =
        close(actual[static_cast<Eigen::Index>(k)] / kMm, expected.at(k).get<double>(), tolerance);
    if (!result) return result << " in coordinate " << k;
  }
  return ::testing::AssertionSuccess();
}

/// The same angle, also across +-pi.
inline ::testing::AssertionResult close_angle(double actual, double expected, double tolerance) {
  return close(algo::wrap_angle(actual - expected), 0.0, tolerance) << " of " << expected;
}

inline algo::Vec2 point_mm(const Json& p) {
  return {p.at(0).get<double>() * kMm, p.at(1).get<double>() * kMm};
}

inline algo::Pose2 pose_mm(const Json& p) {
  return {p.at(0).get<double>() * kMm, p.at(1).get<double>() * kMm, p.at(2).get<double>()};
}

inline std::vector<double> numbers(const Json& list) {
  return list.get<std::vector<double>>();
}

}  // namespace golden
