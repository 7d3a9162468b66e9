// tests/algo/allocations.hpp: how often this program has allocated, to show that a tick does not.
// Needs allocations.cpp in the program.
#pragma once

#include <cstddef>

namespace allocations {

/// Calls of operator new by this thread so far.
std::size_t count();

}  // namespace allocations
