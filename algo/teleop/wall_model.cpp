// algo/teleop/wall_model.cpp: votes, and the cells that they go to.
#include "algo/teleop/wall_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace algo {
namespace {

constexpr int kThetaCells = 72;
constexpr double kThetaCell = 2 * std::numbers::pi / kThetaCells;
constexpr double kRhoCellsPerMetre = 10;
constexpr std::size_t kRhoCells = 128;  // up to kWallReach
static_assert(static_cast<std::size_t>(kWallReach * kRhoCellsPerMetre) == kRhoCells);
constexpr double kOnLimit = 1e-9;   // [rad] an axis this near to the sector's limit is on it
constexpr double kRounding = 1e-9;  // [m] sums that differ by less are equal, as mirrored ones are

using Row = std::array<int, kRhoCells>;  // votes of the cells of one theta

bool counts(const VotingPoint& point) {
  return point.votes > 0 && point.point_R.allFinite();
}

double theta_edge(int k) {
  return -std::numbers::pi + k * kThetaCell;
}

double rho_centre(std::size_t j) {
  return (static_cast<double>(j) + 0.5) / kRhoCellsPerMetre;
}

/// Gives the votes of `point` to the cells of theta cell `k` that its curve crosses: all between
/// the curve's least and greatest rho there.
void vote(const VotingPoint& point, int k, Row& row) {
  const double at_start = direction(theta_edge(k)).dot(point.point_R);
  const double at_end = direction(theta_edge(k + 1)).dot(point.point_R);
  const double peak = std::atan2(point.point_R.y(), point.point_R.x());
  double most = std::max(at_start, at_end);
  if (peak > theta_edge(k) && peak < theta_edge(k + 1)) most = point.point_R.norm();
  // The curve's trough is opposite to its peak, where no rho is above 0.
  const double least = std::max(0.0, std::min(at_start, at_end));
  if (!(most >= 0) || least >= kWallReach) return;
  const auto cell = [](double rho) { return static_cast<std::size_t>(rho * kRhoCellsPerMetre); };
  const std::size_t last = cell(std::min(most, kWallReach));
  for (std::size_t j = cell(least); j <= last && j < kRhoCells; ++j) {
    row[j] += point.votes;
  }
}

/// [m] Sum over the points of zeta |X cos(theta) + Y sin(theta) - rho|.
double misfit(std::span<const VotingPoint> points, const WallModel& wall) {
  const Vec2 normal = direction(wall.theta);
  double sum = 0;
  for (const VotingPoint& p : points) {
    if (counts(p)) sum += p.votes * std::abs(normal.dot(p.point_R) - wall.rho);
  }
  return sum;
}

struct Best {
  WallModel wall{};
  double misfit = std::numeric_limits<double>::infinity();
};

/// Cells come in rising theta.
void compare(std::span<const VotingPoint> points, WallModel cell, Best& best) {
  cell.ties = 1;
  const bool tie = cell.votes == best.wall.votes;
  if (tie) cell.ties = ++best.wall.ties;
  const double off = misfit(points, cell);
  const bool nearer = cell.rho < best.wall.rho && off <= best.misfit + kRounding;
  if (tie && !nearer && !(off < best.misfit - kRounding)) return;
  best = {cell, off};
}

}  // namespace

void count_votes(std::span<const double> bearings,
                 std::span<const double> distances,
                 const Parameters& parameters,
                 std::span<int> zeta) {
  if (bearings.size() != distances.size() || zeta.size() != distances.size()) {
    throw std::invalid_argument("Votes need one bearing and one distance for each sensor.");
  }
  if (distances.empty()) return;
  const auto nearest = std::ranges::min_element(distances) - distances.begin();
  const double reference = bearings[static_cast<std::size_t>(nearest)];
  const double sector = parameters[kWallSector] + kOnLimit;
  for (std::size_t n = 0; n < zeta.size(); ++n) {
    zeta[n] = std::abs(wrap_angle(reference - bearings[n])) <= sector ? 1 : 0;
  }
  zeta[static_cast<std::size_t>(nearest)] = 2;
}

std::optional<WallModel> find_wall(std::span<const VotingPoint> points) {
  Best best;
  for (int k = 0; k < kThetaCells; ++k) {
    Row row{};
    for (const VotingPoint& point : points) {
      if (counts(point)) vote(point, k, row);
    }
    const double theta = (theta_edge(k) + theta_edge(k + 1)) / 2;
    for (std::size_t j = 0; j < kRhoCells; ++j) {
      if (row[j] == 0 || row[j] < best.wall.votes) continue;
      compare(points, {.rho = rho_centre(j), .theta = theta, .votes = row[j]}, best);
    }
  }
  if (best.wall.votes == 0) return std::nullopt;
  return best.wall;
}

std::optional<WallModel> wall_of_ring(const Ring& ring, const Parameters& parameters) {
  static constexpr auto kBearings = ring_bearings();
  RingReadings distances{};
  std::ranges::transform(
      ring.distances, distances.begin(), [&](double d) { return heard(d, parameters); });
  std::array<int, kRingSonars> zeta{};
  count_votes(kBearings, distances, parameters, zeta);
  std::array<VotingPoint, kRingSonars> points{};
  for (std::size_t n = 0; n < kRingSonars; ++n) {
    const bool echo = distances[n] < parameters[kRingReach];
    points[n] = {distances[n] * direction(ring.bearings[n]), echo ? zeta[n] : 0};
  }
  return find_wall(points);
}

}  // namespace algo
