// drivers/psd_table.cpp: interpolation in a table of measured points.
#include "drivers/psd_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "algo/terrain/psd_curve.hpp"

namespace drivers::psd {

std::optional<std::string> defect(const std::vector<TablePoint>& table) {
  if (table.size() < 2) return "needs two points at least";
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto& [volts, metres] = table[i];
    if (!(volts > 0 && volts <= 5)) return "has a voltage outside of 0 to 5 V";
    if (!(metres >= 0.05 && metres <= 2)) return "has a distance outside of 0.05 to 2 m";
    if (i > 0 && !(metres > table[i - 1].metres && volts < table[i - 1].volts)) {
      return "must go from near to far, with less voltage at each point";
    }
  }
  return std::nullopt;
}

Table::Table(std::vector<TablePoint> points) : points_(std::move(points)) {
  if (const auto wrong = defect(points_)) {
    throw std::invalid_argument("The table of distances " + *wrong + ".");
  }
}

double Table::interpolated(double volts) const {
  // The first point with less voltage ends the part of the curve.
  const auto far = std::ranges::find_if(
      points_.begin() + 1, points_.end() - 1, [&](const TablePoint& p) { return p.volts < volts; });
  const auto near = far - 1;
  const double share = (volts - near->volts) / (far->volts - near->volts);
  const double inverse = std::lerp(1 / near->metres, 1 / far->metres, share);
  return inverse > 0 ? 1 / inverse : std::numeric_limits<double>::infinity();
}

double Table::distance(double volts) const {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  if (!(volts <= algo::kPsdTooNear)) return kNothing;
  const double metres = points_.empty() ? algo::psd_distance(volts) : interpolated(volts);
  return metres >= algo::kPsdNearest && metres <= algo::kPsdFarthest ? metres : kNothing;
}

}  // namespace drivers::psd
