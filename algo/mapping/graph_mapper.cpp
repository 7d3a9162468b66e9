// algo/mapping/graph_mapper.cpp: the front end, and the graph of all key scans.
#include "algo/mapping/graph_mapper.hpp"

#include <cmath>
#include <utility>

#include "algo/mapping/path_fit.hpp"
#include "algo/mapping/path_polish.hpp"

namespace algo {
namespace {

constexpr double kTurnWay = 1;    // [m per rad] of a submap's way
constexpr double kStepDoubt = 5;  // a match with false walls

}  // namespace

Pose2 GraphMapper::add(const LaserScan& scan, const Pose2& odometry_W) {
  if (odometry_W_) {
    follow(scan, pose_step(*odometry_W_, odometry_W));
  } else {
    graph_.add(odometry_W);
    keys_.first.push_back(0);
    growing_.push_back({.node = 0, .map = OccupancyMap(settings_.cell)});
    enter(scan);
  }
  odometry_W_ = odometry_W;
  placed_.push_back({keys_.scans.size() - 1, pose_step(key_pose_, growing_.front().pose)});
  return compose(graph_.pose(growing_.front().node), growing_.front().pose);
}

void GraphMapper::follow(const LaserScan& scan, const Pose2& step) {
  since_key_.add(step);
  since_submap_.add(step);
  const Pose2 before = growing_.front().pose;
  growing_.front().pose = compose(before, scaled(step, graph_.scale()));
  match(scan);
  const Pose2 moved = pose_step(before, growing_.front().pose);
  if (growing_.size() > 1) growing_[1].pose = compose(growing_[1].pose, moved);
  for (Growing& submap : growing_) {
    submap.way += step.position().norm() + kTurnWay * std::abs(step.heading);
  }
  if (apart(key_pose_, growing_.front().pose, settings_)) enter(scan);
}

void GraphMapper::match(const LaserScan& scan) {
  const Growing& submap = growing_.front();
  const Pose2 guess = submap.pose;
  matcher_.take(scan, settings_.reach);
  match_ = matcher_.match(submap.map, guess, settings_.prior);
  if (match_.share < settings_.lost) {
    const ScanMatch again =
        matcher_.match(submap.map, matcher_.search(submap.map, guess), settings_.prior);
    if (again.share > match_.share) match_ = again;
  }
  growing_.front().pose = match_.pose_W;
}

void GraphMapper::enter(const LaserScan& scan) {
  KeyScan key{.scan = placed_.size(),
              .submap = growing_.front().node,
              .pose = growing_.front().pose,
              .step = since_key_.step()};
  if (match_.share >= settings_.lost) key.information = match_information(match_);
  keys_.scans.push_back(key);
  since_key_ = {};
  if (growing_.size() == 1 && growing_.front().way >= settings_.submap / 2) start_submap();
  for (Growing& submap : growing_) {
    submap.map.insert(scan, compose(submap.pose, scan.mount_R), settings_.reach);
  }
  if (growing_.front().way >= settings_.submap) finish_submap();
  key_pose_ = growing_.front().pose;
}

void GraphMapper::start_submap() {
  const KeyScan& key = keys_.scans.back();
  const std::size_t node = graph_.add(compose(graph_.pose(key.submap), key.pose));
  graph_.add({.from = key.submap,
              .to = node,
              .step = key.pose,
              .information = key.information,
              .doubt = kStepDoubt});
  graph_.add(since_submap_.edge(key.submap, node));
  since_submap_ = {};
  keys_.first.push_back(keys_.scans.size() - 1);
  growing_.push_back({.node = node, .map = OccupancyMap(settings_.cell)});
}

void GraphMapper::finish_submap() {
  Growing done = std::move(growing_.front());
  growing_.erase(growing_.begin());
  closer_.take(done.node, Submap(done.map), graph_);
}

std::vector<Pose2> GraphMapper::finish(std::span<const LaserScan> scans) {
  while (!growing_.empty()) finish_submap();
  const std::vector<Pose2> keys_W = fit_path(keys_, graph_, closer_, scans, settings_.reach);
  std::vector<Pose2> path_W;
  path_W.reserve(placed_.size());
  for (const Placed& placed : placed_) {
    path_W.push_back(compose(keys_W[placed.key], placed.step));
  }
  return polish_path(path_W, scans, settings_);
}

std::size_t GraphMapper::bytes() const {
  std::size_t sum = keys_.scans.size() * sizeof(KeyScan) + placed_.size() * sizeof(Placed) +
                    graph_.edges().size() * sizeof(GraphEdge);
  for (const Submap& submap : closer_.submaps()) sum += submap.bytes();
  for (const Growing& submap : growing_) sum += submap.map.bytes();
  return sum;
}

}  // namespace algo
