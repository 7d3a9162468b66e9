// algo/arm/known_things.hpp: what the arm must not touch, as far as its robot knows it: pieces that
// people have declared, and what the scanners see beside them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "algo/arm/solid.hpp"
#include "algo/laser_scan.hpp"
#include "algo/obstacle.hpp"
#include "algo/request.hpp"

namespace algo {

/// The simulator's truth is no part of it: a declared piece that moves by itself is left to the
/// scanners. A surface in a scan plane that is no declared piece counts from the floor to
/// above all arms, and as deep as kDepth behind the surface that is seen.
class KnownThings {
 public:
  static constexpr double kSamePlace = 0.12;  // [m] a return so near to a declared piece is of it
  static constexpr double kDepth = 0.15;      // [m] of what is seen, behind its surface
  static constexpr double kLongest = 0.25;    // [m] of one piece along the surface
  static constexpr double kRound = 0.02;      // [m] added all round, for the scanner's error
  static constexpr double kRange = 8;         // [m] from the scanner

  /// Forgets all and takes the pieces that are `declared` from the start. `scan_height` [m] of the
  /// plane that the scanners see.
  void reset(std::span<const Obstacle> declared, double scan_height);
  /// Takes a person's edit; ignores other requests.
  void apply(const Request& edit);
  /// Takes a new scan; the newest one of each scanner counts. `sensor_W` is the scanner's pose,
  /// `points_W` has a point for each beam (only those of Ok beams count).
  void see(const LaserScan& scan, const Pose2& sensor_W, std::span<const Vec2> points_W);

  /// What is seen within `reach` [m] of `centre_W` moves so [m/s], until the next scan. False if
  /// nothing is seen there.
  bool set_moving(const Vec2& centre_W, double reach, const Vec2& velocity_W);

  std::span<const Solid> all() const { return all_; }
  /// Overwrites `near` by those within `reach` [m] of `here_W`.
  void find_near(const Vec2& here_W, double reach, std::vector<Solid>& near) const;

 private:
  /// Pieces that one scanner sees.
  struct Seen {
    Pose2 mount_R{};
    std::vector<Solid> pieces{};
  };
  void declare();
  void gather();
  void cut(const LaserScan& scan,
           const Vec2& eye_W,
           std::span<const Vec2> points_W,
           std::vector<Solid>& pieces);
  void close_run(const Vec2& eye_W, std::vector<Solid>& pieces);
  bool is_declared(const Vec2& p_W) const;

  std::vector<Obstacle> pieces_{};
  double scan_height_ = 0;  // [m]
  std::vector<Solid> declared_{};
  std::vector<Seen> seen_{};  // by scanner
  std::vector<Solid> all_{};
  std::vector<Vec2> run_W_{};  // returns side by side that make one piece
};

}  // namespace algo
