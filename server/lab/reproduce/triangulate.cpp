// server/lab/reproduce/triangulate.cpp: cuts off one ear after the other.
#include "server/lab/reproduce/triangulate.hpp"

#include <algorithm>

namespace server::reproduce {
namespace {

using algo::Vec2;
using Outline = std::vector<Vec2>;

/// Twice the area of a, b, c; positive when they turn left.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

double twice_area(const Outline& outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2& a = outline[i];
    const Vec2& b = outline[(i + 1) % outline.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

bool crosses(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

bool crosses_itself(const Outline& outline) {
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = i + 1; k < n; ++k) {
      if (crosses(outline[i], outline[(i + 1) % n], outline[k], outline[(k + 1) % n])) return true;
    }
  }
  return false;
}

bool convex(const Outline& outline) {
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (turn(outline[i], outline[(i + 1) % n], outline[(i + 2) % n]) < 0) return false;
  }
  return true;
}

/// Vertex `i` can be cut off: it turns left and no other vertex lies in its triangle.
bool is_ear(const Outline& outline, std::size_t i) {
  const std::size_t n = outline.size();
  const Vec2& a = outline[(i + n - 1) % n];
  const Vec2& b = outline[i];
  const Vec2& c = outline[(i + 1) % n];
  if (!(turn(a, b, c) > 0)) return false;
  return std::ranges::none_of(outline, [&](const Vec2& p) {
    if (p == a || p == b || p == c) return false;
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
  });
}

}  // namespace

std::optional<std::vector<Outline>> convex_parts(Outline outline) {
  if (outline.size() < 3 || crosses_itself(outline)) return std::nullopt;
  const double area = twice_area(outline);
  if (area == 0) return std::nullopt;
  if (area < 0) std::ranges::reverse(outline);
  if (convex(outline)) return std::vector<Outline>{outline};
  std::vector<Outline> parts;
  while (outline.size() > 3) {
    const std::size_t n = outline.size();
    std::size_t ear = 0;
    while (ear < n && !is_ear(outline, ear)) ++ear;
    if (ear == n) return std::nullopt;
    parts.push_back({outline[(ear + n - 1) % n], outline[ear], outline[(ear + 1) % n]});
    outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  if (turn(outline[0], outline[1], outline[2]) > 0) parts.push_back(outline);
  return parts;
}

}  // namespace server::reproduce
