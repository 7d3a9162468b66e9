// sim/laser_surfaces.cpp: what the surface and the width of the beam do to a reading.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "algo/units.hpp"
#include "sim/laser_model.hpp"

namespace sim {
namespace {

using namespace algo::units;

// The spot: 8 mm wide at the window, spreading by half a degree. Sub-rays lie evenly across it.
constexpr double kSpotHalfWidth = 4_mm;
constexpr double kSpotHalfAngle = 0.25_deg;
constexpr std::array<double, 4> kSubRays{-1, -0.5, 0.5, 1};  // besides the one in the centre

constexpr double kJump = 20_mm;          // between neighbours that may share an edge
constexpr double kMixedGap = 1.2;        // [m] surfaces farther apart are not mixed
constexpr double kNearShareToWin = 0.3;  // of the spot, for the nearer surface to be reported
constexpr double kSpecularCone = 5_deg;  // about the normal, within which a mirror sends light back

/// [m] How far a diffuse surface is seen: 10 m at 10 % reflectivity, at most 80.
double reach(double reflectivity) {
  return std::min(80.0, 10 * std::sqrt(reflectivity / 0.1));
}

}  // namespace

/// The rays across a spot lie beside the beam itself.
void LaserModel::allow_for_spot() {
  if (!config_.mixed_pixels) return;
  spread_.shift += kSpotHalfWidth;
  spread_.turn += kSpotHalfAngle;
}

void LaserModel::note_surfaces() {
  plain_ = true;
  for (std::uint32_t k = 0; k < caster_.size(); ++k) {
    const algo::Obstacle& obstacle = caster_.obstacle(k);
    plain_ = plain_ && !obstacle.specular && reach(obstacle.reflectivity) >= config_.range_max;
  }
}

/// Rays that meet a surface too dark for the distance give no echo; a specular surface looks like
/// nothing at all unless it faces the scanner.
void LaserModel::apply_surfaces(const Rays& rays,
                                std::span<double> ranges,
                                std::span<std::uint32_t> hits) const {
  const bool still = !config_.rolling && !config_.mixed_pixels;  // cast from the pattern itself
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (hits[i] >= kNoEcho) continue;
    const algo::Obstacle& obstacle = caster_.obstacle(hits[i]);
    if (obstacle.specular) {
      const algo::Vec2 o = still ? algo::Vec2(0, 0) : algo::Vec2(rays.x[i], rays.y[i]);
      const algo::Vec2 u = still ? algo::Vec2(ux_[i], uy_[i]) : algo::Vec2(rays.ux[i], rays.uy[i]);
      const algo::Vec2 point_W = algo::to_parent(reference_W_, o + ranges[i] * u);
      const algo::Vec2 way_W = point_W - algo::to_parent(reference_W_, o);
      const algo::Vec2 normal_W = caster_.normal_W(hits[i], point_W);
      if (-way_W.dot(normal_W) < std::cos(kSpecularCone) * way_W.norm()) {
        hits[i] = RangeCaster::kNothing;
        ranges[i] = config_.range_max;
      }
    } else if (ranges[i] > reach(obstacle.reflectivity)) {
      hits[i] = kNoEcho;
      ranges[i] = config_.range_max;
    }
  }
}

/// Notes the beams at an edge: next to one that met something else at another distance. Two beams
/// on one (convex) obstacle have no edge between them, however steeply it recedes.
void LaserModel::mark_edges() {
  edges_.clear();
  flag_edges(ranges_.data(), hits_.data(), ranges_.size(), kJump, edge_flags_.data());
  // Few are: eight are looked at together.
  constexpr std::uint32_t kTogether = sizeof(std::uint64_t);
  for (std::uint32_t first = 0; first + 1 < ranges_.size(); first += kTogether) {
    std::uint64_t together = 0;
    std::memcpy(&together, edge_flags_.data() + first, kTogether);
    if (together == 0) continue;
    for (std::uint32_t i = first; i < first + kTogether && i + 1 < ranges_.size(); ++i) {
      if (edge_flags_[i] == 0) continue;
      if (edges_.empty() || edges_.back() != i) edges_.push_back(i);
      edges_.push_back(i + 1);
    }
  }
}

/// Casts the sub-rays of the beams at edges and replaces their ranges by what the whole spot gives.
void LaserModel::mix_pixels() {
  if (edges_.empty()) return;
  more_.resize(edges_.size() * kSubRays.size());
  more_ranges_.resize(more_.size());
  more_hits_.resize(more_.size());
  std::array<algo::Vec2, kSubRays.size()> turn{};
  for (std::size_t k = 0; k < turn.size(); ++k) {
    turn[k] = algo::direction(kSubRays[k] * kSpotHalfAngle);
  }
  std::size_t ray = 0;
  std::size_t beam = 0;
  for (const std::uint32_t edge : edges_) {
    while (beam <= edge) first_[beam++] = static_cast<std::uint32_t>(ray);
    const double ux = rays_.ux[edge];
    const double uy = rays_.uy[edge];
    for (std::size_t k = 0; k < turn.size(); ++k, ++ray) {
      const double aside = kSubRays[k] * kSpotHalfWidth;
      more_.x[ray] = rays_.x[edge] - aside * uy;
      more_.y[ray] = rays_.y[edge] + aside * ux;
      more_.ux[ray] = turn[k].x() * ux - turn[k].y() * uy;
      more_.uy[ray] = turn[k].y() * ux + turn[k].x() * uy;
    }
  }
  while (beam < first_.size()) first_[beam++] = static_cast<std::uint32_t>(ray);

  caster_.cast_more(more_, first_, config_.range_max, more_ranges_, more_hits_);
  if (config_.reflectivity && !plain_) apply_surfaces(more_, more_ranges_, more_hits_);
  for (std::size_t k = 0; k < edges_.size(); ++k) mix(edges_[k], k * kSubRays.size());
}

/// One reading from the sub-rays of `beam`: split at the widest gap into a near and a far surface
/// with the shares f and 1 - f. Surfaces closer together than 1.2 m give f near + (1 - f) far, a
/// value in mid-air; else the nearer one is reported if it has 0.3 of the spot.
void LaserModel::mix(std::size_t beam, std::size_t first_more) {
  struct Echo {
    double range = 0;
    std::uint32_t hit = 0;
  };
  constexpr std::size_t kRays = kSubRays.size() + 1;
  std::array<Echo, kRays> rays{};
  for (std::size_t k = 0; k < kSubRays.size(); ++k) {
    rays[k] = {more_ranges_[first_more + k], more_hits_[first_more + k]};
  }
  rays.back() = {ranges_[beam], hits_[beam]};
  const auto [nearest, farthest] =
      std::minmax({rays[0].range, rays[1].range, rays[2].range, rays[3].range, rays[4].range});
  static_assert(kRays == 5);
  if (!(farthest - nearest > kJump)) return;  // no gap can be wider
  // Sorted by counting who is farther: which one is, is not predictable. Equals keep their order.
  std::array<std::size_t, kRays> place{};
  for (std::size_t a = 0; a < kRays; ++a) {
    for (std::size_t b = a + 1; b < kRays; ++b) {
      const std::size_t swapped = rays[b].range < rays[a].range ? 1 : 0;
      place[a] += swapped;
      place[b] += 1 - swapped;
    }
  }
  std::array<Echo, kRays> echoes{};
  for (std::size_t k = 0; k < kRays; ++k) echoes[place[k]] = rays[k];
  std::size_t near_count = 0;
  double widest = kJump;
  for (std::size_t k = 1; k < kRays; ++k) {
    const double gap = echoes[k].range - echoes[k - 1].range;
    if (gap > widest) {
      widest = gap;
      near_count = k;
    }
  }
  if (near_count == 0) return;  // one surface fills the spot
  // A spot may reach over a third surface still farther away; it does not enter the mean.
  const auto mean = [&echoes](std::size_t from, std::size_t to) {
    double sum = 0;
    double count = 0;
    for (std::size_t k = from; k < to && echoes[k].range < echoes[from].range + kMixedGap; ++k) {
      sum += echoes[k].range;
      count += 1;
    }
    return sum / count;
  };
  const double near = mean(0, near_count);
  const double far = mean(near_count, kRays);
  const double share = static_cast<double>(near_count) / kRays;
  const bool far_returns = echoes[near_count].hit < kNoEcho;
  if (far_returns && far - near < kMixedGap) {
    ranges_[beam] = share * near + (1 - share) * far;
    hits_[beam] = echoes.front().hit;
  } else {
    const bool near_wins = share >= kNearShareToWin;
    ranges_[beam] = near_wins ? near : far_returns ? far : config_.range_max;
    hits_[beam] = near_wins ? echoes.front().hit : echoes[near_count].hit;
  }
}

}  // namespace sim
