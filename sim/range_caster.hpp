// sim/range_caster.hpp: distances along the beams of a planar scanner, exact and fast.
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

/// Rays in a common reference frame, each with an origin and a unit direction of its own.
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

/// How far rays may lie from the pattern's beams seen from the reference pose.
struct RaySpread {
  double shift = 0;  // [m] of an origin from the reference position
  double turn = 0;   // [rad] of a direction from its beam's
};

/// A world sliced once at the height of the scan plane into circles and segments. A scan is a
/// one-dimensional depth buffer over the beams: each primitive touches only the beams inside its
/// angular interval and faces turned away are skipped. Kept in the buffer is 1 / range, which along
/// a segment is linear in the beam's direction, so that the inner loop needs no division.
///
/// A sensor inside an obstacle reads 0 everywhere.
class RangeCaster {
 public:
  /// What a beam hit when it hit nothing.
  static constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

  /// `plane_height` [m]: an obstacle lower than that is never seen.
  explicit RangeCaster(double plane_height = 0) : plane_height_(plane_height) {}

  void add(const algo::Obstacle& obstacle);
  /// Moves or removes obstacle `id`; nothing to do when it lies below the plane.
  void move(std::uint32_t id, const algo::Pose2& pose_W);
  void remove(std::uint32_t id);

  /// Number of obstacles seen, and the one behind an index reported in `hits`. Indices hold until
  /// the next add() or remove().
  std::size_t size() const { return obstacles_.size(); }
  const algo::Obstacle& obstacle(std::uint32_t index) const { return obstacles_[index]; }
  /// Unit outward normal of obstacle `index` at its surface point nearest to `p_W`.
  algo::Vec2 normal_W(std::uint32_t index, const algo::Vec2& p_W) const;

  /// Ranges of all beams from one pose. `ranges` B values [m], range_max where nothing is nearer;
  /// `hits` B obstacle indices, or empty when not asked for.
  void cast(const algo::Pose2& sensor_W,
            const BeamPattern& pattern,
            double range_max,
            std::span<double> ranges,
            std::span<std::uint32_t> hits = {});

  /// The same for beams fired one by one from a moving sensor: `rays` holds B rays expressed in
  /// `reference_W`, ray i no farther than `spread` from beam i of the pattern.
  void cast_rolling(const algo::Pose2& reference_W,
                    const BeamPattern& pattern,
                    const Rays& rays,
                    const RaySpread& spread,
                    double range_max,
                    std::span<double> ranges,
                    std::span<std::uint32_t> hits = {});

  /// Further rays against what the last cast_rolling() met: `rays` in the same frame, in the order
  /// of their beams, `first[i]` (B + 1 values) the first ray of beam i, within the same spread.
  void cast_more(const Rays& rays,
                 std::span<const std::uint32_t> first,
                 double range_max,
                 std::span<double> ranges,
                 std::span<std::uint32_t> hits = {});

 private:
  /// A primitive that some ray may meet: a circle about p, or the segment from p to q seen counter-
  /// clockwise; in the reference frame.
  struct Primitive {
    double px = 0, py = 0, qx = 0, qy = 0;
    double radius = 0;  // 0 for a segment
    std::uint32_t obstacle = 0;
    std::uint32_t begin = 0, end = 0;  // beams
  };
  /// A vertex of the obstacle at hand, in the sensor's frame.
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

  // The world, one entry an obstacle: the circle about it, and its outline in the vertex pool.
  std::vector<algo::Obstacle> obstacles_{};
  std::vector<std::uint32_t> ids_{};  // of them, together, to be searched
  std::vector<double> centre_x_{}, centre_y_{}, bound_{};
  std::vector<std::uint32_t> first_vertex_{}, vertex_count_{};  // count 0: a circle
  std::vector<double> vertex_x_{}, vertex_y_{};

  // Tables of the pattern in use.
  BeamPattern pattern_{};
  std::vector<double> ux_{}, uy_{};  // beam directions in the sensor's frame
  double full_turn_ = 0;             // [beams]
  double per_radian_ = 0;            // [beams/rad]
  double slack_ = 0;                 // [beams] the error of bearing() at most
  bool narrow_ = false;              // field of view of half a turn at most

  // Workspace of one scan.
  algo::Pose2 sensor_W_{};
  double cosine_ = 1, sine_ = 0;
  std::vector<std::uint32_t> near_{};       // obstacles that may be met
  std::vector<Corner> outline_{};           // of the obstacle at hand
  DepthBuffer depth_{};                     // [1/m] of each ray, and what it met
  std::size_t rays_ = 0;                    // in it
  std::vector<Primitive> primitives_{};     // of the last cast_rolling()
  std::vector<std::uint32_t> enclosing_{};  // outlines a ray of it may start inside
};

}  // namespace sim
