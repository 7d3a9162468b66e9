// algo/mapping/scan_matcher.cpp: fits lines to points, and computes a step of the pose.
#include "algo/mapping/scan_matcher.hpp"

#include <Eigen/Cholesky>

namespace algo {
namespace {

constexpr std::size_t kFewestOnLine = 3;
constexpr double kRoundest = 0.15;  // largest ratio of smaller to larger variance of a line

}  // namespace

void SurfaceFit::add(const Vec2& point, double weight) {
  ++count_;
  weight_ += weight;
  sum_ += weight * point;
  xx_ += weight * point.x() * point.x();
  xy_ += weight * point.x() * point.y();
  yy_ += weight * point.y() * point.y();
}

std::optional<Surface> SurfaceFit::line() const {
  if (count_ < kFewestOnLine) return std::nullopt;
  const Vec2 mean = sum_ / weight_;
  const double xx = xx_ / weight_ - mean.x() * mean.x();
  const double xy = xy_ / weight_ - mean.x() * mean.y();
  const double yy = yy_ / weight_ - mean.y() * mean.y();
  const double middle = (xx + yy) / 2;
  const double half = std::hypot((xx - yy) / 2, xy);
  if (!(half > 0) || middle - half > kRoundest * (middle + half)) return std::nullopt;
  const double along = std::atan2(2 * xy, xx - yy) / 2;  // of the larger variance
  return Surface{mean, {-std::sin(along), std::cos(along)}};
}

void ScanMatcher::take(const LaserScan& scan, double reach) {
  scan_R_.take(scan, scan.mount_R, reach);
  take(scan_R_);
}

void ScanMatcher::take(std::span<const Vec2> points_R) {
  points_R_.assign(points_R.begin(), points_R.end());
  facings_R_.clear();
}

void ScanMatcher::take(const FacedPoints& scan_R) {
  points_R_.clear();
  facings_R_.clear();
  for (std::size_t i = 0; i < scan_R.points.size(); ++i) {
    const Vec2& p_R = scan_R.points[i];
    const bool apart =
        points_R_.empty() || (p_R - points_R_.back()).squaredNorm() >= kSpacing * kSpacing;
    if (!apart) continue;
    points_R_.push_back(p_R);
    facings_R_.push_back(scan_R.facings[i]);
  }
}

Vec2 ScanMatcher::middle() const {
  Vec2 sum(0, 0);
  for (const Vec2& p_R : points_R_) sum += p_R;
  return points_R_.empty() ? sum : (sum / static_cast<double>(points_R_.size())).eval();
}

ScanMatcher::Step::Step(const Pose2& pose_W, const Pose2& guess_W, const MatchPrior& prior)
    : pose_W_(pose_W) {
  const Eigen::Vector3d weight{prior.position, prior.position, prior.heading};
  const Eigen::Vector3d off{
      pose_W.x - guess_W.x, pose_W.y - guess_W.y, wrap_angle(pose_W.heading - guess_W.heading)};
  prior_.diagonal() = weight;
  g_ = weight.cwiseProduct(off);
}

void ScanMatcher::Step::add(const Vec2& p_W, const Surface& surface, double scale) {
  const double residual = surface.normal_W.dot(p_W - surface.on_W);
  const double ratio = residual / scale;
  const double root = 1 / (1 + ratio * ratio);
  const double weight = root * root;  // Geman and McClure
  const Vec2 arm = p_W - pose_W_.position();
  const Eigen::Vector3d slope{surface.normal_W.x(),
                              surface.normal_W.y(),
                              surface.normal_W.y() * arm.x() - surface.normal_W.x() * arm.y()};
  points_ += weight * slope * slope.transpose();
  g_ += weight * residual * slope;
  ++used_;
}

Pose2 ScanMatcher::Step::taken() const {
  const Eigen::Vector3d step = (prior_ + points_).ldlt().solve(-g_);
  if (!step.allFinite()) return pose_W_;
  return {pose_W_.x + step.x(), pose_W_.y + step.y(), wrap_angle(pose_W_.heading + step.z())};
}

}  // namespace algo
