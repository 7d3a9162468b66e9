// tests/algo/allocations_test.cpp: the allocation counter works.
#include "tests/algo/allocations.hpp"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace {

struct alignas(64) Wide {
  double number = 0;
};

/// Without a working counter, tests that expect no allocation could not fail.
TEST(Allocations, AreCounted) {
  const std::size_t before = allocations::count();
  std::vector<double> grows;
  grows.push_back(1);
  EXPECT_EQ(allocations::count(), before + 1);
  const auto wide = std::make_unique<Wide>();
  EXPECT_EQ(wide->number, 0);
  EXPECT_EQ(allocations::count(), before + 2);
}

}  // namespace
