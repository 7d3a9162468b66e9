// algo/mapping/scan_odometry.cpp: match, close loops, then enter.
#include "algo/mapping/scan_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace algo {
namespace {

constexpr std::size_t kUsualBeams = 1024;  // reserved from the start
// What the map is off by near the robot: it was drawn by the same wheels not long ago.
constexpr double kOwnMapError = 0.03;       // [m]
constexpr double kOwnMapTurnError = 0.006;  // [rad]
constexpr double kAtStart = 0.01;           // [m] deviation of the place where the map begins
constexpr double kTurnAtStart = 0.01;       // [rad]
constexpr double kGrown = 20;               // [m] of way, after which new ground is old
constexpr double kMayFit = 2.5;             // [m] from an old station: the old map should fit
// A smaller loop is left to the filter, which closes it without a jump.
constexpr double kJump = 0.05;      // [m]
constexpr double kJumpTurn = 0.02;  // [rad]

/// False for ghosts at the edges of things, and for the cells beside a wall that a few of its hits
/// fell into.
bool is_wall(const OccupancyMap& map,
             const OccupancyMap::Index& at,
             const OccupancyMap::Tally& tally) {
  constexpr int kFewest = 3;  // hits
  constexpr int kMore = 4;    // times as many hits of a neighbour: that one is the wall
  if (!tally.occupied() || tally.hits < kFewest) return false;
  for (int j = at.j - 1; j <= at.j + 1; ++j) {
    for (int i = at.i - 1; i <= at.i + 1; ++i) {
      if (map.at({i, j}).hits > kMore * tally.hits) return false;
    }
  }
  return true;
}

}  // namespace

ScanOdometry::ScanOdometry(const MapperSettings& settings)
    : settings_(settings), map_(settings.cell), place_({}, kAtStart, kTurnAtStart) {
  scan_R_.points.reserve(kUsualBeams);
  scan_R_.facings.reserve(kUsualBeams);
}

void ScanOdometry::reset(const Pose2& start_W, const Pose2& odometry) {
  map_ = OccupancyMap(settings_.cell);
  growing_.clear();
  stations_.reset(start_W);
  place_ = PlaceFilter(start_W, kAtStart, kTurnAtStart);
  odometry_ = odometry;
  entered_W_.reset();
}

std::optional<MapMove> ScanOdometry::take(std::span<const Vec2> points_R,
                                          const Vec2& scanner_R,
                                          const Pose2& odometry) {
  place_.follow(pose_step(odometry_, odometry));
  odometry_ = odometry;
  if (entered_W_ && !place_.due()) return std::nullopt;
  keep_near(points_R);
  find_facings(scan_R_.points, scanner_R, scan_R_.facings);
  std::optional<MapMove> moved;
  if (entered_W_) {
    match();
    if (!apart(*entered_W_, place_.pose_M(), settings_)) return std::nullopt;
    moved = go_on((place_.pose_M().position() - entered_W_->position()).norm());
  }
  enter(scanner_R);
  return moved;
}

void ScanOdometry::keep_near(std::span<const Vec2> points_R) {
  scan_R_.points.clear();
  for (const Vec2& p_R : points_R) {
    if (p_R.norm() <= settings_.reach) scan_R_.points.push_back(p_R);
  }
}

void ScanOdometry::match() {
  matcher_.take(scan_R_);
  const OccupancyMap& map = on_known_ground() ? map_ : growing_.front().map;
  const ScanMatch match = matcher_.match(map, place_.pose_M(), settings_.prior);
  place_.take(match, match.share, {kOwnMapError, kOwnMapError, kOwnMapTurnError});
}

/// The robot has driven `way` [m] since the last scan that entered the map.
std::optional<MapMove> ScanOdometry::go_on(double way) {
  if (on_known_ground()) {
    if (stations_.drive(place_.pose_M(), 0, map_)) leave_known_ground();
    return std::nullopt;
  }
  const Pose2& pose_W = place_.pose_M();
  const std::size_t first = growing_.front().first;
  const bool should_fit = stations_.any_near(pose_W.position(), first, kMayFit);
  const std::optional<Pose2> seen_W =
      loop_watch_.see(matcher_, map_, pose_W, way, should_fit, settings_.prior);
  if (seen_W) return come_back(*seen_W);
  stations_.drive(pose_W, first, growing_.front().map);
  grow(way);
  return std::nullopt;
}

void ScanOdometry::leave_known_ground() {
  growing_.push_back({OccupancyMap(settings_.cell), stations_.size() - 1});
  growing_.front().map.trace(map_, place_.pose_M().position(), kGrown / 2);
  loop_watch_.reset();
}

/// A new map begins every half of kGrown, so that a scan always meets a map with some metres in it.
void ScanOdometry::grow(double way) {
  for (Growing& growing : growing_) growing.way += way;
  if (growing_.size() == 1 && growing_.front().way >= kGrown / 2) {
    growing_.push_back({OccupancyMap(settings_.cell), stations_.size() - 1});
  }
  if (growing_.front().way < kGrown) return;
  map_.add(growing_.front().map);
  growing_.erase(growing_.begin());
}

/// By what it sees of the old map, the robot is at `seen_W`.
std::optional<MapMove> ScanOdometry::come_back(const Pose2& seen_W) {
  const Pose2 pose_W = place_.pose_M();
  const Growing& older = growing_.front();
  const Pose2 off = pose_step(pose_W, seen_W);
  const bool jumps = off.position().norm() >= kJump || std::abs(off.heading) >= kJumpTurn;
  const bool tied = stations_.recognise(pose_W, seen_W, older.first, map_);
  if (jumps && !tied) {  // to be matched to the old map, its pose would be too far off
    loop_watch_.reset();
    return std::nullopt;
  }
  std::optional<MapMove> move;
  if (jumps) move = close_loop();
  map_.add(older.map);
  growing_.clear();
  if (move) draw(*move);
  return move;
}

/// All that was seen moves with the stations, and so does the robot.
MapMove ScanOdometry::close_loop() {
  MapMove move{.from_W = place_.pose_M(), .stations = stations_.fit()};
  map_ = map_.moved(move.stations);
  growing_.front().map = growing_.front().map.moved(move.stations);
  const StationMove& here = move.stations[stations_.here()];
  move.to_W = compose(here.to_W, pose_step(here.from_W, move.from_W));
  place_.move(move.to_W);
  return move;
}

/// Writes the map as it is now.
void ScanOdometry::draw(MapMove& move) const {
  std::map<std::pair<int, int>, int> beams;
  map_.each_cell([&](const OccupancyMap::Index& at, const OccupancyMap::Tally& tally) {
    const Vec2 p_W = map_.mean_W(at, tally);
    if (is_wall(map_, at, tally)) move.walls_W.push_back(p_W.cast<float>());
    if (tally.passes == 0) return;
    const int column = whole_below(p_W.x() / DrawnSpace::kCell);
    const int row = whole_below(p_W.y() / DrawnSpace::kCell);
    beams[{row, column}] += tally.passes;
  });
  move.seen.reserve(beams.size());
  for (const auto& [at, count] : beams) {
    const auto most = static_cast<std::uint8_t>(std::min(count, 255));
    move.seen.push_back({.column = at.second, .row = at.first, .beams = most});
  }
}

void ScanOdometry::enter(const Vec2& scanner_R) {
  const Pose2& pose_W = place_.pose_M();
  const Vec2 from_W = to_parent(pose_W, scanner_R);
  const auto enter_into = [&](OccupancyMap& map) {
    map.set_station(stations_.here());
    for (std::size_t i = 0; i < scan_R_.points.size(); ++i) {
      map.insert(
          from_W, to_parent(pose_W, scan_R_.points[i]), scan_R_.facings[i].turned(pose_W.heading));
    }
  };
  if (on_known_ground()) enter_into(map_);
  for (Growing& growing : growing_) enter_into(growing.map);
  entered_W_ = pose_W;
}

}  // namespace algo
