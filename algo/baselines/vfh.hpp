// algo/baselines/vfh.hpp: vector field histogram: the cells around the robot give a polar density.
// The robot steers through the free valley nearest to the goal's direction (Borenstein and Koren
// 1991; equations.md F.5).
#pragma once

#include <array>
#include <numbers>
#include <optional>

#include "algo/baselines/baseline.hpp"
#include "algo/baselines/histogram_grid.hpp"

namespace algo {

inline constexpr int kSectors = 72;
inline constexpr double kSectorWidth = 2 * std::numbers::pi / kSectors;  // [rad] 5 degrees

/// Density by sector: sector k holds the bearings [5 k, 5 k + 5) degrees in W, seen from the robot.
using PolarDensity = std::array<double, kSectors>;

int sector_of(double bearing);  // 0..71
double sector_centre(int k);    // [rad] 5 k + 2.5 degrees

/// The density of a sector: the sum over its cells of m = C^2 (a - b d), d in cells, a = b d_max,
/// d_max = sqrt(2) (window - 1) / 2, so that m is 0 in the window's corners; b = 1.
PolarDensity polar_density(const HistogramGrid& grid, const Vec2& robot_W);

/// h'_k = sum over |q| <= l of (l + 1 - |q|) h_{k+q} / (2 l + 1), l = 5, cyclic. The paper prints
/// the weight l for the centre; l + 1 follows from its own sequence.
PolarDensity smooth(const PolarDensity& density);

/// The sector to steer along; nothing if none is below `threshold`. Takes the valley (a cyclic run
/// of free sectors) nearest to `target`; of equals, the one with the lower first sector. In a
/// valley wider than 18 sectors: the target if both borders are 9 sectors away, else 9 sectors in
/// from the border nearest to it. In a narrow valley: its middle.
std::optional<int> steering_sector(const PolarDensity& smoothed, double threshold, int target);

/// v_max (1 - min(h'_c, h_m) / h_m); h'_c is the density straight ahead.
double vfh_speed(double density_ahead, double h_m, double v_max);

class Vfh final : public Baseline {
 public:
  static ParameterList parameters();

 private:
  void forget() override { grid_.clear(); }
  void steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) override;
  void tell(const Telemetry& t, Explanation& words) const override;

  HistogramGrid grid_{};
};

}  // namespace algo
