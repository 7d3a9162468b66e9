// algo/arm/known_things.cpp: declared pieces as solids, and a scan cut into upright pieces.
#include "algo/arm/known_things.hpp"

#include <algorithm>
#include <variant>

namespace algo {
namespace {

constexpr double kApart = 0.12;     // [m] returns farther from each other are of two pieces
constexpr std::size_t kFewest = 2;  // returns of a piece: a single one may be false

/// [m] At most the distance from `p_W` to the solid on the map.
double at_least_from(const Solid& solid, const Vec2& p_W) {
  return (solid.centre_W - p_W).norm() - solid.half.norm() - solid.rounding;
}

}  // namespace

void KnownThings::reset(std::span<const Obstacle> declared, double scan_height) {
  pieces_.assign(declared.begin(), declared.end());
  scan_height_ = scan_height;
  seen_.clear();
  declare();
}

void KnownThings::apply(const Request& edit) {
  const auto with_id = [this](std::uint32_t id) {
    return std::ranges::find(pieces_, id, &Obstacle::id);
  };
  if (const auto* add = std::get_if<AddObstacle>(&edit)) {
    pieces_.push_back(add->obstacle);
  } else if (const auto* change = std::get_if<ChangeObstacle>(&edit)) {
    if (const auto it = with_id(change->obstacle.id); it != pieces_.end()) *it = change->obstacle;
  } else if (const auto* move = std::get_if<MoveObstacle>(&edit)) {
    if (const auto it = with_id(move->id); it != pieces_.end()) it->pose_W = move->pose_W;
  } else if (const auto* gone = std::get_if<RemoveObstacle>(&edit)) {
    std::erase_if(pieces_, [&](const Obstacle& o) { return o.id == gone->id; });
  } else {
    return;
  }
  declare();
}

void KnownThings::declare() {
  declared_.clear();
  for (const Obstacle& piece : pieces_) {
    if (!piece.path) append_solids(piece, declared_);
  }
  gather();
}

void KnownThings::gather() {
  all_ = declared_;
  for (const Seen& seen : seen_) all_.insert(all_.end(), seen.pieces.begin(), seen.pieces.end());
}

void KnownThings::see(const LaserScan& scan,
                      const Pose2& sensor_W,
                      std::span<const Vec2> points_W) {
  auto seen = std::ranges::find(seen_, scan.mount_R, &Seen::mount_R);
  if (seen == seen_.end()) seen = seen_.insert(seen_.end(), Seen{scan.mount_R, {}});
  cut(scan, sensor_W.position(), points_W, seen->pieces);
  gather();
}

/// Into pieces: runs of returns side by side of which none is of a declared piece.
void KnownThings::cut(const LaserScan& scan,
                      const Vec2& eye_W,
                      std::span<const Vec2> points_W,
                      std::vector<Solid>& pieces) {
  pieces.clear();
  run_W_.clear();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vec2& p_W = points_W[i];
    const bool counts = scan.status[i] == Beam::Ok && scan.ranges[i] <= kRange && !is_declared(p_W);
    const bool goes_on = counts && !run_W_.empty() && (p_W - run_W_.back()).norm() < kApart &&
                         (p_W - run_W_.front()).norm() < kLongest;
    if (!goes_on) close_run(eye_W, pieces);
    if (counts) run_W_.push_back(p_W);
  }
  close_run(eye_W, pieces);
}

/// Makes a piece of the present run of returns: along its chord, and kDepth away from `eye_W`.
void KnownThings::close_run(const Vec2& eye_W, std::vector<Solid>& pieces) {
  if (run_W_.size() >= kFewest) {
    const Vec2 chord = run_W_.back() - run_W_.front();
    const double length = chord.norm();
    Solid piece;
    piece.axis_W = length > 0 ? Vec2(chord / length) : Vec2(Vec2::UnitX());
    Vec2 behind(-piece.axis_W.y(), piece.axis_W.x());
    const Vec2 middle = (run_W_.front() + run_W_.back()) / 2;
    if (behind.dot(middle - eye_W) < 0) behind = -behind;
    double nearest = 0;  // [m] of the returns, before the chord
    for (const Vec2& p : run_W_) nearest = std::min(nearest, behind.dot(p - run_W_.front()));
    piece.centre_W = middle + behind * (kDepth + nearest) / 2;
    piece.half = {length / 2, (kDepth - nearest) / 2};
    piece.rounding = kRound;
    pieces.push_back(piece);
  }
  run_W_.clear();
}

bool KnownThings::is_declared(const Vec2& p_W) const {
  return std::ranges::any_of(declared_, [&](const Solid& solid) {
    if (solid.bottom > scan_height_ || solid.top < scan_height_) return false;
    if (at_least_from(solid, p_W) > kSamePlace) return false;
    return distance_to(solid, {p_W.x(), p_W.y(), scan_height_}).distance < kSamePlace;
  });
}

bool KnownThings::set_moving(const Vec2& centre_W, double reach, const Vec2& velocity_W) {
  bool seen = false;
  for (Solid& solid : std::span(all_).subspan(declared_.size())) {
    if ((solid.centre_W - centre_W).norm() >= reach) continue;
    solid.velocity_W = velocity_W;
    seen = true;
  }
  return seen;
}

void KnownThings::find_near(const Vec2& here_W, double reach, std::vector<Solid>& near) const {
  near.clear();
  for (const Solid& solid : all_) {
    if (at_least_from(solid, here_W) < reach) near.push_back(solid);
  }
}

}  // namespace algo
