// algo/full_strip/maneuver.cpp: the lattice search, and the driving of its result.
#include "algo/full_strip/maneuver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace algo {
namespace {

constexpr double kNotch = 2 * std::numbers::pi / 32;  // [rad] between neighbouring headings

struct Action {
  double length = 0;  // [m]
  double turn = 0;    // [rad]
  float cost = 0;     // [m]
};
constexpr double kAhead = 0.10;  // [m]
constexpr std::array<Action, 12> kActions{{{kAhead, 0, 0.10F},
                                           {kAhead, kNotch, 0.11F},
                                           {kAhead, -kNotch, 0.11F},
                                           {kAhead, 2 * kNotch, 0.13F},
                                           {kAhead, -2 * kNotch, 0.13F},
                                           {-kAhead, 0, 0.14F},
                                           {-kAhead, kNotch, 0.15F},
                                           {-kAhead, -kNotch, 0.15F},
                                           {-kAhead, 2 * kNotch, 0.17F},
                                           {-kAhead, -2 * kNotch, 0.17F},
                                           {0, kNotch, 0.06F},
                                           {0, -kNotch, 0.06F}}};
constexpr std::size_t kMostPieces = 256;  // pieces reserved from the start
constexpr float kShift = 0.10F;           // [m] cost of changing between forward, back and turning
constexpr double kSpeed = 0.3;            // [m/s] of a piece
constexpr double kTurnSpeed = 0.8;        // [rad/s]
constexpr double kTurnSlowly = 0.4;       // [rad/s] near the end of a turn
constexpr double kAimAhead = 0.20;        // [m] ahead on the piece, the point to steer for

/// The pose after the fraction `share` of an arc.
Pose2 along(const Pose2& from, double length, double turn, double share) {
  return integrate_arc(from, {length, turn}, share);
}

int sign(double value) {
  return value > 0 ? 1 : (value < 0 ? -1 : 0);
}

}  // namespace

ManeuverSearch::ManeuverSearch() : nodes_(static_cast<std::size_t>(kCells) * kCells * kHeadings) {
  heap_.reserve(4 * nodes_.size() / 10);
  pieces_.reserve(kMostPieces);
}

std::optional<std::uint32_t> ManeuverSearch::node_at(const Pose2& pose_W) const {
  const double half = kCells * kCell / 2;
  const double x = (pose_W.x - start_W_.x + half) / kCell;
  const double y = (pose_W.y - start_W_.y + half) / kCell;
  if (!(x >= 0 && y >= 0 && x < kCells && y < kCells)) return std::nullopt;
  const auto h = static_cast<int>(std::lround(pose_W.heading / kNotch)) & (kHeadings - 1);
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  return static_cast<std::uint32_t>((row * kCells + column) * kHeadings + h);
}

bool ManeuverSearch::free(const LocalMap& map,
                          const HullCheck& hull,
                          const Pose2& from,
                          const Piece& piece) const {
  const Pose2 middle_W = along(from, piece.length, piece.turn, 0.5);
  const Twist2 way{piece.length, piece.turn};
  return !hull.enters_unseen(map.seen(), middle_W, way) &&
         !hull.enters_unseen(map.seen(), piece.end_W, way) &&
         hull.clearance(map, middle_W) >= margin_ && hull.clearance(map, piece.end_W) >= margin_;
}

void ManeuverSearch::push(std::uint32_t node, float g, const Pose2& pose_W) {
  Node& n = nodes_[node];
  n.opened = round_;
  n.g = g;
  n.x = static_cast<float>(pose_W.x);
  n.y = static_cast<float>(pose_W.y);
  n.heading = static_cast<float>(pose_W.heading);
  const auto left = static_cast<float>((pose_W.position() - target_W_).norm());
  heap_.push_back({g + left, node});
  std::ranges::push_heap(heap_, std::greater{}, &Entry::f);
}

void ManeuverSearch::start(const Pose2& start_W, const Vec2& target_W, double margin) {
  start_W_ = start_W;
  target_W_ = target_W;
  margin_ = margin;
  ++round_;
  heap_.clear();
  pieces_.clear();
  const std::uint32_t first = *node_at(start_W);
  nodes_[first].parent = first;
  nodes_[first].action = kActions.size();
  push(first, 0, start_W);
  state_ = State::Searching;
}

ManeuverSearch::State ManeuverSearch::search(const LocalMap& map,
                                             const HullCheck& hull,
                                             const std::function<bool(const Pose2&)>& arrived,
                                             int budget) {
  while (state_ == State::Searching && budget-- > 0) {
    if (heap_.empty()) return state_ = State::NoWay;
    std::ranges::pop_heap(heap_, std::greater{}, &Entry::f);
    const std::uint32_t node = heap_.back().node;
    heap_.pop_back();
    Node& n = nodes_[node];
    if (n.closed == round_) continue;
    n.closed = round_;
    if (n.parent != node && arrived({n.x, n.y, n.heading})) {
      trace(node);
      return state_ = State::Found;
    }
    expand(map, hull, node);
  }
  return state_;
}

void ManeuverSearch::expand(const LocalMap& map, const HullCheck& hull, std::uint32_t node) {
  const Node from = nodes_[node];
  const Pose2 pose{from.x, from.y, from.heading};
  for (std::size_t a = 0; a < kActions.size(); ++a) {
    const Action& action = kActions[a];
    Piece piece{along(pose, action.length, action.turn, 1), action.length, action.turn};
    const auto next = node_at(piece.end_W);
    if (!next || nodes_[*next].closed == round_) continue;
    float g = from.g + action.cost;
    const bool begun = from.action < kActions.size();
    if (begun && sign(kActions[from.action].length) != sign(action.length)) g += kShift;
    if (nodes_[*next].opened == round_ && nodes_[*next].g <= g) continue;
    if (!free(map, hull, pose, piece)) continue;
    nodes_[*next].parent = node;
    nodes_[*next].action = static_cast<std::uint8_t>(a);
    push(*next, g, piece.end_W);
  }
}

void ManeuverSearch::trace(std::uint32_t node) {
  pieces_.clear();
  for (; nodes_[node].parent != node; node = nodes_[node].parent) {
    const Node& n = nodes_[node];
    const Action& action = kActions[n.action];
    pieces_.push_back({{n.x, n.y, n.heading}, action.length, action.turn});
  }
  std::reverse(pieces_.begin(), pieces_.end());
}

ManeuverDrive::ManeuverDrive() {
  pieces_.reserve(kMostPieces);
}

void ManeuverDrive::start(const Recycled<Piece>& pieces) {
  pieces_ = pieces;
  next_ = 0;
}

std::optional<Twist2> ManeuverDrive::next(const Pose2& pose_W, const MotionLimits& limits) {
  for (; next_ < pieces_.size(); ++next_) {
    const Piece& piece = pieces_[next_];
    const int way = sign(piece.length);
    if (way == 0) {
      // Consecutive turns are merged.
      std::size_t last = next_;
      while (last + 1 < pieces_.size() && pieces_[last + 1].length == 0) ++last;
      const double error = wrap_angle(pieces_[last].end_W.heading - pose_W.heading);
      if (std::abs(error) < 0.06) {
        next_ = last;
        continue;
      }
      const double most = std::min(kTurnSpeed, limits.max_omega);
      const double w = std::clamp(2.5 * std::abs(error), std::min(kTurnSlowly, most), most);
      return Twist2{0, error > 0 ? w : -w};
    }
    const Vec2 ahead = direction(piece.end_W.heading) * way;
    if ((pose_W.position() - piece.end_W.position()).dot(ahead) > -0.02) continue;
    // Steers for a point some way ahead on the pieces with the same direction.
    std::size_t aim = next_;
    while (aim + 1 < pieces_.size() && sign(pieces_[aim + 1].length) == way &&
           (pieces_[aim].end_W.position() - pose_W.position()).norm() < kAimAhead) {
      ++aim;
    }
    const Vec2 to = pieces_[aim].end_W.position() - pose_W.position();
    const Vec2 p = to_child(pose_W, pieces_[aim].end_W.position());
    const double curvature = 2 * p.y() / std::max(1e-4, p.squaredNorm());
    double v = std::min(kSpeed, limits.max_v);
    v = std::min(v, std::max(0.1, std::sqrt(2 * 0.3 * limits.acceleration * to.norm())));
    v = std::min(v, limits.max_omega / std::max(0.1, std::abs(curvature)));
    return Twist2{way * v, std::clamp(way * v * curvature, -limits.max_omega, limits.max_omega)};
  }
  return std::nullopt;
}

}  // namespace algo
