// tests/algo/allocations.hpp: counts allocations, to show that a tick makes none.
// Needs allocations.cpp in the program.
#pragma once

#include <cstddef>

namespace allocations {

/// Calls of operator new by this thread so far.
std::size_t count();

}  // namespace allocations
