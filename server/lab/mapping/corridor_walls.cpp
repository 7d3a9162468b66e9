// server/lab/mapping/corridor_walls.cpp: doors and rooms at random places along a wall.
#include "server/lab/mapping/corridor_walls.hpp"

#include <algorithm>
#include <cmath>

namespace server::mapping {

using algo::Pose2;
using algo::Vec2;

void CorridorWalls::side(const Vec2& a, const Vec2& b) {
  const double length = (b - a).norm();
  const Pose2 along_W{a.x(), a.y(), std::atan2((b - a).y(), (b - a).x())};
  double at = 0;
  while (true) {
    const double next = at + random_.uniform(1.5, 7);
    const double door = random_.uniform(0.8, 1.3);
    if (next + door + 0.3 > length) break;
    wall(along_W, {at, 0}, {next, 0});
    if (random_.uniform() < 0.75) {
      closed_door(along_W, next, door);
    } else {
      open_room(along_W, next, door, length);
    }
    at = next + door;
  }
  wall(along_W, {at, 0}, {length, 0});
}

void CorridorWalls::closed_door(const Pose2& along_W, double at, double width) {
  const double deep = -random_.uniform(0.1, 0.35);
  wall(along_W, {at, 0}, {at, deep});
  wall(along_W, {at, deep}, {at + width, deep}, true);
  wall(along_W, {at + width, deep}, {at + width, 0});
}

void CorridorWalls::open_room(const Pose2& along_W, double at, double width, double length) {
  const double middle = at + width / 2;
  const double half = std::min({random_.uniform(1.5, 3), middle, length - middle});
  const double deep = -random_.uniform(3, 7);
  constexpr double kFront = -0.15;  // [m] the room's side of the corridor's wall
  wall(along_W, {middle - half, kFront}, {at, kFront});
  wall(along_W, {at + width, kFront}, {middle + half, kFront});
  wall(along_W, {middle - half, kFront}, {middle - half, deep});
  wall(along_W, {middle + half, kFront}, {middle + half, deep});
  wall(along_W, {middle - half, deep}, {middle + half, deep});
  const Vec2 cupboard(middle + random_.uniform(-1, 1), -random_.uniform(1.5, 2.7));
  const double edge = random_.uniform(0.3, 0.8);
  furniture(algo::compose(along_W, {cupboard.x(), cupboard.y(), 0}), edge, edge);
}

void CorridorWalls::furniture(const Pose2& pose_W, double length, double width) {
  add(pose_W, algo::Box{length, width}, true);
}

void CorridorWalls::wall(const Pose2& along_W, const Vec2& from, const Vec2& to, bool movable) {
  constexpr double kWallThickness = 0.1;  // [m]
  const Vec2 way = to - from;
  const Vec2 middle = (from + to) / 2;
  const Pose2 at{middle.x(), middle.y(), std::atan2(way.y(), way.x())};
  add(algo::compose(along_W, at), algo::Wall{way.norm(), kWallThickness}, movable);
}

void CorridorWalls::append(const CorridorWalls& other) {
  for (const Piece& piece : other.pieces_) {
    add(piece.obstacle.pose_W, piece.obstacle.shape, piece.movable);
  }
}

void CorridorWalls::add(const Pose2& pose_W, const algo::Shape& shape, bool movable) {
  const auto id = static_cast<std::uint32_t>(pieces_.size() + 1);
  pieces_.push_back({{.id = id, .pose_W = pose_W, .shape = shape}, movable});
}

}  // namespace server::mapping
