// server/lab/mapping/corridor_walls.hpp: draws the walls of buildings with corridors.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/obstacle.hpp"
#include "sim/random.hpp"

namespace server::mapping {

/// The kind of a piece of a building. Doors and furniture may stand elsewhere on another day.
struct Piece {
  algo::Obstacle obstacle{};
  bool movable = false;
};

/// Puts up walls, doors and rooms along corridors. The same seed draws the same ones.
class CorridorWalls {
 public:
  explicit CorridorWalls(std::uint64_t seed) : random_(seed, 0xb17d) {}

  /// A side of a corridor from `a` to `b`, with the corridor to its left: doors, and open rooms.
  void side(const algo::Vec2& a, const algo::Vec2& b);
  void wall(const algo::Vec2& a, const algo::Vec2& b) { wall({}, a, b); }
  void furniture(const algo::Pose2& pose_W, double length, double width);

  /// Adds all pieces of another drawing.
  void append(const CorridorWalls& other);

  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  void closed_door(const algo::Pose2& along_W, double at, double width);
  void open_room(const algo::Pose2& along_W, double at, double width, double length);
  void wall(const algo::Pose2& along_W,
            const algo::Vec2& from,
            const algo::Vec2& to,
            bool movable = false);
  void add(const algo::Pose2& pose_W, const algo::Shape& shape, bool movable);

  sim::Random random_;
  std::vector<Piece> pieces_{};
};

}  // namespace server::mapping
