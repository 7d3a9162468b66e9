// server/lab/mapping/drawings.cpp: three buildings, and maps of them that are out of date.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "server/lab/mapping/locate_study.hpp"

namespace server::mapping {
namespace {

using algo::Vec2;

constexpr double kHalfAisle = 1.3;  // [m] from a corridor's middle to its walls

Drawing offices(std::uint64_t seed) {
  constexpr double w = kHalfAisle;
  constexpr double kLong = 70;  // [m] between the corridors' middles
  constexpr double kWide = 30;
  CorridorWalls walls(seed);
  walls.side({-w, -w}, {kLong + w, -w});
  walls.side({kLong + w, -w}, {kLong + w, kWide + w});
  walls.side({kLong + w, kWide + w}, {-w, kWide + w});
  walls.side({-w, kWide + w}, {-w, -w});
  walls.side({w, kWide - w}, {kLong - w, kWide - w});
  walls.side({kLong - w, kWide - w}, {kLong - w, w});
  walls.side({kLong - w, w}, {w, w});
  walls.side({w, w}, {w, kWide - w});
  return {"offices", walls.pieces(), {{2, 0}, {kLong, 0}, {kLong, 22}}};
}

Drawing hall(std::uint64_t seed) {
  constexpr double kLong = 72;  // [m]
  constexpr double kWide = 36;
  CorridorWalls walls(seed);
  sim::Random random(seed, 0x4a11);
  walls.wall({0, 0}, {kLong, 0});
  walls.wall({kLong, 0}, {kLong, kWide});
  walls.wall({kLong, kWide}, {0, kWide});
  walls.wall({0, kWide}, {0, 0});
  for (double x = 6; x < kLong; x += 12) {
    for (double y = 6; y < kWide; y += 12) {
      const std::array<Vec2, 4> corners{
          Vec2(x, y), Vec2(x + 0.6, y), Vec2(x + 0.6, y + 0.6), Vec2(x, y + 0.6)};
      for (std::size_t k = 0; k < 4; ++k) walls.wall(corners[k], corners[(k + 1) % 4]);
    }
  }
  // Shelves stand clear of the ways along y = 3, x = 66 and between the rows.
  for (int k = 0; k < 40; ++k) {
    const double x = random.uniform(3, 62);
    const double y = 9 + 12 * std::floor(random.uniform(0, 2)) + random.uniform(-2, 2);
    walls.furniture({x, y, 0}, random.uniform(0.8, 3), random.uniform(0.4, 0.9));
  }
  return {"hall", walls.pieces(), {{3, 3}, {66, 3}, {66, 33}}};
}

/// The second corridor repeats the first one, door by door.
Drawing wings(std::uint64_t seed) {
  constexpr double w = kHalfAisle;
  constexpr double kLong = 60;
  constexpr double kApart = 30;
  CorridorWalls walls(seed);
  for (const double y : {0.0, kApart}) {
    CorridorWalls wing(seed);  // the same doors
    wing.side({0, y - w}, {kLong, y - w});
    wing.side({kLong, y + w}, {0, y + w});
    wing.wall({0, y + w}, {0, y - w});
    walls.append(wing);
  }
  walls.side({kLong, -w}, {kLong + 8, -w});
  walls.side({kLong + 8, -w}, {kLong + 8, kApart + w});
  walls.side({kLong + 8, kApart + w}, {kLong, kApart + w});
  walls.side({kLong, kApart - w}, {kLong, w});
  walls.furniture({kLong + 5, 6, 0.4}, 1.5, 0.8);
  walls.furniture({kLong + 3, 19, 1.1}, 0.9, 0.9);
  return {"wings", walls.pieces(), {{3, 0}, {kLong + 1.5, 0}, {kLong + 1.5, 26}}};
}

double length_of(const Piece& piece) {
  const std::vector<Vec2> outline_W = algo::outline_W(piece.obstacle);
  double length = 0;
  for (std::size_t k = 0; k < outline_W.size(); ++k) {
    length += (outline_W[(k + 1) % outline_W.size()] - outline_W[k]).norm();
  }
  return length;
}

/// [m] From the way to the nearest point of the piece's outline.
double clearance(const Drawing& drawing, const Piece& piece) {
  double least = 1e9;
  for (std::size_t k = 1; k < drawing.way_W.size(); ++k) {
    const Vec2 leg = drawing.way_W[k] - drawing.way_W[k - 1];
    for (double at = 0; at <= leg.norm(); at += 0.25) {
      const Vec2 p_W = drawing.way_W[k - 1] + at * leg.normalized();
      least = std::min(least, algo::signed_distance(piece.obstacle, p_W));
    }
  }
  return least;
}

}  // namespace

Drawing drawing_of(const std::string& name, std::uint64_t seed) {
  if (name == "offices") return offices(seed);
  if (name == "hall") return hall(seed);
  if (name == "wings") return wings(seed);
  throw std::invalid_argument("There is no drawing \"" + name + "\": offices, hall and wings.");
}

std::vector<Piece> outdated(const Drawing& drawing, double share, std::uint64_t seed) {
  sim::Random random(seed, 0x01d);
  std::vector<Piece> map = drawing.pieces;
  double all = 0;
  for (const Piece& piece : map) all += length_of(piece);
  double wrong = 0;
  while (wrong < share * all) {
    const auto k = static_cast<std::size_t>(random.uniform(0, static_cast<double>(map.size())));
    Piece& piece = map[k];
    if (random.uniform() < 0.3) {  // since the map was drawn, this went away
      Piece gone{{.id = static_cast<std::uint32_t>(map.size() + 1)}, false};
      gone.obstacle.shape = algo::Box{random.uniform(0.5, 2), random.uniform(0.4, 0.9)};
      const Vec2 aside(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
      const Vec2 at = piece.obstacle.pose_W.position() + aside;
      gone.obstacle.pose_W = {at.x(), at.y(), random.uniform(-1.5, 1.5)};
      if (clearance(drawing, gone) < 0.2) continue;
      wrong += length_of(gone);
      map.push_back(gone);
    } else if (piece.movable) {  // and this came, or stood elsewhere
      wrong += length_of(piece);
      map.erase(map.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
  return map;
}

}  // namespace server::mapping
