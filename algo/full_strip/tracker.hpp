// algo/full_strip/tracker.hpp: tracks moving obstacles in the scans: clusters fitted by circles and
// followed by constant-velocity Kalman filters.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "algo/laser_scan.hpp"
#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// An obstacle that moves, or may move.
struct Track {
  Vec2 position_W{0, 0};
  Vec2 velocity_W{0, 0};       // [m/s]
  double radius = 0;           // [m]
  double age = 0;              // [s] since it was first seen
  double unseen = 0;           // [s] since it was last seen
  bool moves = false;          // it was seen moving
  double position_spread = 0;  // [m] standard deviation along each axis
  double velocity_spread = 0;  // [m/s] the same
};

/// A round body at least as thick as a person counts as possibly moving from its first scan on,
/// until it has stood for a while. Any other cluster counts as moving only once it has travelled at
/// a speed that its uncertainty does not explain. Static obstacles belong to the map, and so do
/// beams that another sensor measured: the scanner looked over them, so its earlier scans cannot
/// say whether they were there.
class Tracker {
 public:
  Tracker();
  void reset();

  /// Tracks the clusters of a new scan, each at the time at which its own beams were fired.
  /// `points_W` B points (only those of Ok beams count), `sensor_W` the scanner at the middle of
  /// its sweep. Scans must come in order; they are always older than the run clock.
  void update(const LaserScan& scan, const Pose2& sensor_W, const std::vector<Vec2>& points_W);
  /// Predicts moving() at `stamp` [s, run clock], which is later than the last scan.
  void predict(double stamp) { publish(stamp); }

  /// True if one of the last scans was taken by a scanner that faces backwards.
  bool looks_back() const;
  /// True if beam `i` of the last scan hit an obstacle that moves or may move.
  bool on_moving(std::size_t i) const { return i < moving_beam_.size() && moving_beam_[i] != 0; }
  /// The obstacles that move or may move, at the time of the last update() or predict().
  const Recycled<Track>& moving() const { return moving_; }
  /// Bodies in sight that have stood for a while: the map holds them, but they may begin to walk.
  const Recycled<Track>& standing() const { return standing_; }
  /// The circles that the last update() began to count as moving: the map holds traces of them.
  const Recycled<Track>& just_found() const { return just_found_; }

 private:
  struct Cluster {
    std::size_t first = 0, last = 0;  // beams
    double stamp = 0;                 // [s] when they were fired, at the middle
    Vec2 centre_W{0, 0};
    double radius = 0;    // [m]
    double residual = 0;  // [m] root mean square off the circle
    double chord = 0;     // [m] between its ends
    bool round = false;
    bool body = false;  // surely round, and not thin
    bool taken = false;
  };
  struct Filter {
    Vec2 position_W{0, 0};
    Vec2 velocity_W{0, 0};
    double pp = 0, pv = 0, vv = 0;  // covariance, the same along both axes
    double radius = 0;
    Vec2 born_at_W{0, 0};
    double born = 0, seen = 0;  // [s]
    int hits = 0;
    bool matched = false;  // in this scan
    int empty = 0;         // scans that looked through it
    bool moving = false;
    bool body = false;      // has not stood yet
    bool person = false;    // a body, or it has moved
    double slow_since = 0;  // [s]
    bool of_map() const { return !moving && !body; }
  };
  void cluster(const LaserScan& scan, const Pose2& sensor_W, const std::vector<Vec2>& points_W);
  void close(std::size_t first,
             std::size_t last,
             const Pose2& sensor_W,
             const std::vector<Vec2>& points_W);
  void fit(Cluster& c,
           const Pose2& sensor_W,
           const std::vector<Vec2>& points_W,
           double radius,
           double spread) const;
  void advance(double stamp);
  void correct(Filter& f, const Cluster& c);
  void associate(const Pose2& sensor_W, const std::vector<Vec2>& points_W, double stamp);
  /// A track and a cluster that may belong to it.
  struct Pair {
    double distance = 0;  // [m]
    std::uint32_t filter = 0, cluster = 0;
  };
  /// An earlier scan, kept to find changes since.
  struct Memory {
    double stamp = -1;
    Pose2 sensor_W{};
    double angle_min = 0, angle_increment = 1;  // [rad] of the scanner
    std::vector<float> ranges{};  // [m] 0 without a measurement, above range_max if free
  };
  void begin(const Cluster& c, double stamp);
  void judge(Filter& f, const Cluster& c, const std::vector<Vec2>& points_W, double stamp);
  bool changed(const Filter& f, const Cluster& c, const std::vector<Vec2>& points_W) const;
  void memorise(const LaserScan& scan, const Pose2& sensor_W, double stamp);
  std::optional<Vec2> hit_in(const Memory& memory, const Vec2& point_W) const;
  bool free_in(const Memory& memory, const Vec2& point_W, double aside) const;
  bool looked_through(const Filter& f, const LaserScan& scan, const Pose2& sensor_W) const;
  void publish(double stamp);

  std::vector<Filter> filters_{};
  std::vector<Cluster> clusters_{};
  std::vector<Pair> pairs_{};
  std::vector<std::uint8_t> moving_beam_{};
  Recycled<Track> moving_{};
  Recycled<Track> standing_{};
  Recycled<Track> just_found_{};
  double now_ = 0;  // [s] of the filters' states: time of the last scan
  static constexpr std::size_t kMemories = 12;
  std::array<Memory, kMemories> memories_{};
  std::size_t newest_ = 0;
  double looked_back_at_ = -1;  // [s] run clock; negative: never
};

}  // namespace algo
