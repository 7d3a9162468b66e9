// algo/full_strip/tracker.cpp: clusters, circles and Kalman filters.
#include "algo/full_strip/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include <Eigen/Dense>

#include "algo/full_strip/scan_points.hpp"

namespace algo {
namespace {

constexpr std::size_t kMostFilters = 64;
constexpr double kGap = 0.12;          // [m] between neighbours of one cluster, at range 0,
constexpr double kGapPerMetre = 0.02;  // and per metre of range
constexpr double kCuspArm = 0.15;      // [m] on both sides of a dent that separates two clusters
constexpr double kCusp = 0.04;         // [m] depth of the dent
constexpr std::size_t kFewest = 4;     // beams of a cluster
constexpr double kLongestChord = 1.6;  // [m] of a cluster's chord
constexpr double kThinnest = 0.06, kThickest = 0.8;            // [m] radii
constexpr double kRound = 0.035;                               // [m] largest residual of a circle
constexpr double kTypicalRadius = 0.35, kRadiusSpread = 0.25;  // [m] prior of a new track
constexpr double kTrackSpread = 0.05;                          // [m] of a known radius
constexpr double kNoise = 0.02;                                // [m] of a hit
constexpr double kGate = 0.30;          // [m] between a track and its prediction,
constexpr double kGateSigmas = 3;       // plus this many sigmas
constexpr double kCentreNoise = 0.025;  // [m] of a fitted centre
constexpr double kAcceleration = 0.5;   // [m/s2] process noise
constexpr double kSurprise = 9;         // normalised innovation squared that widens the velocity
constexpr double kFirstSpeed = 1.5;     // [m/s] standard deviation of a new track
constexpr double kFound = 0.25;         // [s] a track is watched before it may count as moving
constexpr double kMovingSpeed = 0.25;   // [m/s]
constexpr double kGone = 0.12;          // [m] from the place of first sight
constexpr double kStands = 0.12;        // [m/s] below it, for kStandsFor, it stands
constexpr double kStandsFor = 1.0;      // [s]
constexpr double kBody = 0.2;       // [m] radius of a body that may move before it has been seen to
constexpr double kBodyBend = 0.04;  // [m] root mean square distance of its arc from a straight line
constexpr double kCorner = 0.7;     // of the circle's residual: a corner with less fits better
constexpr double kMemoryEvery = 0.09;  // [s] between two kept scans,
constexpr double kMemoryLeast = 0.2;   // [s] least age of one to compare with,
constexpr double kMemoryMore = 0.5;    // [s] and how much older than the track it may be
constexpr double kBeyond = 0.2;        // [m] an earlier beam went on behind the present obstacle
constexpr double kFreeAside = 0.04;    // [m] and on both sides of it: poses and hits are not exact
constexpr double kSame = 0.1;          // [m] within which an earlier hit is at the same place
constexpr std::size_t kSolid = 8;      // beams of a cluster that may count as moving
constexpr double kStout = 0.12;     // [m] and its radius: thinner things come and go in the filter
constexpr double kAround = 0.15;    // [m] around a moving circle: its hits lie within
constexpr double kCoast = 3.0;      // [s] a moving track lasts unseen
constexpr double kForget = 0.4;     // [s] any other track
constexpr double kLooksBack = 0.5;  // [s] for which a look backwards counts
constexpr int kEmpty = 3;           // scans that look through a track before it ends

/// [m] Root mean square distance of every `stride`th of the points from their own straight line.
double bend(const std::vector<Vec2>& points_W,
            std::size_t first,
            std::size_t last,
            std::size_t stride) {
  Vec2 sum{0, 0};
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double count = 0;
  for (std::size_t i = first; i <= last; i += stride) {
    const Vec2 d = points_W[i] - points_W[first];
    sum += d;
    squares += d * d.transpose();
    count += 1;
  }
  const Eigen::Matrix2d spread = squares / count - (sum / count) * (sum / count).transpose();
  const double half = spread.trace() / 2;
  const double least = half - std::sqrt(std::max(0.0, half * half - spread.determinant()));
  return std::sqrt(std::max(0.0, least));
}

/// [m] Root mean square distance of every `stride`th of the points from two straight lines that
/// meet at the point farthest from the chord: a corner's outline.
double off_corner(const std::vector<Vec2>& points_W,
                  std::size_t first,
                  std::size_t last,
                  std::size_t stride) {
  const Vec2 chord = (points_W[last] - points_W[first]).normalized();
  std::size_t corner = first;
  double farthest = 0;
  for (std::size_t i = first; i <= last; i += stride) {
    const double off = std::abs(cross(chord, points_W[i] - points_W[first]));
    if (off <= farthest) continue;
    farthest = off;
    corner = i;
  }
  const auto before = static_cast<double>(corner - first);
  const auto after = static_cast<double>(last - corner);
  const double a = bend(points_W, first, corner, stride);
  const double b = bend(points_W, corner, last, stride);
  return std::sqrt((before * a * a + after * b * b) / (before + after));
}

/// [m] Spread of a track's radius after `hits` scans.
double radius_spread(int hits) {
  return std::max(kTrackSpread, kRadiusSpread / (hits + 1));
}

/// [s] Mean run-clock time at which the beams first..last were fired: neighbouring beams belong to
/// the sweep's turns in rotation.
double middle_time(const LaserScan& scan, std::size_t first, std::size_t last) {
  const auto turns = std::clamp<std::size_t>(scan.turns, 1, scan.size());
  const std::size_t from = std::min((first + last) / 2, scan.size() - turns);
  double sum = 0;
  for (std::size_t i = from; i < from + turns; ++i) sum += scan.beam_time(i);
  return sum / static_cast<double>(turns);
}

/// The deepest dent of the outline first..last, seen from `eye_W`.
std::optional<std::size_t> cusp(const std::vector<Vec2>& points_W,
                                std::size_t first,
                                std::size_t last,
                                const Vec2& eye_W) {
  const double length = (points_W[last] - points_W[first]).norm();
  const auto count = static_cast<double>(last - first);
  const auto arm =
      std::max<std::size_t>(2, static_cast<std::size_t>(kCuspArm / std::max(1e-3, length / count)));
  std::optional<std::size_t> best;
  double deepest = kCusp;
  for (std::size_t i = first + arm; i + arm <= last; ++i) {
    const Vec2 middle = (points_W[i - 1] + points_W[i] + points_W[i + 1]) / 3;
    const Vec2 off = middle - (points_W[i - arm] + points_W[i + arm]) / 2;
    const double depth = off.dot((middle - eye_W).normalized());
    if (depth <= deepest) continue;
    deepest = depth;
    best = i;
  }
  return best;
}

}  // namespace

Tracker::Tracker() {
  filters_.reserve(kMostFilters);
  moving_.reserve(kMostFilters);
  standing_.reserve(kMostFilters);
  just_found_.reserve(kMostFilters);
  clusters_.reserve(256);
  pairs_.reserve(kMostFilters * 8);
}

void Tracker::reset() {
  filters_.clear();
  moving_.clear();
  standing_.clear();
  just_found_.clear();
  std::ranges::fill(moving_beam_, std::uint8_t{0});
  now_ = 0;
  for (Memory& memory : memories_) memory.stamp = -1;
  looked_back_at_ = -1;
}

bool Tracker::looks_back() const {
  return looked_back_at_ >= 0 && now_ - looked_back_at_ < kLooksBack;
}

/// Groups neighbouring hits that lie close together.
void Tracker::cluster(const LaserScan& scan,
                      const Pose2& sensor_W,
                      const std::vector<Vec2>& points_W) {
  clusters_.clear();
  std::size_t first = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (!scan.measured(i)) {
      if (i > first) close(first, i - 1, sensor_W, points_W);
      first = i + 1;
      continue;
    }
    if (i == first) continue;
    if ((points_W[i] - points_W[i - 1]).norm() > kGap + kGapPerMetre * scan.ranges[i]) {
      close(first, i - 1, sensor_W, points_W);
      first = i;
    }
  }
  if (first < scan.size()) close(first, scan.size() - 1, sensor_W, points_W);
}

/// Makes one cluster of the points first..last, or two if they show a dent: bodies side by side.
void Tracker::close(std::size_t first,
                    std::size_t last,
                    const Pose2& sensor_W,
                    const std::vector<Vec2>& points_W) {
  if (last - first + 1 < kFewest || clusters_.size() == clusters_.capacity()) return;
  if (const auto at = cusp(points_W, first, last, sensor_W.position())) {
    close(first, *at, sensor_W, points_W);
    close(*at + 1, last, sensor_W, points_W);
    return;
  }
  Cluster c;
  c.first = first;
  c.last = last;
  c.chord = (points_W[last] - points_W[first]).norm();
  if (c.chord > kLongestChord) return;
  fit(c, sensor_W, points_W, kTypicalRadius, kRadiusSpread);
  clusters_.push_back(c);
}

/// Gauss-Newton on the centre and the radius, with the prior `radius` +- `spread`.
void Tracker::fit(Cluster& c,
                  const Pose2& sensor_W,
                  const std::vector<Vec2>& points_W,
                  double radius,
                  double spread) const {
  Vec2 mean{0, 0};
  const std::size_t stride = std::max<std::size_t>(1, (c.last - c.first) / 24);
  double count = 0;
  for (std::size_t i = c.first; i <= c.last; i += stride) {
    mean += points_W[i];
    count += 1;
  }
  mean /= count;
  const Vec2 line = mean - sensor_W.position();
  c.radius = std::clamp(std::min(radius, 0.6 * c.chord + 0.03), kThinnest, kThickest);
  if (spread < kRadiusSpread) c.radius = radius;  // of a known track
  const double prior = c.radius;
  c.centre_W = mean + line.normalized() * (0.7 * c.radius);
  for (int round = 0; round < 6; ++round) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    const double weight = kNoise * kNoise / (spread * spread);
    normal(2, 2) += weight;
    right(2) += weight * (prior - c.radius);
    double sum = 0;
    for (std::size_t i = c.first; i <= c.last; i += stride) {
      const Vec2 d = points_W[i] - c.centre_W;
      const double far = std::max(1e-6, d.norm());
      const Eigen::Vector3d slope(-d.x() / far, -d.y() / far, -1);  // of far - radius
      const double off = far - c.radius;
      normal += slope * slope.transpose();
      right -= slope * off;
      sum += off * off;
    }
    c.residual = std::sqrt(sum / count);
    normal.diagonal().array() += 1e-6;
    const Eigen::Vector3d step = normal.ldlt().solve(right);
    if (!step.allFinite()) break;
    const double most = 0.3;
    const double size = step.norm();
    const Eigen::Vector3d bounded = size > most ? Eigen::Vector3d(step * (most / size)) : step;
    c.centre_W += bounded.head<2>();
    c.radius = std::clamp(c.radius + bounded(2), kThinnest, kThickest);
  }
  // A body's centre lies behind its surface; otherwise it is a hollow.
  const bool bulges = (c.centre_W - sensor_W.position()).norm() > line.norm();
  c.round = bulges && c.residual < kRound && c.radius > kThinnest && c.radius < kThickest;
  c.body = c.round && c.radius > kBody && bend(points_W, c.first, c.last, stride) > kBodyBend &&
           off_corner(points_W, c.first, c.last, stride) > kCorner * c.residual;
}

/// Moves the filters to the time of a scan. Never to the run clock: the next scan would be older.
void Tracker::advance(double stamp) {
  const double dt = stamp - now_;
  if (!(dt > 0)) return;
  now_ = stamp;
  const double q = kAcceleration * kAcceleration;
  for (Filter& f : filters_) {
    f.position_W += f.velocity_W * dt;
    f.pp += 2 * dt * f.pv + dt * dt * f.vv + q * dt * dt * dt / 3;
    f.pv += dt * f.vv + q * dt * dt / 2;
    f.vv += q * dt;
  }
}

void Tracker::correct(Filter& f, const Cluster& c) {
  // Compares with the filter's position at the time when the beams were fired.
  const Vec2 off = c.centre_W + f.velocity_W * (now_ - c.stamp) - f.position_W;
  const double r = kCentreNoise * kCentreNoise;
  if (off.squaredNorm() / (2 * (f.pp + r)) > kSurprise) f.vv += 1;
  const double gain_p = f.pp / (f.pp + r);
  const double gain_v = f.pv / (f.pp + r);
  f.position_W += gain_p * off;
  f.velocity_W += gain_v * off;
  f.vv -= gain_v * f.pv;
  f.pv -= gain_p * f.pv;
  f.pp -= gain_p * f.pp;
  f.radius += (c.radius - f.radius) / std::min(10, f.hits + 1);
  ++f.hits;
  f.seen = now_;
  f.empty = 0;
}

/// Assigns clusters to tracks, nearest pair first: a track that lost its cluster does not take
/// another's.
void Tracker::associate(const Pose2& sensor_W, const std::vector<Vec2>& points_W, double stamp) {
  pairs_.clear();
  for (std::size_t f = 0; f < filters_.size(); ++f) {
    filters_[f].matched = false;
    const double gate = kGate + kGateSigmas * std::sqrt(filters_[f].pp);
    for (std::size_t c = 0; c < clusters_.size() && pairs_.size() < pairs_.capacity(); ++c) {
      const double far = (clusters_[c].centre_W - filters_[f].position_W).norm();
      if (far > gate) continue;
      pairs_.push_back({far, static_cast<std::uint32_t>(f), static_cast<std::uint32_t>(c)});
    }
  }
  std::ranges::sort(pairs_, [](const Pair& a, const Pair& b) {
    return std::tie(a.distance, a.filter, a.cluster) < std::tie(b.distance, b.filter, b.cluster);
  });
  for (const Pair& pair : pairs_) {
    Filter& f = filters_[pair.filter];
    Cluster& c = clusters_[pair.cluster];
    if (f.matched || c.taken) continue;
    fit(c, sensor_W, points_W, f.radius, radius_spread(f.hits));
    if (!c.round && c.residual > 2 * kRound) continue;
    f.matched = true;
    c.taken = true;
    correct(f, c);
    judge(f, c, points_W, stamp);
    if (f.of_map()) continue;
    for (std::size_t i = c.first; i <= c.last; ++i) moving_beam_[i] = 1;
  }
  for (const Cluster& c : clusters_) {
    if (!c.taken && c.round && filters_.size() < kMostFilters) begin(c, stamp);
  }
}

void Tracker::begin(const Cluster& c, double stamp) {
  Filter f;
  f.position_W = c.centre_W;
  f.born_at_W = c.centre_W;
  f.radius = c.radius;
  f.pp = kCentreNoise * kCentreNoise;
  f.vv = kFirstSpeed * kFirstSpeed;
  f.born = stamp;
  f.seen = stamp;
  f.slow_since = stamp;
  f.hits = 1;
  f.body = c.body;
  f.person = c.body;
  filters_.push_back(f);
  if (f.body) just_found_.push_back({f.position_W, f.velocity_W, f.radius, 0, 0, false});
}

void Tracker::memorise(const LaserScan& scan, const Pose2& sensor_W, double stamp) {
  if (stamp - memories_[newest_].stamp < kMemoryEvery && memories_[newest_].stamp >= 0) return;
  newest_ = (newest_ + 1) % kMemories;
  Memory& memory = memories_[newest_];
  memory.stamp = stamp;
  memory.sensor_W = sensor_W;
  memory.angle_min = scan.angle_min;
  memory.angle_increment = scan.angle_increment;
  memory.ranges.resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const bool looked = scan.status[i] == Beam::Free || scan.measured(i);
    memory.ranges[i] = looked ? static_cast<float>(scan.ranges[i]) : 0.0F;
  }
}

/// True if a scan looked well beyond the point, and beyond `aside` [m] on both sides of it.
bool Tracker::free_in(const Memory& memory, const Vec2& point_W, double aside) const {
  const double beam = beam_at(memory.sensor_W, point_W, memory.angle_min, memory.angle_increment);
  const auto last = static_cast<double>(memory.ranges.size()) - 1;
  if (!(beam >= 1 && beam < last - 1)) return false;
  const double far = (point_W - memory.sensor_W.position()).norm();
  const double beams = 1 + aside / (std::max(far, 0.01 + aside) * std::abs(memory.angle_increment));
  const auto from = static_cast<std::size_t>(std::lround(std::max(0.0, beam - beams)));
  const auto to = static_cast<std::size_t>(std::lround(std::min(last, beam + beams)));
  for (std::size_t i = from; i <= to; ++i) {
    if (static_cast<double>(memory.ranges[i]) < far + kBeyond) return false;
  }
  return true;
}

/// What an earlier scan hit at the point, if anything: the place of that hit.
std::optional<Vec2> Tracker::hit_in(const Memory& memory, const Vec2& point_W) const {
  const double beam = beam_at(memory.sensor_W, point_W, memory.angle_min, memory.angle_increment);
  if (!(beam >= 1 && beam < static_cast<double>(memory.ranges.size()) - 2)) return std::nullopt;
  const double nearest = std::round(beam);
  const auto range = static_cast<double>(memory.ranges[static_cast<std::size_t>(nearest)]);
  const Vec2 eye_W = memory.sensor_W.position();
  if (std::abs(range - (point_W - eye_W).norm()) >= kSame) return std::nullopt;
  const double bearing =
      memory.sensor_W.heading + memory.angle_min + nearest * memory.angle_increment;
  return eye_W + range * direction(bearing);
}

/// True if there is an obstacle where an earlier scan saw none, or none where it saw one. In a
/// static world neither happens, whatever the robot's own motion uncovers and hides.
bool Tracker::changed(const Filter& f, const Cluster& c, const std::vector<Vec2>& points_W) const {
  const Memory& now = memories_[newest_];
  for (std::size_t k = 1; k < kMemories; ++k) {
    const Memory& then = memories_[(newest_ + k) % kMemories];  // oldest first
    const double since = now_ - then.stamp;
    if (then.stamp < 0 || since < kMemoryLeast || since > now_ - f.born + kMemoryMore) continue;
    const std::size_t stride = std::max<std::size_t>(1, (c.last - c.first) / 16);
    int count = 0;
    int fresh = 0;
    for (std::size_t i = c.first; i <= c.last; i += stride) {
      ++count;
      fresh += free_in(then, points_W[i], 0) ? 1 : 0;
    }
    if (3 * fresh >= count) return true;
    const Vec2 was = f.position_W - f.velocity_W * since;
    const Vec2 to_sensor = (then.sensor_W.position() - was).normalized();
    const Vec2 front = was + to_sensor * f.radius;
    // Where that scan hit it, not where the circle says: beside a thin thing the view is free.
    const std::optional<Vec2> hit_W = hit_in(then, front);
    if (hit_W && free_in(now, *hit_W, kFreeAside)) return true;
  }
  return false;
}

void Tracker::judge(Filter& f, const Cluster& c, const std::vector<Vec2>& points_W, double stamp) {
  const double speed = f.velocity_W.norm();
  if (speed > kStands) f.slow_since = stamp;
  const bool stands = stamp - f.slow_since >= kStandsFor;
  f.body = f.body && !stands;
  if (f.moving) {
    f.moving = !stands;
    return;
  }
  f.moving = stamp - f.born > kFound && speed > kMovingSpeed && speed > 1.5 * std::sqrt(f.vv) &&
             (f.position_W - f.born_at_W).norm() > kGone && c.last - c.first >= kSolid &&
             f.radius > kStout && changed(f, c, points_W);
  f.person = f.person || f.moving;
  if (f.moving) {
    just_found_.push_back({f.position_W, f.velocity_W, f.radius, stamp - f.born, 0, true});
  }
}

/// True if the beams at the track's place go well beyond it.
bool Tracker::looked_through(const Filter& f, const LaserScan& scan, const Pose2& sensor_W) const {
  const double far = (f.position_W - sensor_W.position()).norm();
  const double beam = beam_at(sensor_W, f.position_W, scan.angle_min, scan.angle_increment);
  if (!(beam >= 2 && beam < static_cast<double>(scan.size()) - 3)) return false;
  if (far + f.radius > scan.range_max) return false;
  const auto b = static_cast<std::size_t>(beam);
  for (std::size_t i = b - 2; i <= b + 2; ++i) {
    if (scan.status[i] == Beam::Invalid || scan.ranges[i] < far + f.radius + 0.2) return false;
  }
  return true;
}

void Tracker::update(const LaserScan& scan,
                     const Pose2& sensor_W,
                     const std::vector<Vec2>& points_W) {
  const double stamp = scan.stamp;
  advance(stamp);
  if (std::abs(scan.mount_R.heading) > std::numbers::pi / 2) looked_back_at_ = stamp;
  just_found_.clear();
  moving_beam_.assign(scan.size(), 0);
  memorise(scan, sensor_W, stamp);
  cluster(scan, sensor_W, points_W);
  for (Cluster& c : clusters_) c.stamp = middle_time(scan, c.first, c.last);
  associate(sensor_W, points_W, stamp);
  for (Filter& f : filters_) {
    if (f.seen < stamp && looked_through(f, scan, sensor_W)) ++f.empty;
  }
  std::erase_if(filters_, [&](const Filter& f) {
    return f.empty >= kEmpty || stamp - f.seen > (f.of_map() ? kForget : kCoast);
  });
  publish(stamp);
  // Two obstacles close together do not fit a circle. All hits near a moving track count as moving.
  for (const Track& track : moving_) {
    const double reach = track.radius + kAround;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const bool hit = scan.status[i] == Beam::Ok;
      if (hit && (points_W[i] - track.position_W).squaredNorm() < reach * reach)
        moving_beam_[i] = 1;
    }
  }
}

void Tracker::publish(double stamp) {
  moving_.clear();
  standing_.clear();
  for (const Filter& f : filters_) {
    if (f.of_map()) {
      if (f.person) standing_.push_back({.position_W = f.position_W, .radius = f.radius});
      continue;
    }
    const Vec2 at_W = f.position_W + f.velocity_W * (stamp - now_);
    const double lead = stamp - now_;
    moving_.push_back({.position_W = at_W,
                       .velocity_W = f.velocity_W,
                       .radius = f.radius,
                       .age = stamp - f.born,
                       .unseen = stamp - f.seen,
                       .moves = f.moving,
                       .position_spread = std::sqrt(f.pp + 2 * lead * f.pv + lead * lead * f.vv),
                       .velocity_spread = std::sqrt(f.vv)});
  }
}

}  // namespace algo
