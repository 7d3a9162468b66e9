// tests/server/experiment/statistics_golden.hpp: the values of scipy and numpy
// (tests/golden/statistics.py).
#pragma once

#include "tests/algo/golden.hpp"
#include <gtest/gtest.h>

namespace server::experiment {

inline const golden::Json& values() {
  static const golden::Json document = golden::load("statistics.json");
  return document;
}

inline testing::AssertionResult close(double actual, const golden::Json& expected) {
  return golden::close(actual, expected.get<double>(), golden::tolerance(values()));
}

}  // namespace server::experiment
