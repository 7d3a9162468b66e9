// sim/range_caster.cpp: maintains the slice and casts scans from one pose.
#include "sim/range_caster.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/beam_span.hpp"
#include "sim/bearing.hpp"

namespace sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The smallest whole number not below `value`, 0 for a negative one; faster than ceil().
std::uint32_t round_up(double value) {
  const auto whole = static_cast<std::uint32_t>(value < 0 ? 0 : value);
  return whole + (value > static_cast<double>(whole) ? 1 : 0);
}

/// `obstacle`, but of a ramp only the part that reaches up to the plane.
algo::Obstacle slice(const algo::Obstacle& obstacle, double plane_height) {
  algo::Obstacle part = obstacle;
  auto* const ramp = std::get_if<algo::Ramp>(&part.shape);
  if (ramp == nullptr || std::min(ramp->low, part.height) >= plane_height) return part;
  const double share = (plane_height - ramp->low) / (part.height - ramp->low);  // of the length
  const double cut = (share - 0.5) * ramp->length;
  const double end = (part.height > ramp->low ? 0.5 : -0.5) * ramp->length;
  const algo::Vec2 middle_W = algo::to_parent(part.pose_W, {(cut + end) / 2, 0});
  part.pose_W.x = middle_W.x();
  part.pose_W.y = middle_W.y();
  ramp->length = std::abs(end - cut);
  return part;
}

}  // namespace

void BeamPattern::aim(std::vector<double>& ux, std::vector<double>& uy) const {
  ux.resize(beams);
  uy.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    ux[i] = std::cos(angle(i));
    uy[i] = std::sin(angle(i));
  }
}

void RangeCaster::add(const algo::Obstacle& obstacle) {
  if (std::holds_alternative<algo::Trench>(obstacle.shape)) return;  // below all planes
  const auto* ramp = std::get_if<algo::Ramp>(&obstacle.shape);
  const double top = ramp == nullptr ? obstacle.height : std::max(ramp->low, obstacle.height);
  if (top < plane_height_ || obstacle.bottom > plane_height_) return;
  const std::size_t index = obstacles_.size();
  obstacles_.push_back(obstacle);
  ids_.push_back(obstacle.id);
  const std::size_t vertices = algo::outline_W(obstacle).size();
  centre_x_.push_back(0);
  centre_y_.push_back(0);
  bound_.push_back(0);
  first_vertex_.push_back(static_cast<std::uint32_t>(vertex_x_.size()));
  vertex_count_.push_back(static_cast<std::uint32_t>(vertices));
  vertex_x_.resize(vertex_x_.size() + vertices);
  vertex_y_.resize(vertex_y_.size() + vertices);
  near_.resize(obstacles_.size());
  if (outline_.size() < vertices) outline_.resize(vertices);
  place(index);
}

void RangeCaster::move(std::uint32_t id, const algo::Pose2& pose_W) {
  const std::size_t index = find(id);
  if (index == obstacles_.size()) return;
  obstacles_[index].pose_W = pose_W;
  place(index);
}

void RangeCaster::remove(std::uint32_t id) {
  const std::size_t index = find(id);
  if (index == obstacles_.size()) return;
  std::vector<algo::Obstacle> kept = std::move(obstacles_);
  kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(index));
  *this = RangeCaster(plane_height_);
  for (const algo::Obstacle& obstacle : kept) add(obstacle);
}

std::size_t RangeCaster::find(std::uint32_t id) const {
  return static_cast<std::size_t>(std::ranges::find(ids_, id) - ids_.begin());
}

/// Writes the slice of obstacle `index` at its present pose.
void RangeCaster::place(std::size_t index) {
  const algo::Obstacle& obstacle = obstacles_[index];
  if (const auto* cylinder = std::get_if<algo::Cylinder>(&obstacle.shape)) {
    centre_x_[index] = obstacle.pose_W.x;
    centre_y_[index] = obstacle.pose_W.y;
    bound_[index] = cylinder->radius;
    return;
  }
  const std::vector<algo::Vec2> outline = algo::outline_W(slice(obstacle, plane_height_));
  algo::Vec2 low = outline.front();
  algo::Vec2 high = outline.front();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    vertex_x_[first_vertex_[index] + i] = outline[i].x();
    vertex_y_[first_vertex_[index] + i] = outline[i].y();
    low = low.cwiseMin(outline[i]);
    high = high.cwiseMax(outline[i]);
  }
  const algo::Vec2 centre = 0.5 * (low + high);
  double bound = 0;
  for (const algo::Vec2& p : outline) bound = std::max(bound, (p - centre).norm());
  centre_x_[index] = centre.x();
  centre_y_[index] = centre.y();
  bound_[index] = bound;
}

algo::Vec2 RangeCaster::normal_W(std::uint32_t index, const algo::Vec2& p_W) const {
  const std::size_t count = vertex_count_[index];
  if (count == 0) {
    return (p_W - algo::Vec2(centre_x_[index], centre_y_[index])).normalized();
  }
  algo::Vec2 normal{1, 0};
  double nearest = kInfinity;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t a = first_vertex_[index] + i;
    const std::size_t b = first_vertex_[index] + (i + 1 == count ? 0 : i + 1);
    const algo::Vec2 start{vertex_x_[a], vertex_y_[a]};
    const algo::Vec2 edge = algo::Vec2{vertex_x_[b], vertex_y_[b]} - start;
    const double along = std::clamp(edge.dot(p_W - start) / edge.squaredNorm(), 0.0, 1.0);
    const double distance = (p_W - start - along * edge).norm();
    if (distance < nearest) {
      nearest = distance;
      normal = algo::Vec2{edge.y(), -edge.x()}.normalized();  // the outline is counter-clockwise
    }
  }
  return normal;
}

void RangeCaster::use_pattern(const BeamPattern& pattern) {
  if (pattern == pattern_) return;
  const double turn = 2 * std::numbers::pi;
  const double field = pattern.angle_increment * (static_cast<double>(pattern.beams) - 1);
  if (pattern.beams == 0 || !(pattern.angle_increment > 0) || field > turn + 1e-9) {
    throw std::invalid_argument("A beam pattern needs beams, an increment above 0 and one turn.");
  }
  pattern_ = pattern;
  pattern.aim(ux_, uy_);
  per_radian_ = 1 / pattern.angle_increment;
  full_turn_ = turn * per_radian_;
  slack_ = kQuickBearingError * per_radian_;
  narrow_ = field <= std::numbers::pi + 1e-9;
}

/// Fills `near_` with the obstacles whose circle overlaps range and field of view.
void RangeCaster::gather(const algo::Pose2& sensor_W, double range_max, const RaySpread& spread) {
  sensor_W_ = sensor_W;
  cosine_ = std::cos(sensor_W.heading);
  sine_ = std::sin(sensor_W.heading);
  // Outer beams in W. A view of at most half a turn is the region left of the first beam and right
  // of the last. For a wider view, both tests always hold.
  const double fx = narrow_ ? cosine_ * ux_.front() - sine_ * uy_.front() : 0;
  const double fy = narrow_ ? sine_ * ux_.front() + cosine_ * uy_.front() : 0;
  const double lx = narrow_ ? cosine_ * ux_.back() - sine_ * uy_.back() : 0;
  const double ly = narrow_ ? sine_ * ux_.back() + cosine_ * uy_.back() : 0;
  const double margin = spread.shift + spread.turn * range_max + 1e-6;
  std::size_t count = 0;
  near_.resize(obstacles_.size());
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    const double dx = centre_x_[k] - sensor_W.x;
    const double dy = centre_y_[k] - sensor_W.y;
    const double bound = bound_[k] + margin;
    const double reach = bound + range_max;
    // Counted instead of branched on: it is unpredictable which obstacles pass.
    const int in_reach = dx * dx + dy * dy < reach * reach ? 1 : 0;
    const int left_of_first = cross(fx, fy, dx, dy) > -bound ? 1 : 0;
    const int right_of_last = cross(dx, dy, lx, ly) > -bound ? 1 : 0;
    near_[count] = static_cast<std::uint32_t>(k);
    count += static_cast<std::size_t>(in_reach & left_of_first & right_of_last);
  }
  near_.resize(count);
}

algo::Vec2 RangeCaster::centre_in_frame(std::uint32_t index) const {
  const double dx = centre_x_[index] - sensor_W_.x;
  const double dy = centre_y_[index] - sensor_W_.y;
  return {cosine_ * dx + sine_ * dy, cosine_ * dy - sine_ * dx};
}

/// Fills `outline_` with the vertices of obstacle `index` in the sensor's frame.
void RangeCaster::enter_frame(std::uint32_t index) {
  const std::size_t first = first_vertex_[index];
  for (std::size_t i = 0; i < vertex_count_[index]; ++i) {
    const double dx = vertex_x_[first + i] - sensor_W_.x;
    const double dy = vertex_y_[first + i] - sensor_W_.y;
    outline_[i] = {cosine_ * dx + sine_ * dy, cosine_ * dy - sine_ * dx, 0, false};
  }
}

/// Bearing in beams from the first one, in [-2 slack, full turn - 2 slack).
double RangeCaster::bearing(double x, double y) const {
  double beam = (quick_bearing(x, y) - pattern_.angle_min) * per_radian_;
  if (beam < -2 * slack_) beam += full_turn_;
  if (beam < -2 * slack_) beam += full_turn_;
  if (beam >= full_turn_ - 2 * slack_) beam -= full_turn_;
  return beam;
}

double RangeCaster::bearing(Corner& corner) const {
  if (!corner.known) {
    corner.beam = bearing(corner.x, corner.y);
    corner.known = true;
  }
  return corner.beam;
}

/// The first beam at or counter-clockwise of `corner`; decided exactly if it is close.
std::uint32_t RangeCaster::first_beam(const Corner& corner) const {
  auto i = round_up(corner.beam - slack_);
  const auto last = round_up(corner.beam + slack_);
  const auto beams = static_cast<std::uint32_t>(pattern_.beams);
  while (i < last && i < beams && cross(corner.x, corner.y, ux_[i], uy_[i]) < 0) ++i;
  return std::min(i, beams);
}

void RangeCaster::start(std::size_t rays, double range_max, bool with_hits) {
  // Workspace of one cast, shared by all casters of a thread.
  static thread_local std::vector<double> inverse;
  static thread_local std::vector<double> tags;
  inverse.assign(rays, 1 / range_max);
  if (with_hits) tags.assign(rays, -1.0);
  depth_ = {inverse.data(), with_hits ? tags.data() : nullptr};
  rays_ = rays;
}

void RangeCaster::finish(double range_max,
                         std::span<double> ranges,
                         std::span<std::uint32_t> hits) const {
  write_ranges(depth_.inverse, range_max, ranges);
  if (!hits.empty()) write_hits(depth_.tag, hits);
}

/// The sensor is inside obstacle `index`: every ray reads 0.
void RangeCaster::fill_inside(std::uint32_t index) {
  std::fill_n(depth_.inverse, rays_, kInfinity);
  if (depth_.tag != nullptr) std::fill_n(depth_.tag, rays_, static_cast<double>(index));
}

void RangeCaster::cast(const algo::Pose2& sensor_W,
                       const BeamPattern& pattern,
                       double range_max,
                       std::span<double> ranges,
                       std::span<std::uint32_t> hits) {
  use_pattern(pattern);
  gather(sensor_W, range_max, {});
  start(pattern.beams, range_max, !hits.empty());
  for (const std::uint32_t index : near_) {
    if (vertex_count_[index] == 0) {
      flat_circle(index);
    } else {
      flat_outline(index);
    }
  }
  finish(range_max, ranges, hits);
}

void RangeCaster::flat_circle(std::uint32_t index) {
  const algo::Vec2 c = centre_in_frame(index);
  const double radius = bound_[index];
  const double k = c.squaredNorm() - radius * radius;
  if (k <= 0) return fill_inside(index);
  const double half = quick_bearing(std::sqrt(k), radius) * per_radian_ + 2 * slack_;
  const double middle = bearing(c.x(), c.y());
  beam_spans(middle - half,
             middle + half,
             full_turn_,
             pattern_.beams,
             [&](std::uint32_t begin, std::uint32_t end) {
               splat_circle(ux_.data(), uy_.data(), c.x(), c.y(), k, {begin, end}, index, depth_);
             });
}

/// Along the segment p to q, seen counter-clockwise, 1 / r = cross(p - q, u) / cross(p, q).
void RangeCaster::flat_outline(std::uint32_t index) {
  enter_frame(index);
  const std::size_t count = vertex_count_[index];
  bool outside = false;
  for (std::size_t j = 0; j < count; ++j) {
    Corner& q = outline_[j];
    Corner& p = outline_[j + 1 == count ? 0 : j + 1];
    const double area = cross(p.x, p.y, q.x, q.y);
    if (!(area > 0)) continue;  // turned away
    outside = true;
    const double from = bearing(p);
    const double to = bearing(q);
    // The face spans less than half a turn. If it is nearly edge-on, rounding may swap its ends.
    if (from > to && from - to < full_turn_ / 2) continue;
    const double a = (q.y - p.y) / area;
    const double b = (p.x - q.x) / area;
    const auto splat = [&, this](std::uint32_t begin, std::uint32_t end) {
      splat_line(ux_.data(), uy_.data(), a, b, {begin, end}, index, depth_);
    };
    const std::uint32_t begin = first_beam(p);
    const std::uint32_t end = first_beam(q);
    if (from <= to) {
      splat(begin, end);
    } else {  // across the seam behind the pattern's first beam
      splat(begin, static_cast<std::uint32_t>(pattern_.beams));
      splat(0, end);
    }
  }
  if (!outside) fill_inside(index);
}

}  // namespace sim
