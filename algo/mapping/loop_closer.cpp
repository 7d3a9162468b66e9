// algo/mapping/loop_closer.cpp: candidates, their search and verification, and the agreement of
// several.
#include "algo/mapping/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <Eigen/LU>

#include "algo/mapping/step_edges.hpp"

namespace algo {
namespace {

constexpr std::size_t kFewestBetween = 3;  // submaps; closer ones share scans
constexpr double kOverlap = 8;             // [m] between the centres of submaps that share enough
constexpr double kDeviations = 3;          // of the pose, to the edge of the window
constexpr double kLargestSurprise = 3.5;   // of a loop that is taken at once, in deviations
constexpr double kLeastWindow = 0.3;       // [m]
constexpr double kLeastTurnWindow = 0.05;  // [rad]
constexpr double kMostWindow = 40;         // [m]
constexpr double kMostTurnWindow = 0.6;    // [rad]
constexpr double kNearWindow = 1.0;        // [m] too small to hold a place that looks alike
// Each submap in a known place that fits nowhere makes the graph less to be trusted.
constexpr double kSame = 5;            // [m] between the centres of submaps of one place
constexpr std::size_t kOld = 12;       // submaps ago
constexpr double kWidening = 0.5;      // [m]
constexpr double kMostWidening = 5;    // [m]
constexpr double kTurnWidening = 0.1;  // [rad per m]
constexpr std::size_t kMostNear = 6;   // candidates
constexpr std::size_t kMostFar = 40;
constexpr double kSearchSpacing = 0.3;  // [m] between the points of a search
constexpr double kMatchSpacing = 0.1;   // [m] likewise of a match
constexpr double kLeastScore = 0.4;
constexpr double kRivalScore = 0.85;  // of the best: also worth a look
constexpr double kRivalApart = 1.0;   // [m]
constexpr std::size_t kMostPeaks = 3;
constexpr MatchPrior kLoopPrior{.position = 0.1, .heading = 0.1};

constexpr double kScanPoints = 150;

constexpr double kOnWallWithin = 0.12;      // [m]
constexpr double kNearWall = 0.35;          // [m]
constexpr double kLeastCommon = 0.35;       // of the points, in the other's seen area
constexpr double kLeastFit = 0.65;          // of the common points, on walls
constexpr double kMostContradicted = 0.15;  // of the common points, in free space

constexpr std::size_t kQuorum = 3;   // submaps that agree
constexpr std::size_t kMemory = 20;  // submaps whose loops wait
constexpr double kLead = 0.8;        // of the sum of fits over that of any other set
constexpr double kLoopDoubt = 4;

}  // namespace

bool LoopCloser::Candidate::near() const {
  return std::max(window.x, window.y) <= kNearWindow;
}

bool LoopCloser::take(std::size_t k, Submap submap, PoseGraph& graph) {
  submaps_.push_back(std::move(submap));
  bool any = close_near(k, graph);
  if (!any) any = close_far(k, graph);
  if (met_) {
    misses_ = 0;
  } else if (expected_) {
    ++misses_;
  }
  return any;
}

std::vector<LoopCloser::Candidate> LoopCloser::candidates(std::size_t later,
                                                          PoseGraph& graph) const {
  std::vector<Candidate> found;
  if (later < kFewestBetween) return found;
  for (std::size_t a = 0; a + kFewestBetween <= later; ++a) {
    Candidate candidate{.earlier = a, .guess = pose_step(graph.pose(a), graph.pose(later))};
    const Vec2 centre = to_parent(candidate.guess, submaps_[later].centre());
    candidate.apart = (centre - submaps_[a].centre()).norm();
    if (candidate.apart > kOverlap + kMostWindow) continue;
    const Eigen::Matrix3d covariance = graph.covariance(a, later);
    const auto half = [&](int k) { return kDeviations * std::sqrt(covariance(k, k)); };
    candidate.window = {std::clamp(half(0), kLeastWindow, kMostWindow),
                        std::clamp(half(1), kLeastWindow, kMostWindow),
                        std::clamp(half(2), kLeastTurnWindow, kMostTurnWindow)};
    const bool old = a + kOld <= later;
    candidate.expected = old && candidate.apart < kSame && candidate.near();
    const double wide = old ? std::min(misses_ * kWidening, kMostWidening) : 0;
    candidate.window.x += wide;
    candidate.window.y += wide;
    candidate.window.heading =
        std::min(candidate.window.heading + wide * kTurnWidening, kMostTurnWindow);
    if (candidate.apart > kOverlap + std::max(candidate.window.x, candidate.window.y)) continue;
    found.push_back(candidate);
  }
  std::ranges::stable_sort(found, {}, &Candidate::apart);
  return found;
}

void LoopCloser::search(std::size_t later, const Candidate& candidate, std::vector<Loop>& out) {
  const Submap& earlier = submaps_[candidate.earlier];
  if (earlier.walls().empty() || submaps_[later].walls().empty()) return;
  const LoopSearch grid(earlier);
  const std::vector<Vec2> points = submaps_[later].thinned(kSearchSpacing).points;
  std::vector<FoundPose> peaks;
  const std::size_t most = candidate.near() ? 1 : kMostPeaks;
  double least = kLeastScore;
  while (peaks.size() < most) {
    const auto found =
        grid.best(points, candidate.guess, candidate.window, least, peaks, kRivalApart);
    if (!found) break;
    peaks.push_back(*found);
    least = std::max(kLeastScore, kRivalScore * peaks.front().score);
  }
  for (const FoundPose& peak : peaks) {
    Loop loop{.earlier = candidate.earlier, .later = later, .step = peak.pose};
    if (verify(loop)) out.push_back(loop);
  }
}

/// Aligns the walls of the two submaps, and compares what each saw.
bool LoopCloser::verify(Loop& loop) {
  const Submap& earlier = submaps_[loop.earlier];
  const FacedPoints walls = submaps_[loop.later].thinned(kMatchSpacing);
  matcher_.take(walls);
  const ScanMatch match = matcher_.match(earlier, loop.step, kLoopPrior);
  if ((match.pose_W.position() - loop.step.position()).norm() > kNearWindow) return false;
  loop.step = match.pose_W;
  std::size_t common = 0;
  std::size_t fits = 0;
  std::size_t contradicted = 0;
  for (std::size_t i = 0; i < walls.points.size(); ++i) {
    const Vec2 p = to_parent(loop.step, walls.points[i]);
    const Facing facing = walls.facings[i].turned(loop.step.heading);
    if (earlier.wall_within(p, facing, kOnWallWithin)) {
      ++fits;
      ++common;
    } else if (earlier.wall_within(p, facing, kNearWall)) {
      ++common;
    } else if (earlier.is_free(p)) {
      ++contradicted;
      ++common;
    }
  }
  const auto all = static_cast<double>(walls.points.size());
  const auto both = static_cast<double>(common);
  if (both < kLeastCommon * all) return false;
  loop.fit = static_cast<double>(fits) / both;
  if (loop.fit < kLeastFit || static_cast<double>(contradicted) > kMostContradicted * both) {
    return false;
  }
  // A submap has many times the points of a scan, and they err together.
  ScanMatch even = match;
  even.points *= std::min(1.0, kScanPoints / all);
  loop.information = loop_information(match_information(even));
  return true;
}

void LoopCloser::close(const Loop& loop, PoseGraph& graph) {
  closed_.push_back(loop);
  met_ = met_ || loop.earlier + kOld <= loop.later;
  graph.add({.from = loop.earlier,
             .to = loop.later,
             .step = loop.step,
             .information = loop.information,
             .doubt = kLoopDoubt});
}

/// Mahalanobis distance of a loop from where the graph expects it.
double LoopCloser::surprise(const Loop& loop, PoseGraph& graph) const {
  const Pose2 expected = pose_step(graph.pose(loop.earlier), graph.pose(loop.later));
  const Vec3 off(expected.x - loop.step.x,
                 expected.y - loop.step.y,
                 wrap_angle(expected.heading - loop.step.heading));
  constexpr double kUnmeasured = 1e-6;  // information that makes a direction without any invertible
  const Eigen::Matrix3d measured =
      (loop.information + kUnmeasured * Eigen::Matrix3d::Identity()).inverse();
  const Eigen::Matrix3d both = graph.covariance(loop.earlier, loop.later) + measured;
  return std::sqrt(off.dot(both.inverse() * off));
}

bool LoopCloser::close_near(std::size_t later, PoseGraph& graph) {
  std::vector<Loop> found;
  std::size_t tried = 0;
  expected_ = false;
  met_ = false;
  for (const Candidate& candidate : candidates(later, graph)) {
    expected_ = expected_ || candidate.expected;
    if (!candidate.near()) continue;
    search(later, candidate, found);
    if (++tried == kMostNear) break;
  }
  const auto odd = std::ranges::stable_partition(
      found, [&](const Loop& loop) { return surprise(loop, graph) < kLargestSurprise; });
  pending_.insert(pending_.end(), odd.begin(), odd.end());
  found.erase(odd.begin(), found.end());
  for (const Loop& loop : found) close(loop, graph);
  if (!found.empty()) graph.solve();
  return !found.empty();
}

bool LoopCloser::close_far(std::size_t later, PoseGraph& graph) {
  std::size_t tried = 0;
  std::vector<Loop> found;
  for (const Candidate& candidate : candidates(later, graph)) {
    if (candidate.near()) continue;
    search(later, candidate, found);
    if (++tried == kMostFar) break;
  }
  pending_.insert(pending_.end(), found.begin(), found.end());
  std::erase_if(pending_, [&](const Loop& loop) {
    return loop.later + kMemory < later || !complete(loop.information);
  });
  if (pending_.empty()) return false;
  const std::vector<Loop> set = believed(graph);
  if (set.empty()) return false;
  for (const Loop& loop : set) close(loop, graph);
  pending_.clear();
  graph.solve();
  return true;
}

/// From one earlier submap round both loops and back.
bool LoopCloser::agree(const Loop& a, const Loop& b, PoseGraph& graph) const {
  const Pose2 later = pose_step(graph.pose(a.later), graph.pose(b.later));
  const Pose2 earlier = pose_step(graph.pose(a.earlier), graph.pose(b.earlier));
  const Pose2 error = pose_step(compose(a.step, later), compose(earlier, b.step));
  const auto deviation = [&](std::size_t from, std::size_t to) {
    if (from == to) return Vec2(0, 0);
    const Eigen::Matrix3d c = graph.covariance(std::min(from, to), std::max(from, to));
    return Vec2(std::sqrt(c(0, 0) + c(1, 1)), std::sqrt(c(2, 2)));
  };
  const Vec2 open = kDeviations * (deviation(a.later, b.later) + deviation(a.earlier, b.earlier));
  const double reach = std::min(2.0, 0.3 + 0.02 * later.position().norm() + open.x());
  const double turn = std::min(0.2, 0.05 + open.y());
  return error.position().norm() < reach && std::abs(error.heading) < turn;
}

/// Sum of the fits of the loops in `members`, of each later submap the best one only.
double LoopCloser::support(const std::vector<std::size_t>& members) const {
  double sum = 0;
  for (const std::size_t i : best_of_each(members)) sum += pending_[i].fit;
  return sum;
}

std::vector<std::size_t> LoopCloser::best_of_each(const std::vector<std::size_t>& members) const {
  std::vector<std::size_t> best;
  for (const std::size_t i : members) {
    const auto same = std::ranges::find_if(
        best, [&](std::size_t k) { return pending_[k].later == pending_[i].later; });
    if (same == best.end()) {
      best.push_back(i);
    } else if (pending_[*same].fit < pending_[i].fit) {
      *same = i;
    }
  }
  return best;
}

/// The largest set of waiting loops that agree with one of them, if it is large enough and leads
/// all sets of loops that contradict it.
std::vector<Loop> LoopCloser::believed(PoseGraph& graph) const {
  const std::size_t count = pending_.size();
  std::vector<std::vector<std::size_t>> sets(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (i == j || agree(pending_[i], pending_[j], graph)) sets[i].push_back(j);
    }
  }
  std::size_t best = 0;
  double most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (const double sum = support(sets[i]); sum > most) {
      most = sum;
      best = i;
    }
  }
  const std::vector<std::size_t> chosen = best_of_each(sets[best]);
  if (chosen.size() < kQuorum) return {};
  for (const std::vector<std::size_t>& set : sets) {
    std::vector<std::size_t> against;
    std::ranges::set_difference(set, sets[best], std::back_inserter(against));
    if (support(against) > most - kLead) return {};
  }
  std::vector<Loop> out;
  out.reserve(chosen.size());
  for (const std::size_t i : chosen) out.push_back(pending_[i]);
  return out;
}

}  // namespace algo
