// algo/strip/strip.hpp: the elastic strip of three points (start, via, end) and the forces on its
// via.
//
// A "force" is added to a position: it is a length in metres, and K_c and K_r have no unit. The
// sources' tables give lengths in millimetres. Every formula here is the same in both units, except
// the second branch of Eq. 13, see published_factor().
//
// Symbols: reach = d_o of Eq. 2-8 = d_r of Eq. 13 = safety distance + robot radius (the thesis
// exchanges the names between its sections 4.2 and 4.3, and prints d_r for d_safe and d_o once).
#pragma once

#include <cstdint>

#include "algo/types.hpp"

namespace algo {

/// The point min(v_max period, |target - from|) from `from` towards `target`, with that heading. If
/// the two are the same: the target with heading 0. Source: sibling thesis, get_posi.
Pose2 get_posi(const Vec2& from_W, const Vec2& target_W, double v_max, double period);

/// F_int = K_c (d1 / (d1 + d2) (next - previous) - (via - previous)), d1 = |via - previous|,
/// d2 = |next - via|; zero if d1 + d2 = 0. Pulls the via onto the chord. Exactly zero for a via on
/// the chord, which get_posi always gives.
/// Source: Nong 2008 (thesis), Eq. 2-4, whose Eq. 3-4 swap the indices i and j.
Vec2 internal_force(const Vec2& previous_W, const Vec2& via_W, const Vec2& next_W, double k_c);

/// V_ext = K_r (reach - d)^2 / 2 [m^2] for d < reach, else 0.
/// Source: Choi 2008, Eq. 3; sibling thesis, Eq. 38 (lost in the thesis).
double potential(double distance, double reach, double k_r);

// ---- Sizes of the external force at distance d, in metres ----

/// K_r (reach - d) for d < reach, else 0.
/// Source: Nong 2008 (thesis), Eq. 7 and 8, with the guard that Eq. 7 lacks (beyond the reach the
/// printed form attracts). The text once calls the gain K_c.
double original_factor(double distance, double reach, double k_r);

/// K_r (reach - d) for d < reach, else K_r d / max(d - reach, 10 mm); at most 1000 mm.
/// Source: Nong 2008 (thesis), Eq. 13-14 = Choi 2008, Eq. 6-7. The second branch has a pole at the
/// reach and is a bare number added to a length. Read as millimetres, as here, it is a thin wall
/// outside the reach and about 1 mm elsewhere; read as metres it would throw the strip (0.6, reach
/// 1.35 m, d 2 m: 1.85 m). The 10 mm and the limit are ours.
double published_factor(double distance, double reach, double k_r);

/// published_factor() with the second branch 0.
double linear_factor(double distance, double reach, double k_r);

/// B + K_r (reach - d) for d < reach, else B^2 / (B + K_r (d - reach)), with B = step / 2 > 0.
/// Joins both ideas of Eq. 13 with a continuous slope. Head-on both sides see the obstacle, and
/// 2 B = step balances the goal exactly at the reach. Not in the sources (equations.md E.3).
double c1_factor(double distance, double reach, double k_r, double step);

enum class ForceLaw : std::uint8_t { Original, Published, Linear, C1 };

struct ForceSettings {
  ForceLaw law = ForceLaw::Original;
  double reach = 0;  // [m]
  double k_r = 0;
  double step = 0;  // [m] S; only C1 uses it
};

/// The size [m] of the force by the chosen law.
double force_factor(const ForceSettings& settings, double distance);

/// factor(|p - obstacle|) away from the obstacle. Zero if the two are the same, where no direction
/// exists: the caller must stop the robot.
Vec2 external_force(const ForceSettings& settings, const Vec2& p_W, const Vec2& obstacle_W);

/// The robot's next pose under the forces.
struct StripUpdate {
  Vec2 delta_W{0, 0};  // (P^{j+1} - P_cur) + F
  Pose2 updated{};     // P_cur + Delta, heading along Delta; the pass point
  double turn = 0;     // [rad] from the present to the updated heading
};

/// Delta = (next - current) + F; updated = current + Delta. Delta = 0 keeps the heading.
/// Source: Nong 2008 (thesis), Eq. 9-12. Eq. 12 prints arctan2(Dy/Dx) and adds the present heading.
/// Delta is a vector in W, so atan2(Dy, Dx) already is the heading.
StripUpdate update_strip(const Pose2& current, const Vec2& next_W, const Vec2& force_W);

}  // namespace algo
