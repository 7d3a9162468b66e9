// algo/terrain/ground_class.hpp: what lies ahead, by the two distances of one side.
//
// Source: Masuda et al. 2008, Eq. 5-10; equations.md H. Lengths in metres; the paper has cm.
#pragma once

#include <cstdint>
#include <string_view>

#include "algo/ground_sense.hpp"

namespace algo {

/// The order decides ties of a vote.
enum class GroundClass : std::uint8_t {
  SlopeUp,
  SlopeDown,
  StepUp,
  StepDown,
  Trench,
  Flat,
  Pending,  // only the far beam is on it: drive on
  Unknown,
};
constexpr std::size_t kGroundClasses = 8;

/// "step_up", as documents spell it.
std::string_view name(GroundClass kind);

/// The distances on a level floor: the paper's X1o of the far sensors and X2o of the near ones.
struct FlatRanges {
  double far = 0;   // [m]
  double near = 0;  // [m]
};
/// L is the distance between the beams at right angles to them, so X1o - X2o = L cot(alpha).
FlatRanges flat_ranges(const FloorSensors& sensors);

/// [m] How far a reading may be off before it counts.
struct GroundThresholds {
  double far = 0.008;   // X1T
  double near = 0.005;  // X2T; the paper prints X1T twice
};

/// The class for the differences `far` = X1 - X1o and `near` = X2 - X2o [m]; Unknown for NaN.
/// Of the first rule that holds. Corrected: Eq. 7a lacks "<", Eq. 6 bounds one side only, Eq. 10
/// has the wrong sign, and no rule covers a far beam that is alone on the obstacle (Pending).
GroundClass classify(double far, double near, const GroundThresholds& limits = {});

/// The same for distances [m]. Unknown if one is outside the sensor's range.
GroundClass classify_ranges(double far,
                            double near,
                            const FlatRanges& flat,
                            const GroundThresholds& limits = {});

/// The classes whose rule holds as printed, as bits 1 << GroundClass; for comparison only. Eq. 7a
/// is read with the missing "<". Every step up is also a slope up, and no rule names Pending.
unsigned classify_literal(double far, double near, const GroundThresholds& limits = {});

}  // namespace algo
