// algo/full_strip/step_cost.hpp: what a metre of way costs.
#pragma once

#include <algorithm>

namespace algo {

/// One cost that rises towards things, without a step: 1 where there is room, more from 0.7 m of
/// clearance down, and much more where the hull barely fits.
struct StepCost {
  double half_width = 0;  // [m] of the hull
  double least = 0;       // [m] clearance below which there is no way

  /// Of a hull of `half_width` [m]; a `round` one has no other width.
  static StepCost of_hull(double half_width, bool round) {
    constexpr double kRoundRoom = 0.02;  // [m] beside a disc, whose clearance is measured exactly
    constexpr double kRoom = 0.01;       // [m] beside another hull, on a lattice that errs
    return {.half_width = half_width, .least = half_width + (round ? kRoundRoom : kRoom)};
  }

  static constexpr double kComfort = 0.7;  // [m] clearance above which more is not worth a detour
  static constexpr double kFull = 0.5;     // [m] less than kComfort: kCrowded more,
  static constexpr double kCrowded = 3;    // [m per m]
  static constexpr double kEasy = 0.08;    // [m] beside the hull; less needs care
  static constexpr double kTight = 12;     // [m per m] more where nothing is left beside the hull
  static constexpr double kUnseen = 1.3;   // times the cost where no beam has been
  static constexpr double kUndrawn = 2;    // times the cost where a known map shows nothing either
  static constexpr double kDrawn = 1.1;    // times the cost where a map alone shows free space
  static constexpr double kDrawnWall =
      30;                               // [m per m] more where a map alone shows too little room
  static constexpr double kDoubt = 30;  // [m per m] more where something may stand

  /// [m per m] with clearance `d` [m].
  double of(double d) const {
    const double lacking = std::max(0.0, kComfort - d) / kFull;
    const double tight = std::clamp((kEasy - (d - half_width)) / kEasy, 0.0, 1.0);
    return 1 + kCrowded * lacking * lacking + kTight * tight * tight;
  }
};

}  // namespace algo
