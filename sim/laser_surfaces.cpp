// sim/laser_surfaces.cpp: the effects of the surface and of the beam's width on a reading.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "algo/units.hpp"
#include "sim/laser_model.hpp"
#include "sim/spot_kernel.hpp"

namespace sim {
namespace {

using namespace algo::units;

// The spot: 8 mm wide at the window, widening by half a degree. Sub-rays are spaced evenly across
// it.
constexpr double kSpotHalfWidth = 4_mm;
constexpr double kSpotHalfAngle = 0.25_deg;
constexpr std::array<double, kSpotRays - 1> kSubRays{
    -1, -0.5, 0.5, 1};  // besides the one in the centre

constexpr double kJump = 20_mm;          // between neighbours that may share an edge
constexpr double kMixedGap = 1.2;        // [m] surfaces farther apart do not mix
constexpr double kNearShareToWin = 0.3;  // least share of the spot for the nearer surface to win
constexpr double kSpecularCone = 5_deg;  // about the normal, within which a mirror returns light

/// [m] Visible range of a diffuse surface: 10 m at 10 % reflectivity, at most 80 m.
double reach(double reflectivity) {
  return std::min(80.0, 10 * std::sqrt(reflectivity / 0.1));
}

}  // namespace

/// Widens the spread of the rays by those across a spot.
void LaserModel::allow_for_spot() {
  if (!config_.mixed_pixels) return;
  spread_.shift += kSpotHalfWidth;
  spread_.turn += kSpotHalfAngle;
}

std::array<LaserModel::SpotRay, kSpotRays - 1> LaserModel::spot_rays() {
  std::array<SpotRay, kSubRays.size()> rays{};
  for (std::size_t k = 0; k < rays.size(); ++k) {
    rays[k] = {kSubRays[k] * kSpotHalfWidth, algo::direction(kSubRays[k] * kSpotHalfAngle)};
  }
  return rays;
}

/// `cosine` of the angle at which the ray meets the surface.
LaserModel::Echo LaserModel::echo_of(const algo::Obstacle& surface, double range, double cosine) {
  if (surface.specular) {
    return cosine < std::cos(kSpecularCone) ? Echo::Reflected : Echo::Returned;
  }
  return range > reach(surface.reflectivity) ? Echo::Dark : Echo::Returned;
}

void LaserModel::note_surfaces() {
  plain_ = true;
  for (std::uint32_t k = 0; k < caster().size(); ++k) {
    const algo::Obstacle& obstacle = caster().obstacle(k);
    plain_ = plain_ && !obstacle.specular && reach(obstacle.reflectivity) >= config_.range_max;
  }
}

/// Rays that hit a surface too dark for its distance give no echo. A specular surface is invisible
/// unless it faces the scanner.
void LaserModel::apply_surfaces(const Rays& rays,
                                std::span<double> ranges,
                                std::span<std::uint32_t> hits) const {
  const bool still = !config_.rolling && !config_.mixed_pixels;  // cast from the pattern itself
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (hits[i] >= kNoEcho) continue;
    const algo::Obstacle& obstacle = caster().obstacle(hits[i]);
    if (obstacle.specular) {
      const algo::Vec2 o = still ? algo::Vec2(0, 0) : algo::Vec2(rays.x[i], rays.y[i]);
      const algo::Vec2 u = still ? algo::Vec2(ux_[i], uy_[i]) : algo::Vec2(rays.ux[i], rays.uy[i]);
      const algo::Vec2 point_W = algo::to_parent(reference_W_, o + ranges[i] * u);
      const algo::Vec2 way_W = point_W - algo::to_parent(reference_W_, o);
      const algo::Vec2 normal_W = caster().normal_W(hits[i], point_W);
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

/// Marks the beams at an edge: next to a beam that hit another obstacle at another distance. Two
/// beams on one (convex) obstacle have no edge between them, however steeply it recedes. Writes
/// every beam but counts only those at an edge, since they are unpredictable.
void LaserModel::mark_edges() {
  flag_edges(work_->ranges.data(),
             work_->hits.data(),
             work_->ranges.size(),
             kJump,
             work_->edge_flags.data());
  std::uint32_t* const edges = work_->edges.data();
  std::uint32_t* const first = work_->first.data();
  const std::uint8_t* const flags = work_->edge_flags.data();
  const auto beams = static_cast<std::uint32_t>(work_->ranges.size());
  std::uint32_t count = 0;
  unsigned before = 0;
  for (std::uint32_t i = 0; i < beams; ++i) {
    edges[count] = i;
    first[i] = count * kSubRays.size();
    count += before | flags[i];
    before = flags[i];
  }
  first[beams] = count * kSubRays.size();
  spots_ = count;
}

/// Casts the sub-rays of the beams at edges and replaces the beams' ranges by those of whole spots.
void LaserModel::mix_pixels() {
  if (spots_ == 0) return;
  work_->more.resize(spots_ * kSubRays.size());
  work_->more_ranges.resize(work_->more.size());
  work_->more_hits.resize(work_->more.size());
  std::array<algo::Vec2, kSubRays.size()> turn{};
  for (std::size_t k = 0; k < turn.size(); ++k) {
    turn[k] = algo::direction(kSubRays[k] * kSpotHalfAngle);
  }
  std::size_t ray = 0;
  for (const std::uint32_t edge : std::span(work_->edges).first(spots_)) {
    const double ux = work_->rays.ux[edge];
    const double uy = work_->rays.uy[edge];
    for (std::size_t k = 0; k < turn.size(); ++k, ++ray) {
      const double aside = kSubRays[k] * kSpotHalfWidth;
      work_->more.x[ray] = work_->rays.x[edge] - aside * uy;
      work_->more.y[ray] = work_->rays.y[edge] + aside * ux;
      work_->more.ux[ray] = turn[k].x() * ux - turn[k].y() * uy;
      work_->more.uy[ray] = turn[k].y() * ux + turn[k].x() * uy;
    }
  }

  caster().cast_more(
      work_->more, work_->first, config_.range_max, work_->more_ranges, work_->more_hits);
  if (config_.reflectivity && !plain_)
    apply_surfaces(work_->more, work_->more_ranges, work_->more_hits);
  judge();
}

/// Replaces the ranges of the beams at edges by those of their whole spots.
void LaserModel::judge() {
  const std::size_t spots = spots_;
  work_->spot_ranges.resize(spots * kSpotRays);
  work_->spot_hits.resize(spots * kSpotRays);
  double* const own = work_->spot_ranges.data() + kSubRays.size() * spots;
  std::uint32_t* const own_hits = work_->spot_hits.data() + kSubRays.size() * spots;
  for (std::size_t i = 0; i < spots; ++i) {
    for (std::size_t k = 0; k < kSubRays.size(); ++k) {
      work_->spot_ranges[k * spots + i] = work_->more_ranges[i * kSubRays.size() + k];
      work_->spot_hits[k * spots + i] = work_->more_hits[i * kSubRays.size() + k];
    }
    own[i] = work_->ranges[work_->edges[i]];
    own_hits[i] = work_->hits[work_->edges[i]];
  }
  judge_spots({.jump = kJump,
               .mixed_gap = kMixedGap,
               .near_share_to_win = kNearShareToWin,
               .range_max = config_.range_max,
               .no_echo = kNoEcho},
              spots,
              work_->spot_ranges.data(),
              work_->spot_hits.data());
  for (std::size_t i = 0; i < spots; ++i) {
    work_->ranges[work_->edges[i]] = own[i];
    work_->hits[work_->edges[i]] = own_hits[i];
  }
}

}  // namespace sim
