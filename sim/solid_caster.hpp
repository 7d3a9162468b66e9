// sim/solid_caster.hpp: exact distances along single rays in space, to obstacles and to the ground.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "algo/obstacle.hpp"
#include "algo/types.hpp"

namespace sim {

struct SolidHit {
  double range = 0;                    // [m] along the ray
  algo::Vec3 normal_W{0, 0, 1};        // of the surface, outward, of length 1
  const algo::Obstacle* of = nullptr;  // null: the floor
  std::uint32_t number = 0;            // of that obstacle among all
};

/// A world of upright solids on the floor z = 0, with ramps and trenches. A planar scanner on level
/// ground uses the RangeCaster, which is much faster.
class SolidCaster {
 public:
  void add(const algo::Obstacle& obstacle);
  /// Moves obstacle `id`; no effect if there is none.
  void move(std::uint32_t id, const algo::Pose2& pose_W);
  void remove(std::uint32_t id);

  /// True if a ramp or a trench is part of the world.
  bool has_ground() const { return ground_ > 0; }
  /// The first surface within `range_max` [m] of `from_W` along `way_W`, which has length 1. A ray
  /// that begins within a solid hits it at once. The hit's obstacle is valid until the next change.
  std::optional<SolidHit> cast(const algo::Vec3& from_W,
                               const algo::Vec3& way_W,
                               double range_max) const;

 private:
  /// An obstacle as a ray meets it: an outline or a circle, below a plane.
  struct Solid {
    algo::Obstacle obstacle{};
    std::vector<algo::Vec2> outline_W{};  // empty: a circle about `centre_W`
    std::vector<algo::Vec2> outward_W{};  // of each edge, by its end
    algo::Vec2 centre_W{0, 0};
    double bound = 0;          // [m] radius of a circle about it all
    double top = 0;            // [m] at the origin of W
    algo::Vec2 slope_W{0, 0};  // of the top, per metre along x and y
  };
  /// The part of a ray above an outline, by [m] along the ray; normal where it enters.
  struct Span {
    double from = 0, to = 0;
    algo::Vec2 normal_W{0, 0};
  };
  static void measure(Solid& solid);
  static std::optional<Span> over(const Solid& solid,
                                  const algo::Vec3& from,
                                  const algo::Vec3& way);
  static bool may_meet(const Solid& solid,
                       const algo::Vec3& from,
                       const algo::Vec3& way,
                       double within);
  void meet(const Solid& solid, const algo::Vec3& from, const algo::Vec3& way, SolidHit& hit) const;
  void meet_raised(const Solid& solid,
                   const Span& span,
                   const algo::Vec3& from,
                   const algo::Vec3& way,
                   SolidHit& hit) const;
  void meet_floor(const algo::Vec3& from, const algo::Vec3& way, SolidHit& hit) const;
  std::size_t find(std::uint32_t id) const;

  std::vector<Solid> solids_{};
  std::size_t ground_ = 0;  // of them, ramps and trenches
};

}  // namespace sim
