// algo/baselines/go_to_goal.hpp: drives straight at the goal, whatever is in between.
#pragma once

#include "algo/baselines/baseline.hpp"

namespace algo {

/// The least a comparison can be held against: no scan is read.
class GoToGoal final : public Baseline {
  void forget() override {}
  void steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;
  void tell(const Telemetry& t, Explanation& words) const override;
};

}  // namespace algo
