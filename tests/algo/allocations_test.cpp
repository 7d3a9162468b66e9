// tests/algo/allocations_test.cpp: replaces operator new of the whole test program by one that
// counts.
#include "tests/algo/allocations.hpp"

#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include <gtest/gtest.h>

namespace {

thread_local std::size_t allocated = 0;

}  // namespace

namespace allocations {

std::size_t count() {
  return allocated;
}

}  // namespace allocations

void* operator new(std::size_t size) {
  ++allocated;
  if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocated;
  const auto step = static_cast<std::size_t>(alignment);
  if (void* const memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace {

struct alignas(64) Wide {
  double number = 0;
};

/// The counter itself counts, or the tests that expect no allocation could not fail.
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
