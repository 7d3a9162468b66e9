// tests/algo/allocations.hpp: how often this test program has allocated, to show that a tick does
// not.
#pragma once

#include <cstddef>

namespace allocations {

/// Calls of operator new by this thread so far.
std::size_t count();

}  // namespace allocations
