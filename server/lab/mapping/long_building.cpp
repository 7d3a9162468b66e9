// server/lab/mapping/long_building.cpp: the building, the drive, and what is written of them.
#include "server/lab/mapping/long_building.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "server/lab/mapping/corridor_walls.hpp"
#include "server/run/text_file.hpp"
#include "sim/drive_errors.hpp"
#include "sim/random.hpp"
#include "sim/range_caster.hpp"

namespace server::mapping {
namespace {

using algo::Pose2;
using algo::Vec2;

constexpr double kLength = 298;        // [m] between the outer corridors' middles
constexpr double kCross = 200;         // [m] at which a corridor joins the long ones
constexpr double kDepth = 50;          // [m] between the long corridors
constexpr double kHalfCorridor = 1.2;  // [m]
constexpr double kStep = 0.15;         // [m] between two scans
constexpr double kTurnStep = 0.1;      // [rad] likewise, turning on the spot
constexpr double kPeriod = 0.2;        // [s] likewise
constexpr double kSway = 0.2;          // [m] to both sides of the corridor's middle
constexpr double kSwayRate = 0.3;      // [rad/m]
constexpr double kBuildingRange = 30;  // [m]
constexpr double kRangeNoise = 0.01;   // [m]
constexpr double kNothing = 81.91;     // [m] as an LMS writes "no echo"
constexpr sim::BeamPattern kBeams{-std::numbers::pi / 2, std::numbers::pi / 180, 181};
constexpr std::size_t kNextRelation = 7;  // scans, about a metre
constexpr std::size_t kLoopStride = 20;   // scans between the poses that close loops
constexpr std::size_t kLoopAge = 700;     // scans between the two poses of a loop
constexpr double kSamePlace = 2;          // [m]

void put_up(CorridorWalls& walls) {
  constexpr double w = kHalfCorridor;
  walls.side({-w, -w}, {kLength + w, -w});
  walls.side({kLength + w, -w}, {kLength + w, kDepth + w});
  walls.side({kLength + w, kDepth + w}, {-w, kDepth + w});
  walls.side({-w, kDepth + w}, {-w, -w});
  constexpr std::array<std::array<double, 2>, 2> kBlocks{{{0, kCross}, {kCross, kLength}}};
  for (const auto& [left, right] : kBlocks) {
    walls.side({left + w, kDepth - w}, {right - w, kDepth - w});
    walls.side({right - w, kDepth - w}, {right - w, w});
    walls.side({right - w, w}, {left + w, w});
    walls.side({left + w, w}, {left + w, kDepth - w});
  }
}

/// Straight from corner to corner, swaying a little, with turns on the spot.
std::vector<Pose2> drive() {
  const std::vector<Vec2> corners_W{{20, 0},
                                    {kCross, 0},
                                    {kCross, kDepth},
                                    {0, kDepth},
                                    {0, 0},
                                    {kCross, 0},
                                    {kLength, 0},
                                    {kLength, kDepth},
                                    {kCross, kDepth},
                                    {kCross, 0},
                                    {0, 0},
                                    {0, kDepth},
                                    {kLength, kDepth},
                                    {kLength, 0},
                                    {20, 0}};
  std::vector<Pose2> path_W{{20, 0, 0}};
  for (std::size_t k = 1; k < corners_W.size(); ++k) {
    const Vec2 way = corners_W[k] - corners_W[k - 1];
    const double heading = std::atan2(way.y(), way.x());
    const Pose2 before = path_W.back();
    const double turn = algo::wrap_angle(heading - before.heading);
    const int turns = static_cast<int>(std::ceil(std::abs(turn) / kTurnStep));
    for (int i = 1; i <= turns; ++i) {
      path_W.push_back({before.x, before.y, algo::wrap_angle(before.heading + turn * i / turns)});
    }
    const Pose2 start_W{corners_W[k - 1].x(), corners_W[k - 1].y(), heading};
    const int steps = static_cast<int>(way.norm() / kStep);
    for (int i = 1; i <= steps; ++i) {
      const double at = way.norm() * i / steps;
      const double calm = std::min(1.0, std::min(at, way.norm() - at) / 2);
      const double slope = kSway * kSwayRate * calm * std::cos(kSwayRate * at);
      path_W.push_back(
          algo::compose(start_W, {at, kSway * calm * std::sin(kSwayRate * at), std::atan(slope)}));
    }
  }
  return path_W;
}

std::string relation(const std::vector<Pose2>& path_W, std::size_t i, std::size_t j) {
  const Pose2 step = algo::pose_step(path_W[i], path_W[j]);
  return fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} 0 0 0 {:.6f}\n",
                     kPeriod * static_cast<double>(i + 1),
                     kPeriod * static_cast<double>(j + 1),
                     step.x,
                     step.y,
                     step.heading);
}

std::string relations_of(const std::vector<Pose2>& path_W) {
  std::string out;
  for (std::size_t i = 0; i + kNextRelation < path_W.size(); i += kNextRelation) {
    out += relation(path_W, i, i + kNextRelation);
  }
  for (std::size_t i = 0; i < path_W.size(); i += kLoopStride) {
    for (std::size_t j = i + kLoopAge; j < path_W.size(); j += kLoopStride) {
      const double apart = (path_W[i].position() - path_W[j].position()).norm();
      if (apart < kSamePlace) out += relation(path_W, i, j);
    }
  }
  return out;
}

}  // namespace

void write_long_building(const std::filesystem::path& file,
                         std::uint64_t seed,
                         const sim::DriveConfig& errors) {
  if (const auto problem = sim::defect(errors)) throw std::invalid_argument(*problem);
  const std::filesystem::path relations =
      std::filesystem::path(file).replace_extension(".relations");
  if (relations == file) {
    throw std::invalid_argument(
        file.string() + ": is the name of the log's relations; end that of the log in .log");
  }
  CorridorWalls walls(seed);
  put_up(walls);
  sim::RangeCaster caster;
  for (const Piece& piece : walls.pieces()) caster.add(piece.obstacle);
  const std::vector<Pose2> path_W = drive();
  const std::vector<Pose2> odometry_W = sim::reported_path(path_W, errors, seed);
  sim::Random noise(seed, 0x5ca9);
  std::vector<double> ranges(kBeams.beams);
  std::vector<double> draws(kBeams.beams);
  std::string log = "# A simulated drive; the poses are the odometry's.\n";
  for (std::size_t i = 0; i < path_W.size(); ++i) {
    caster.cast(path_W[i], kBeams, kBuildingRange, ranges);
    noise.fill_normal(draws);
    log += fmt::format("FLASER {}", kBeams.beams);
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      const bool seen = ranges[k] < kBuildingRange;
      log += fmt::format(" {:.2f}",
                         seen ? std::max(0.0, ranges[k] + kRangeNoise * draws[k]) : kNothing);
    }
    const Pose2& pose = odometry_W[i];
    const std::string place = fmt::format("{:.6f} {:.6f} {:.6f}", pose.x, pose.y, pose.heading);
    const double stamp = kPeriod * static_cast<double>(i + 1);
    log += fmt::format(" {} {} {:.6f} simulated {:.6f}\n", place, place, stamp, stamp);
  }
  write_text(file, log);
  write_text(relations, relations_of(path_W));
}

}  // namespace server::mapping
