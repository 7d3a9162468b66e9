// server/lab/buildings/map_trueness.cpp: lays pieces of a map on the true walls.
#include "server/lab/buildings/map_trueness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace server::buildings {
namespace {

using algo::BuildingMemory;
using algo::LocalMap;
using algo::Pose2;
using algo::Vec2;

struct FitStep {
  double way = 0;   // [m]
  double turn = 0;  // [rad]
};
constexpr std::array<FitStep, 5> kFitSteps{
    {{0.3, 0.05}, {0.15, 0.02}, {0.08, 0.01}, {0.04, 0.005}, {0.02, 0.002}}};
constexpr int kRoundsPerStep = 8;

/// A piece of the map about its own middle.
struct Piece {
  Vec2 middle_W{0, 0};
  std::vector<Vec2> points{};  // [m] from the middle
};

/// [m] Mean distance to the nearest true surface, of which each point has at most kApart.
double misfit(const Piece& piece, const Pose2& pose, const GridOracle& truth) {
  double sum = 0;
  for (const Vec2& p : piece.points) {
    sum += std::clamp(truth.distance(to_parent(pose, p)), 0.0, kApart);
  }
  return sum / static_cast<double>(piece.points.size());
}

/// Searches downhill from `pose`, in ever smaller steps.
Pose2 laid(const Piece& piece, Pose2 pose, const GridOracle& truth) {
  double least = misfit(piece, pose, truth);
  for (const FitStep& step : kFitSteps) {
    for (int round = 0; round < kRoundsPerStep; ++round) {
      const double before = least;
      for (const Pose2& by : {Pose2{step.way, 0, 0},
                              Pose2{-step.way, 0, 0},
                              Pose2{0, step.way, 0},
                              Pose2{0, -step.way, 0},
                              Pose2{0, 0, step.turn},
                              Pose2{0, 0, -step.turn}}) {
        const Pose2 other{
            pose.x + by.x, pose.y + by.y, algo::wrap_angle(pose.heading + by.heading)};
        const double off = misfit(piece, other, truth);
        if (off >= least) continue;
        least = off;
        pose = other;
      }
      if (least >= before) break;
    }
  }
  return pose;
}

}  // namespace

std::vector<Vec2> remembered_walls(const algo::StripSenses& senses) {
  constexpr double kWindow = LocalMap::kSize * LocalMap::kCell;
  constexpr int kSide = BuildingMemory::kFineSide;
  const LocalMap& map = senses.map();
  const Vec2& corner_W = map.corner_W();
  std::vector<Vec2> walls_W;
  map.each_near(corner_W + Vec2(kWindow, kWindow) / 2, kWindow / 2, [&](const Vec2& p_W) {
    walls_W.push_back(p_W);
  });
  const BuildingMemory& memory = senses.memory();
  const auto add_tile = [&](const BuildingMemory::Tile& tile, const Vec2& at_W) {
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        if ((tile.occupied[static_cast<std::size_t>(row)] >> column & 1U) == 0) continue;
        walls_W.emplace_back(at_W + LocalMap::kCell * Vec2(column + 0.5, row + 0.5));
      }
    }
  };
  const BuildingMemory::Cell low = memory.low();
  const BuildingMemory::Cell high = memory.high();
  for (int row = BuildingMemory::tile_of(low.row); row <= BuildingMemory::tile_of(high.row);
       ++row) {
    for (int column = BuildingMemory::tile_of(low.column);
         column <= BuildingMemory::tile_of(high.column);
         ++column) {
      const Vec2 at_W = BuildingMemory::kTileEdge * Vec2(column, row);
      const Vec2 in_window = at_W - corner_W + Vec2(0.5, 0.5) * BuildingMemory::kTileEdge;
      const bool inside = in_window.minCoeff() > 0 && in_window.maxCoeff() < kWindow;
      const BuildingMemory::Tile* const tile = memory.find(column, row);
      if (!inside && tile != nullptr) add_tile(*tile, at_W);
    }
  }
  return walls_W;
}

MapPieces::Place MapPieces::place_of(const Vec2& p_W) {
  return {algo::whole_below(p_W.x() / kPiece), algo::whole_below(p_W.y() / kPiece)};
}

void MapPieces::visit(const Pose2& believed_W, const Pose2& true_W) {
  poses_[place_of(believed_W.position())] = compose(true_W, pose_step(believed_W, {}));
}

Pose2 MapPieces::pose_at(const Vec2& p_W) const {
  const Place wanted = place_of(p_W);
  Pose2 nearest{};
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [place, pose] : poses_) {
    const double far = std::hypot(place.first - wanted.first, place.second - wanted.second);
    if (far >= least) continue;
    least = far;
    nearest = pose;
  }
  return nearest;
}

double doubled_share(const std::vector<Vec2>& walls_W,
                     const MapPieces& pieces,
                     const GridOracle& truth) {
  std::map<MapPieces::Place, Piece> parts;
  for (const Vec2& p_W : walls_W) {
    const MapPieces::Place place = MapPieces::place_of(p_W);
    Piece& piece = parts[place];
    piece.middle_W = MapPieces::kPiece * Vec2(place.first + 0.5, place.second + 0.5);
    piece.points.emplace_back(p_W - piece.middle_W);
  }
  std::size_t off = 0;
  for (const auto& [place, piece] : parts) {
    const Pose2 middle{piece.middle_W.x(), piece.middle_W.y(), 0};
    const Pose2 pose = laid(piece, compose(pieces.pose_at(piece.middle_W), middle), truth);
    off += static_cast<std::size_t>(std::ranges::count_if(
        piece.points, [&](const Vec2& p) { return truth.distance(to_parent(pose, p)) > kApart; }));
  }
  return static_cast<double>(off) / static_cast<double>(walls_W.size());
}

}  // namespace server::buildings
