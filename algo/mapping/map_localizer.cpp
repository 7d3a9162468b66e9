// algo/mapping/map_localizer.cpp: filters of the places, and which of them stay.
#include "algo/mapping/map_localizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include <Eigen/LU>

namespace algo {
namespace {

constexpr double kReachOfScan = 20;      // [m]
constexpr std::size_t kLooks = 250'000;  // at points by a search, a call
constexpr int kMostCalls = 100'000;      // of a whole search

// A place found by a search.
constexpr double kFoundDeviation = 0.2;       // [m]
constexpr double kFoundTurnDeviation = 0.05;  // [rad]
constexpr double kWheelDeviation = 0.05;      // of the odometry's scale

// A place that somebody gave.
constexpr double kStartDeviation = 0.1;       // [m]
constexpr double kStartTurnDeviation = 0.03;  // [rad]
constexpr double kGivenDeviation = 0.7;       // [m]
constexpr double kGivenTurnDeviation = 0.15;  // [rad]
constexpr double kFarther = 0.03;             // of score that a metre from the given pose is worth
constexpr double kRidge = 0.75;               // share of the fit that holds between two places

constexpr double kMatchEvery = 0.1;  // [m] of way, a radian counting as a metre
constexpr MatchPrior kPlacePrior{.position = 1, .heading = 2};
constexpr double kLeastMatch = 0.35;    // share of the points
constexpr double kMapError = 0.05;      // [m]
constexpr double kMapTurnError = 0.01;  // [rad]
constexpr double kSurprising = 9;       // squared deviations of a match
constexpr double kOnMapWall = 0.15;     // [m]
constexpr double kFitMemory = 2;        // [m]

constexpr double kLostFit = 0.4;        // a place whose scans fit less is given up
constexpr double kSureFit = 0.7;        // of a place that is believed,
constexpr double kStillFit = 0.55;      // and still believed later
constexpr double kAtOnce = 0.25;        // less fit than the best place has: given up when found
constexpr double kLag = 3;              // [m] of merit behind the best place
constexpr double kSamePlace = 0.5;      // [m]
constexpr double kSameHeading = 0.3;    // [rad]
constexpr double kMostDeviation = 0.5;  // [m] of a robot that is located,
constexpr double kStillDeviation =
    2.5;  // [m] and that still is: along a plain corridor it drives on
constexpr double kMostTurnDeviation = 0.1;  // [rad]
constexpr double kSearchAgain = 1;          // [m] of way after a search in vain,
constexpr int kSearchAgainScans = 400;      // or so many scans
constexpr int kWatchEvery = 10;             // scans
constexpr double kSuddenLoss = 0.25;        // of fit: a poor check
constexpr int kPoorHeld = 3;                // checks in a row: the place is not believed,
constexpr int kPoorLost = 40;               // and given up
constexpr double kAstray = 0.5;             // [m] of way in doubt between two looks about a place
constexpr double kCarriedAway = 1;          // [m] between two odometry poses

double way_of(const Pose2& step) {
  return step.position().norm() + std::abs(step.heading);
}

/// Of x, y and heading.
Vec3 offset(const Pose2& from, const Pose2& to) {
  return {to.x - from.x, to.y - from.y, wrap_angle(to.heading - from.heading)};
}

bool same_place(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm() < kSamePlace &&
         std::abs(wrap_angle(a.heading - b.heading)) < kSameHeading;
}

}  // namespace

PlaceFilter::PlaceFilter(const Pose2& pose_M, double deviation, double turn_deviation)
    : pose_M_(pose_M), covariance_(Matrix5::Zero()) {
  const std::array<double, 5> deviations{
      deviation, deviation, turn_deviation, kWheelDeviation, kWheelDeviation};
  for (Eigen::Index k = 0; k < 5; ++k) {
    const double each = deviations[static_cast<std::size_t>(k)];
    covariance_(k, k) = each * each;
  }
}

void PlaceFilter::follow(const Pose2& step) {
  if (step == Pose2{}) return;
  const Pose2 moved = scaled(step, scale_);
  const Pose2 before = pose_M_;
  pose_M_ = compose(before, moved);
  const Vec2 way = pose_M_.position() - before.position();
  const Vec2 across(-way.y(), way.x());
  Matrix5 carry = Matrix5::Identity();
  carry.block<2, 1>(0, 2) = across;
  carry.block<2, 1>(0, 3) = way;
  carry.block<2, 1>(0, 4) = step.heading / 2 * across;
  carry(2, 4) = step.heading;
  covariance_ = (carry * covariance_ * carry.transpose()).eval();
  covariance_.topLeftCorner<3, 3>() += step_covariance(step);
  way_ += way_of(moved);
}

void PlaceFilter::doubt(const Pose2& other_M) {
  const Vec3 off = offset(pose_M_, other_M);
  covariance_.topLeftCorner<3, 3>() += off * off.transpose();
}

bool PlaceFilter::due() const {
  return !matched_ || way_ >= kMatchEvery;
}

Vec3 PlaceFilter::known_map_errors() {
  return {kMapError, kMapError, kMapTurnError};
}

void PlaceFilter::take(const ScanMatch& match, double fit, const Vec3& map_errors) {
  const double share = matched_ ? std::min(1.0, way_ / kFitMemory) : 1;
  fit_ += share * (fit - fit_);
  merit_ += way_ * fit;
  way_ = 0;
  matched_ = true;
  if (match.share < kLeastMatch) return;
  const Eigen::Matrix3d information = weakened(match_information(match), map_errors);
  const Vec3 off = offset(pose_M_, match.pose_W);
  const auto weight = [&]() -> Eigen::Matrix3d {
    return (Eigen::Matrix3d::Identity() + information * covariance()).inverse() * information;
  };
  // A match farther off than wheels of this noise go: the pose is as unsure as that.
  const double surprise = off.dot(weight() * off) / kSurprising;
  if (surprise > 1) covariance_.topLeftCorner<3, 3>() *= surprise;
  const Eigen::Matrix<double, 5, 3> gain = covariance_.leftCols<3>() * weight();
  const Eigen::Matrix<double, 5, 1> by = gain * off;
  covariance_ -= (gain * covariance_.topRows<3>()).eval();
  covariance_ = ((covariance_ + covariance_.transpose()) / 2).eval();
  pose_M_ = {pose_M_.x + by(0), pose_M_.y + by(1), wrap_angle(pose_M_.heading + by(2))};
  scale_.distance += by(3);
  scale_.turn += by(4);
}

MapLocalizer::MapLocalizer(Submap map) : map_(std::move(map)), search_(map_) {
  filters_.reserve(PlaceSearch::kMostPlaces);
}

void MapLocalizer::restart() {
  forget();
  odometry_W_.reset();
}

void MapLocalizer::start(const Pose2& pose_M) {
  forget();
  filters_.emplace_back(pose_M, kStartDeviation, kStartTurnDeviation);
  begin_places();
  given_ = true;
  wanted_ = false;
}

void MapLocalizer::place(const Pose2& guess_M) {
  forget();
  given_M_ = guess_M;
}

void MapLocalizer::forget() {
  filters_.clear();
  given_M_.reset();
  about_ = false;
  searching_ = false;
  wanted_ = true;
}

void MapLocalizer::take(const LaserScan& scan, const Pose2& odometry_W) {
  const Pose2 step = odometry_W_ ? pose_step(*odometry_W_, odometry_W) : Pose2{};
  odometry_W_ = odometry_W;
  if (step.position().norm() > kCarriedAway) forget();
  for (PlaceFilter& filter : filters_) filter.follow(step);
  if (filters_.empty() && !searching_) {
    idle_ += way_of(step);
    wanted_ = wanted_ || idle_ >= kSearchAgain || ++idle_scans_ >= kSearchAgainScans;
  }
  matcher_.take(scan, kReachOfScan);
  if (wanted_) begin_search(odometry_W);
  if (searching_) {
    if (search_.advance(kLooks)) end_search(odometry_W);
    return;
  }
  match_next();
  watch(way_of(step));
  drop_worse();
  astray_ = located_ ? kAstray : astray_ + way_of(step);
  look_about();
}

void MapLocalizer::take_whole(const LaserScan& scan, const Pose2& odometry_W) {
  take(scan, odometry_W);
  for (int k = 0; k < kMostCalls && fix() == MapFix::Searching; ++k) take(scan, odometry_W);
}

/// A turn of poor wheels may take the pose out of the matcher's reach, and a wall out of the map.
void MapLocalizer::look_about() {
  if (located_ || filters_.size() != 1 || !compared_ || astray_ < kAstray) return;
  astray_ = 0;
  if (fit_at(best().pose_M()) >= kSureFit) return;
  given_M_ = best().pose_M();
  about_ = true;
  wanted_ = true;
}

void MapLocalizer::begin_search(const Pose2& odometry_W) {
  search_odometry_W_ = odometry_W;
  if (given_M_) {
    search_.begin(matcher_.points(), *given_M_, {kGivenWay, kGivenWay, kGivenTurn});
  } else {
    search_.begin_everywhere(matcher_.points());
  }
  searching_ = true;
  wanted_ = false;
}

void MapLocalizer::end_search(const Pose2& odometry_W) {
  searching_ = false;
  idle_ = 0;
  idle_scans_ = 0;
  const Pose2 since = pose_step(search_odometry_W_, odometry_W);
  if (std::exchange(about_, false)) {
    if (!better_found()) {
      given_M_.reset();
      return;
    }
    filters_.clear();
  }
  if (given_M_) {
    take_places_about(*given_M_, since);
  } else {
    take_places(since);
  }
  begin_places();
  given_ = given_M_.has_value();
  wanted_ = filters_.empty() && given_;  // it is elsewhere
  given_M_.reset();
}

void MapLocalizer::begin_places() {
  next_ = 0;
  poor_ = 0;
  compared_ = false;
  believed_ = false;
  located_ = false;
}

/// About a place in doubt.
bool MapLocalizer::better_found() const {
  const auto found = search_.found();
  return !found.empty() && found.front().score >= kSureFit &&
         found.front().score > fit_at(best().pose_M());
}

void MapLocalizer::take_places(const Pose2& since) {
  if (search_.too_many()) return;
  for (const Place& place : search_.found()) {
    filters_.emplace_back(compose(place.pose, since), kFoundDeviation, kFoundTurnDeviation);
  }
}

/// Places along a corridor that all fit are one place, of which the along is not known.
void MapLocalizer::take_places_about(const Pose2& guess_M, const Pose2& since) {
  const auto found = search_.found();
  if (found.empty()) return;
  const auto worth = [&guess_M](const Place& place) {
    return place.score - kFarther * (place.pose.position() - guess_M.position()).norm();
  };
  const auto best = std::ranges::max_element(found, {}, worth);
  const Pose2 best_M = compose(best->pose, since);
  filters_.emplace_back(best_M, kGivenDeviation, kGivenTurnDeviation);
  for (const Place& place : found) {
    const Pose2 place_M = compose(place.pose, since);
    if (&place == &*best || connected(best_M, place_M)) continue;
    filters_.emplace_back(place_M, kGivenDeviation, kGivenTurnDeviation);
  }
}

/// The scan fits all the way from `a_M` to `b_M`.
bool MapLocalizer::connected(const Pose2& a_M, const Pose2& b_M) const {
  const double least = kRidge * std::min(fit_at(a_M), fit_at(b_M));
  return std::ranges::all_of(std::array{0.25, 0.5, 0.75}, [&](double part) {
    return fit_at(interpolated(a_M, b_M, part)) >= least;
  });
}

/// Share of the scan's points that lie on walls.
double MapLocalizer::fit_at(const Pose2& pose_M) const {
  const auto points = matcher_.points();
  std::size_t on = 0;
  for (const Vec2& p_R : points) {
    if (map_.wall_within(to_parent(pose_M, p_R), kOnMapWall)) ++on;
  }
  return points.empty() ? 0 : static_cast<double>(on) / static_cast<double>(points.size());
}

/// Matches one place a call, in turn.
void MapLocalizer::match_next() {
  for (std::size_t k = 0; k < filters_.size(); ++k) {
    PlaceFilter& filter = filters_[(next_ + k) % filters_.size()];
    const double guessed = fit_at(filter.pose_M());
    if (!filter.due() && guessed >= filter.fit() - kSuddenLoss) continue;
    ScanMatch match = matcher_.match(map_, filter.pose_M(), kPlacePrior);
    double fit = fit_at(match.pose_W);
    if (fit < guessed) {  // drawn to a wrong wall
      match = {.pose_W = filter.pose_M()};
      fit = guessed;
    }
    if (fit > guessed + kSuddenLoss) filter.doubt(match.pose_W);
    filter.take(match, fit);
    next_ = (next_ + k + 1) % filters_.size();
    return;
  }
}

/// A robot that stands can be carried off, or people can stand around it: no match is due then.
void MapLocalizer::watch(double way) {
  unwatched_way_ += way;
  if (filters_.size() != 1) return;
  if (++unwatched_ < kWatchEvery && unwatched_way_ < kMatchEvery) return;
  unwatched_ = 0;
  unwatched_way_ = 0;
  const double least = std::max(kLostFit, best().fit() - kSuddenLoss);
  poor_ = fit_at(best().pose_M()) < least ? poor_ + 1 : 0;
  if (poor_ >= kPoorLost) forget();
}

void MapLocalizer::drop_worse() {
  if (filters_.empty()) return;
  const bool fresh = std::ranges::any_of(filters_, [](const auto& f) { return !f.matched(); });
  if (fresh) return;
  double most_fit = 0;
  double most_merit = 0;
  for (const PlaceFilter& filter : filters_) {
    most_fit = std::max(most_fit, filter.fit());
    most_merit = std::max(most_merit, filter.merit());
  }
  const bool first = !compared_;
  const bool nowhere = first && most_fit < kSureFit;
  const std::optional<Pose2> only_M =
      !first && filters_.size() == 1 ? std::optional(best().pose_M()) : std::nullopt;
  std::erase_if(filters_, [&](const PlaceFilter& filter) {
    return nowhere || filter.fit() < kLostFit || filter.merit() < most_merit - kLag ||
           (first && filter.fit() < most_fit - kAtOnce);
  });
  compared_ = true;
  // Two that came to the same place are one.
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    for (std::size_t j = filters_.size(); j-- > i + 1;) {
      if (!same_place(filters_[i].pose_M(), filters_[j].pose_M())) continue;
      if (filters_[j].merit() > filters_[i].merit()) std::swap(filters_[i], filters_[j]);
      filters_.erase(filters_.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
  const auto best = std::ranges::max_element(filters_, {}, &PlaceFilter::merit);
  if (best != filters_.end()) std::swap(*best, filters_.front());
  if (filters_.empty()) {
    given_M_ = only_M;  // it is near, or elsewhere
    wanted_ = given_ || !first;
  } else if (filters_.size() == 1) {
    believed_ = poor_ < kPoorHeld && filters_.front().fit() >= (believed_ ? kStillFit : kSureFit);
    const double most = located_ ? kStillDeviation : kMostDeviation;
    const double turn = std::sqrt(filters_.front().covariance()(2, 2));
    located_ = believed_ && deviation() <= most && turn <= kMostTurnDeviation;
  }
}

/// [m] of the best place's position, in its worst direction.
double MapLocalizer::deviation() const {
  const Eigen::Matrix3d c = best().covariance();
  const double middle = (c(0, 0) + c(1, 1)) / 2;
  const double half = std::hypot((c(0, 0) - c(1, 1)) / 2, c(0, 1));
  return std::sqrt(std::max(0.0, middle + half));
}

MapFix MapLocalizer::fix() const {
  if (searching_ || wanted_) return MapFix::Searching;
  if (filters_.empty()) return search_.too_many() ? MapFix::NotUnique : MapFix::Nowhere;
  const bool fresh = std::ranges::any_of(filters_, [](const auto& f) { return !f.matched(); });
  if (fresh) return MapFix::Searching;
  if (filters_.size() > 1) return MapFix::NotUnique;
  return located_ ? MapFix::Located : MapFix::Unsure;
}

std::string MapLocalizer::sentence() const {
  std::array<char, 120> text{};
  switch (fix()) {
    case MapFix::Searching:
      return "Not located yet: looking for the place on the map.";
    case MapFix::Nowhere:
      return "Not located: the scan fits nowhere on the map.";
    case MapFix::NotUnique:
      if (filters_.empty()) return "Not located: too many places look alike.";
      std::snprintf(text.data(), text.size(), "Not located: %zu places look alike.", places());
      break;
    case MapFix::Unsure:
      std::snprintf(text.data(),
                    text.size(),
                    "Not located: %.0f %% of the scan fits the map, and the place is known to "
                    "%.2f m.",
                    100 * best().fit(),
                    deviation());
      break;
    case MapFix::Located:
      std::snprintf(text.data(), text.size(), "Located within %.2f m.", deviation());
      break;
  }
  return text.data();
}

}  // namespace algo
