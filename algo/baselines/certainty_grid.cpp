// algo/baselines/certainty_grid.cpp: the map: the effect of a reading on the cells in its sector.
#include "algo/baselines/certainty_grid.hpp"

#include <algorithm>
#include <cmath>

namespace algo {
namespace {

constexpr double kTolerance = 0.1;         // [m] [D] e, half the thickness of the arc
constexpr double kSonarWidth = 0.5;        // [rad] [D] whole beam of a sonar, about 30 degrees
constexpr double kSonarNearest = 0.15;     // [m] [D] R_min of a sonar
constexpr std::size_t kLongestArc = 1024;  // cells; no sector within the grid has more

double across(const RangeSector& sector, double a) {
  const double off = 2 * a / sector.width;
  return std::abs(off) <= 1 ? 1 - off * off : 0;
}

}  // namespace

double empty_probability(const RangeSector& sector, double s, double a) {
  const double depth = sector.range - kTolerance - sector.nearest;
  if (!(depth > 0) || s < sector.nearest || s > sector.range - kTolerance) return 0;
  const double along = (s - sector.nearest) / depth;
  return (1 - along * along) * across(sector, a);
}

double occupied_probability(const RangeSector& sector, double s, double a) {
  if (!sector.hit || std::abs(s - sector.range) > kTolerance) return 0;
  const double along = (s - sector.range) / kTolerance;
  return (1 - along * along) * across(sector, a);
}

CertaintyGrid::CertaintyGrid() {
  arc_.reserve(kLongestArc);
}

/// Calls visit(cell, s, a) for every covered cell whose centre lies in the sector: column by column
/// along the grid axis nearest to the sector's axis, between its two edges.
template <typename Visit>
void CertaintyGrid::for_each_in(const RangeSector& sector, Visit&& visit) const {
  const Vec2 apex = sector.mount_W.position();
  const double axis = sector.mount_W.heading;
  const bool along_x = std::abs(std::cos(axis)) >= std::abs(std::sin(axis));
  const auto u = static_cast<Eigen::Index>(along_x ? 0 : 1);  // the axis along the sector
  const Eigen::Index v = 1 - u;
  const double far = sector.range + kTolerance;
  const Vec2 left = direction(axis + sector.width / 2);
  const Vec2 right = direction(axis - sector.width / 2);
  const double sign = direction(axis)[u] >= 0 ? 1 : -1;
  const int columns = static_cast<int>(std::min<double>(kSide, std::ceil(far / kCell)));
  const int start = along_x ? cell_of(apex).i : cell_of(apex).j;
  for (int k = 0; k <= columns; ++k) {
    const int column = start + static_cast<int>(sign) * k;
    const double way = std::max(0.0, sign * ((column + 0.5) * kCell - apex[u]));
    const double a = apex[v] + way * left[v] / std::abs(left[u]);
    const double b = apex[v] + way * right[v] / std::abs(right[u]);
    const int from = whole_below(std::min(a, b) / kCell);
    const int to = whole_below(std::max(a, b) / kCell);
    for (int row = from; row <= to; ++row) {
      const Cell cell = along_x ? Cell{column, row} : Cell{row, column};
      if (!cells_.covers(cell)) continue;
      const Vec2 offset = cells_.centre(cell) - apex;
      const double s = offset.norm();
      if (s <= far) visit(cell, s, wrap_angle(std::atan2(offset.y(), offset.x()) - axis));
    }
  }
}

void CertaintyGrid::add(const RangeSector& sector) {
  arc_.clear();
  float sum = 0;
  for_each_in(sector, [&](Cell cell, double s, double a) {
    Belief& belief = cells_[cell];
    const auto p_empty = static_cast<float>(empty_probability(sector, s, a));
    belief.empty += p_empty - belief.empty * p_empty;
    const auto p_occupied = static_cast<float>(occupied_probability(sector, s, a));
    if (!(p_occupied > 0)) return;
    arc_.push_back({cell, p_occupied * (1 - belief.empty)});
    sum += arc_.back().share;
  });
  if (!(sum > 0)) return;
  for (const ArcCell& each : arc_) {
    float& occupied = cells_[each.cell].occupied;
    const float q = each.share / sum;
    occupied += q - occupied * q;
  }
}

void CertaintyGrid::sense(const ControlInput& in) {
  const Pose2& pose = in.odometry.pose;
  centre_on(pose.position());
  if (!is_new_(*in.scene)) return;
  // A sector that ends narrower than a cell could end between the cells' centres.
  const auto at_least_a_cell = [](double width, double range) {
    return range > 0 ? std::max(width, 2 * std::atan(kCell / (2 * range))) : width;
  };
  const LaserScan& scan = in.scene->scan;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] == Beam::Invalid) continue;
    Pose2 mount = compose(pose, scan.mount_R);
    mount.heading = wrap_angle(mount.heading + scan.angle(i));
    const double width = at_least_a_cell(scan.angle_increment, scan.ranges[i]);
    add({mount, width, scan.ranges[i], 0, scan.status[i] == Beam::Ok});
  }
  if (!lacks_laser(*in.scene)) return;
  for (const RangeReading& reading : in.observation->sonar) {
    if (reading.status == Beam::Invalid) continue;
    const bool hit = reading.status == Beam::Ok;
    const double range = hit ? reading.range : reading.range_max;
    add({compose(pose, reading.mount_R),
         at_least_a_cell(kSonarWidth, range),
         range,
         kSonarNearest,
         hit});
  }
}

void CertaintyGrid::show(Layer& layer) const {
  cells_.show(layer, [](const Belief& belief) {
    if (belief.empty == 0 && belief.occupied == 0) return kUnknownCell;
    return static_cast<std::uint8_t>(std::lround(127 + 127 * belief.value()));
  });
}

}  // namespace algo
