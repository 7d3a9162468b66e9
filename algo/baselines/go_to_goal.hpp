// algo/baselines/go_to_goal.hpp: drives straight at the goal and ignores obstacles.
#pragma once

#include "algo/baselines/baseline.hpp"

namespace algo {

/// The lower bound of every comparison: it reads no scan.
class GoToGoal final : public Baseline {
  void forget() override {}
  void steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;
  void tell(const Telemetry& t, Explanation& words) const override;
};

}  // namespace algo
