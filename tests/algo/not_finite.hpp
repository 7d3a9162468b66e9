// tests/algo/not_finite.hpp: the numbers that no law may pass on, under short names.
#pragma once

#include <limits>

namespace tests {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInf = std::numeric_limits<double>::infinity();

}  // namespace tests
