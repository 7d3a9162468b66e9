// algo/full_strip/space_time.cpp: the levels, the bins, and the best few states.
#include "algo/full_strip/space_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace algo {
namespace {

constexpr std::size_t kBeam = 60;  // states kept per level
constexpr std::array<double, 11> kLevels{0.2, 0.3, 0.3, 0.4, 0.4, 0.4, 0.4, 0.5, 0.5, 0.5, 0.5};
constexpr double kSubstep = 0.1;                               // [s]
constexpr std::array<double, 5> kSpeeds{1, 0.5, 0, -0.5, -1};  // of the top speed
constexpr std::array<double, 5> kTurns{0, 0.4, -0.4, 1, -1};   // of the top turn rate
constexpr std::size_t kCommands = kSpeeds.size() * kTurns.size();
constexpr double kMargin = 0.08;           // [m] from moving obstacles, at present
constexpr double kMarginPerSecond = 0.12;  // since they may turn
constexpr double kStaticMargin = 0.03;     // [m] from static obstacles,
constexpr double kStaticFloor = 0.02;      // [m] below which only a way out counts
constexpr double kTimePerMetre = 0.6;      // [s/m] to the goal
constexpr double kRiskReach = 0.25;        // [m] room beyond the margin that lowers the risk,
constexpr double kRiskTime = 0.5;          // [s] plus the distance that both drive in this time
constexpr double kRisk = 1.5;              // [s/s] at zero room
constexpr double kRiskFades = 2.5;         // [s] prediction time after which it counts 1/e
constexpr double kReverse = 0.15;          // [s/s] for driving into where the scanner does not look
constexpr double kReach = 6.0;   // [m] tracks farther than this from the motion are ignored
constexpr double kCloser = 0.3;  // of the margins, if nothing else is clear
constexpr double kHeld = 1.5;    // [s] of the candidate motions if none is clear
constexpr double kLater = 0.02;  // [m] bonus in room for every later substep
constexpr double kStaticSlack =
    0.002;  // [m] a position may be this much nearer to static obstacles
constexpr std::size_t kBins = 1 << 16;

Twist2 command(std::size_t index, const MotionLimits& limits) {
  return {kSpeeds[index / kTurns.size()] * limits.max_v,
          kTurns[index % kTurns.size()] * limits.max_omega};
}

/// [m] Distance from the hull to `p` (in R).
double to_hull(const RobotSpec& spec, const Vec2& p) {
  if (spec.half_length <= 0) return p.norm() - spec.radius;
  const double dx = std::max(0.0, std::abs(p.x()) - spec.half_length);
  const double dy = std::max(0.0, std::abs(p.y()) - spec.half_width);
  return std::sqrt(dx * dx + dy * dy);
}

}  // namespace

SpaceTimeSearch::SpaceTimeSearch() : bins_(kBins), bin_round_(kBins) {
  stops_.resize(kCommands);
  states_.reserve(kBeam * kCommands);
  next_.reserve(kBeam * kCommands);
  order_.reserve(kBeam * kCommands);
  near_tracks_.reserve(64);
  near_speeds_.reserve(64);
}

bool SpaceTimeSearch::needed(const SpaceTimeInput& in, const NodeStrip& strip) {
  constexpr double kStep = 0.25;    // [s]
  constexpr int kSteps = 16;        // 4 s
  constexpr double kNear = 0.5;     // [m] sufficient room,
  constexpr double kSpread = 0.15;  // [m/s] and more, the farther the prediction
  const Recycled<Node>& nodes = strip.nodes();
  for (const Track& track : *in.tracks) {
    for (int k = 0; k <= kSteps; ++k) {
      const double time = k * kStep;
      const Vec2 at_W = track.position_W + track.velocity_W * time;
      const double reach = track.radius + in.spec->radius + kNear + kSpread * time;
      const auto near = [&](const Vec2& p_W) { return (p_W - at_W).squaredNorm() < reach * reach; };
      if (near(in.state.pose_W.position())) return true;
      // Anywhere on the strip that the robot may have reached by then.
      const double way = in.limits.max_v * time + NodeStrip::kSpacing;
      const auto end = std::min(nodes.size(), static_cast<std::size_t>(way / NodeStrip::kSpacing));
      for (std::size_t i = 0; i < end; i += 2) {
        if (near(nodes[i].position_W)) return true;
      }
    }
  }
  return false;
}

/// At `time` [s] after the start. Moving obstacles may turn towards the robot at any moment: the
/// faster the two are, the more room the robot needs to see it and to give way.
SpaceTimeSearch::Nearness SpaceTimeSearch::nearness(const SpaceTimeInput& in,
                                                    double time,
                                                    const MotionState& at) const {
  const Vec2 ahead = direction(at.pose_W.heading);
  const double margin = margin_share_ * (kMargin + kMarginPerSecond * time);
  Nearness out{kReach, 0};
  for (std::size_t i = 0; i < near_tracks_.size(); ++i) {
    const Track& track = near_tracks_[i];
    const double reach = kRiskReach + kRiskTime * (near_speeds_[i] + std::abs(at.twist.v));
    const Vec2 d = track.position_W + track.velocity_W * (in.lead + time) - at.pose_W.position();
    const double most = reach + track.radius + in.spec->radius + margin;
    if (d.squaredNorm() > most * most) continue;
    const Vec2 p{ahead.dot(d), cross(ahead, d)};
    const double room = to_hull(*in.spec, p) - track.radius - margin;
    out.room = std::min(out.room, room);
    const double lacking = std::max(0.0, 1 - room / reach);
    out.risk = std::max(out.risk, lacking * lacking);
  }
  return out;
}

/// Drives `s` on for one level. False on a collision.
bool SpaceTimeSearch::step(
    const SpaceTimeInput& in, double time, double length, const Twist2& command, State& s) const {
  const auto substeps = static_cast<int>(std::lround(length / kSubstep));
  for (int k = 1; k <= substeps; ++k) {
    s.motion = advanced(s.motion, command, in.limits, kSubstep);
    const double now = time + k * kSubstep;
    const Nearness near = nearness(in, now, s.motion);
    if (near.room < 0) return false;
    if (in.map->distance(s.motion.pose_W.position()) < in.spec->radius + kStaticMargin &&
        in.hull->clearance(*in.map, s.motion.pose_W) < static_margin_) {
      return false;
    }
    s.risk += kSubstep * kRisk * near.risk * std::exp(-now / kRiskFades);
    if (s.motion.twist.v < -0.05) s.risk += kSubstep * kReverse;
  }
  return true;
}

/// Keeps the cheapest state of each bin of place, heading and speed; of these the best kBeam.
void SpaceTimeSearch::keep_best() {
  order_.resize(next_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
  std::ranges::sort(order_, [&](std::uint32_t a, std::uint32_t b) {
    return next_[a].cost != next_[b].cost ? next_[a].cost < next_[b].cost : a < b;
  });
  ++round_;
  states_.clear();
  for (const std::uint32_t i : order_) {
    const MotionState& m = next_[i].motion;
    const auto x =
        static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(m.pose_W.x / 0.25)));
    const auto y =
        static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(m.pose_W.y / 0.25)));
    const auto h =
        static_cast<std::uint32_t>(std::lround(m.pose_W.heading / (std::numbers::pi / 8)) & 15);
    const auto v = static_cast<std::uint32_t>(std::lround(m.twist.v / 0.5) & 15);
    const std::uint32_t key =
        (x * 73856093U) ^ (y * 19349663U) ^ (h * 83492791U) ^ (v * 2654435761U);
    const std::uint32_t bin = key % kBins;
    if (bin_round_[bin] == round_) continue;
    bin_round_[bin] = round_;
    states_.push_back(next_[i]);
    if (states_.size() == kBeam) break;
  }
}

Twist2 SpaceTimeSearch::search(const SpaceTimeInput& in, Weighing& out) {
  near_tracks_.clear();
  near_speeds_.clear();
  const Vec2 here = in.state.pose_W.position();
  for (const Track& track : *in.tracks) {
    const double reach = kReach + 4 * track.velocity_W.norm();
    if ((track.position_W - here).norm() >= reach) continue;
    near_tracks_.push_back(track);
    near_speeds_.push_back(track.velocity_W.norm());
  }
  // Already too close to a static obstacle: come no closer.
  const double standing = in.hull->clearance(*in.map, in.state.pose_W) - kStaticSlack;
  static_margin_ = std::clamp(standing, kStaticFloor, kStaticMargin);
  const double room = std::min(kStaticFloor, standing);
  for (std::size_t c = 0; c < kCommands; ++c) {
    stops_[c] = stops_clear(in, command(c, in.limits), room) ? 1 : 0;
  }
  const Twist2 wanted = attempt(in, 1, out);
  if (clear_) return wanted;
  const Twist2 closer = attempt(in, kCloser, out);
  return clear_ ? closer : least_bad(in);
}

Twist2 SpaceTimeSearch::attempt(const SpaceTimeInput& in, double margin_share, Weighing& out) {
  margin_share_ = margin_share;
  states_.assign(1, State{in.state, 0, 0, 0});
  Twist2 best{};
  std::array<bool, kCommands> alive{};
  double time = 0;
  clear_ = true;
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    next_.clear();
    for (const State& from : states_) {
      for (std::size_t c = 0; c < kCommands; ++c) {
        if (level == 0 && stops_[c] == 0) continue;
        State s = from;
        if (level == 0) s.first = static_cast<std::uint32_t>(c);
        if (!step(in, time, kLevels[level], command(c, in.limits), s)) continue;
        if (level == 0) alive[c] = true;
        const double left = (s.motion.pose_W.position() - in.carrot_W).norm() + in.beyond;
        // A heading away from the direction to go costs a turn first.
        const Vec2 to = in.carrot_W - s.motion.pose_W.position();
        const double error =
            std::abs(wrap_angle(std::atan2(to.y(), to.x()) - s.motion.pose_W.heading));
        s.cost = s.risk + kTimePerMetre * left + 0.15 * error / in.limits.max_omega;
        next_.push_back(s);
      }
    }
    if (next_.empty()) {
      clear_ = false;
      break;
    }
    keep_best();
    best = command(states_.front().first, in.limits);
    time += kLevels[level];
  }
  out.candidates.clear();
  for (std::size_t c = 0; c < kCommands; ++c) {
    const Twist2 twist = command(c, in.limits);
    out.candidates.push_back({twist, kLevels[0], alive[c], twist == best});
  }
  return best;
}

/// True if `twist` for one step, then braking, keeps `room` [m] from static obstacles.
bool SpaceTimeSearch::stops_clear(const SpaceTimeInput& in,
                                  const Twist2& twist,
                                  double room) const {
  MotionState state = in.state;
  for (int k = 1; k * kSubstep <= kLevels[0]; ++k) {
    state = advanced(state, twist, in.limits, kSubstep);
    if (in.hull->clearance(*in.map, state.pose_W) < room) return false;
  }
  return rests_clear(*in.map, *in.hull, state, in.limits, kSubstep, room);
}

/// The command that, held for a while, keeps the most room. Never drives into static obstacles for
/// the sake of a predicted motion.
Twist2 SpaceTimeSearch::least_bad(const SpaceTimeInput& in) const {
  Twist2 best{};
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < kCommands; ++c) {
    if (stops_[c] == 0) continue;
    const Twist2 twist = command(c, in.limits);
    MotionState state = in.state;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 1; k * kSubstep <= kHeld; ++k) {
      state = advanced(state, twist, in.limits, kSubstep);
      const double standing = in.hull->clearance(*in.map, state.pose_W);
      // Later approaches may still be avoided.
      least =
          std::min(least, std::min(standing, nearness(in, k * kSubstep, state).room) + kLater * k);
    }
    if (least <= most) continue;
    most = least;
    best = twist;
  }
  return best;
}

}  // namespace algo
