// algo/terrain/ground_value.hpp: how high, wide or steep the ground ahead is.
//
// Source: Masuda et al. 2008, Eq. 11-14; equations.md H. SI units; the paper has cm and degrees.
#pragma once

#include "algo/ground_sense.hpp"

namespace algo {

/// [m] Height of what the near beam meets: above 0 a step up, below 0 a step down or a trench.
/// `near` is X2, `near_flat` X2o [m]. Eq. 11, 13: (X2o - X2) sin(alpha).
double ground_height(double near, double near_flat, double alpha);

/// [m] How far ahead of the floor's point the near beam ends: the part of a trench's width that it
/// has ahead. Eq. 14: (X2 - X2o) cos(alpha).
double trench_width(double near, double near_flat, double alpha);

/// [rad] Slope of a surface that both beams meet, up positive. Eq. 12 (section 5.4 cites Eq. 9
/// for it): pi/2 - alpha - atan2(X1 - X2, L).
double ground_slope(double far, double near, double separation, double alpha);

}  // namespace algo
