// sim/range_caster.hpp: exact and fast distances along the beams of a planar scanner.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "algo/obstacle.hpp"
#include "algo/types.hpp"
#include "sim/beam_kernels.hpp"

namespace sim {

/// B beams in a sensor's own frame: beam i at angle_min + i * angle_increment, one turn at most.
struct BeamPattern {
  double angle_min = 0;        // [rad]
  double angle_increment = 0;  // [rad] above 0
  std::size_t beams = 0;
  bool operator==(const BeamPattern&) const = default;
  double angle(std::size_t i) const { return angle_min + static_cast<double>(i) * angle_increment; }
  /// The beams' unit vectors.
  void aim(std::vector<double>& ux, std::vector<double>& uy) const;
};

/// Rays in a common reference frame, each with its own origin and unit direction.
struct Rays {
  std::vector<double> x{}, y{};    // [m] origins
  std::vector<double> ux{}, uy{};  // directions

  std::size_t size() const { return x.size(); }
  void resize(std::size_t n) {
    x.resize(n);
    y.resize(n);
    ux.resize(n);
    uy.resize(n);
  }
};

/// Largest deviation of rays from the pattern's beams at the reference pose.
struct RaySpread {
  double shift = 0;  // [m] between an origin and the reference position
  double turn = 0;   // [rad] between a direction and its beam's
};

/// A world sliced once at the height of the scan plane into circles and segments. A scan is a
/// one-dimensional depth buffer over the beams: each primitive touches only the beams inside its
/// angular interval, and faces turned away are skipped. The buffer holds 1 / range, which along a
/// segment is linear in the beam's direction, so that the inner loop needs no division.
///
/// A sensor inside an obstacle reads 0 everywhere.
class RangeCaster {
 public:
  /// The hit of a beam that hit nothing.
  static constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

  /// `plane_height` [m]: a lower obstacle is never seen.
  explicit RangeCaster(double plane_height = 0) : plane_height_(plane_height) {}

  void add(const algo::Obstacle& obstacle);
  /// Moves obstacle `id`; no effect if it lies below the plane.
  void move(std::uint32_t id, const algo::Pose2& pose_W);
  void remove(std::uint32_t id);

  /// The number of obstacles seen, and the obstacle at an index reported in `hits`. Indices are
  /// valid until the next add() or remove().
  std::size_t size() const { return obstacles_.size(); }
  const algo::Obstacle& obstacle(std::uint32_t index) const { return obstacles_[index]; }
  /// Unit outward normal of obstacle `index` at its surface point nearest to `p_W`.
  algo::Vec2 normal_W(std::uint32_t index, const algo::Vec2& p_W) const;

  /// Ranges of all beams from one pose. `ranges`: B values [m], range_max if nothing is nearer.
  /// `hits`: B obstacle indices, or empty if not wanted.
  void cast(const algo::Pose2& sensor_W,
            const BeamPattern& pattern,
            double range_max,
            std::span<double> ranges,
            std::span<std::uint32_t> hits = {});

  /// The same for beams fired one by one from a moving sensor. `rays` holds B rays in
  /// `reference_W`; ray i deviates from beam i of the pattern by at most `spread`.
  void cast_rolling(const algo::Pose2& reference_W,
                    const BeamPattern& pattern,
                    const Rays& rays,
                    const RaySpread& spread,
                    double range_max,
                    std::span<double> ranges,
                    std::span<std::uint32_t> hits = {});

  /// Casts further rays at the primitives of the last cast_rolling(). `rays` are in the same frame
  /// and in the order of their beams; `first[i]` (B + 1 values) is the first ray of beam i. The
  /// same spread applies.
  void cast_more(const Rays& rays,
                 std::span<const std::uint32_t> first,
                 double range_max,
                 std::span<double> ranges,
                 std::span<std::uint32_t> hits = {});

 private:
  /// A primitive that some ray may hit, in the reference frame: a circle about p, or the segment
  /// from p to q seen counter-clockwise.
  struct Primitive {
    double px = 0, py = 0, qx = 0, qy = 0;
    double radius = 0;  // 0 for a segment
    std::uint32_t obstacle = 0;
    std::uint32_t begin = 0, end = 0;  // beams
  };
  /// A vertex of the current obstacle, in the sensor's frame.
  struct Corner {
    double x = 0, y = 0;
    double beam = 0;     // its bearing, counted in beams from the first
    bool known = false;  // `beam` is filled in
  };

  void place(std::size_t index);
  std::size_t find(std::uint32_t id) const;
  void use_pattern(const BeamPattern& pattern);
  void gather(const algo::Pose2& sensor_W, double range_max, const RaySpread& spread);
  void enter_frame(std::uint32_t index);
  algo::Vec2 centre_in_frame(std::uint32_t index) const;
  double bearing(double x, double y) const;
  double bearing(Corner& corner) const;
  std::uint32_t first_beam(const Corner& corner) const;

  void flat_circle(std::uint32_t index);
  void flat_outline(std::uint32_t index);

  void add_primitive(const Primitive& primitive, double from, double to);
  void rolling_circle(std::uint32_t index, const RaySpread& spread);
  void rolling_outline(std::uint32_t index, const RaySpread& spread);
  void trace(const Rays& rays, std::span<const std::uint32_t> first);
  void trace_enclosing(const Rays& rays);

  void start(std::size_t rays, double range_max, bool with_hits);
  void finish(double range_max, std::span<double> ranges, std::span<std::uint32_t> hits) const;
  void fill_inside(std::uint32_t index);

  double plane_height_ = 0;  // [m]

  // The world, one entry per obstacle: its bounding circle, and its outline in the vertex pool.
  std::vector<algo::Obstacle> obstacles_{};
  std::vector<std::uint32_t> ids_{};  // ids of obstacles_, kept together for searching
  std::vector<double> centre_x_{}, centre_y_{}, bound_{};
  std::vector<std::uint32_t> first_vertex_{}, vertex_count_{};  // count 0: a circle
  std::vector<double> vertex_x_{}, vertex_y_{};

  // Tables of the pattern in use.
  BeamPattern pattern_{};
  std::vector<double> ux_{}, uy_{};  // beam directions in the sensor's frame
  double full_turn_ = 0;             // [beams]
  double per_radian_ = 0;            // [beams/rad]
  double slack_ = 0;                 // [beams] largest error of bearing()
  bool narrow_ = false;              // field of view of at most half a turn

  // Workspace of one scan.
  algo::Pose2 sensor_W_{};
  double cosine_ = 1, sine_ = 0;
  std::vector<std::uint32_t> near_{};       // obstacles that may be hit
  std::vector<Corner> outline_{};           // of the current obstacle
  DepthBuffer depth_{};                     // [1/m] of each ray, and its hit
  std::size_t rays_ = 0;                    // number of rays in it
  std::vector<Primitive> primitives_{};     // of the last cast_rolling()
  std::vector<std::uint32_t> enclosing_{};  // outlines that may contain a ray's origin
};

}  // namespace sim
