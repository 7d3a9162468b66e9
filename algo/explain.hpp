// algo/explain.hpp: one sentence for what the robot is doing, one for why, with the numbers.
#pragma once

#include <string>

#include "algo/telemetry.hpp"

namespace algo {

struct Explanation {
  std::string what{};
  std::string why{};
};

/// A pure function of the tick, so that the live page, the record and a replay say the same.
Explanation explain(const Telemetry& t);
/// The same for what keeps real hardware still, which is known without a tick too.
Explanation explain(Halt halt);

}  // namespace algo
