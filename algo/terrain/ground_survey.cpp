// algo/terrain/ground_survey.cpp: what all states of the survey share: where the sides are, what
// they see, and the verdict.
#include "algo/terrain/ground_survey.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "algo/terrain/ground_value.hpp"

namespace algo {
namespace {

constexpr double kTrialWay = 0.001;    // [m] between two trials: a robot at rest gives one
constexpr double kTrenchMore = 0.005;  // [m] past the limit, a trench is too wide
/// [m] The median and the threshold show an edge so late.
constexpr double kSeenLate = 0.01;
constexpr double kFolds = 0.12;     // [m] ahead of the sensors, a surface may read as nothing
constexpr double kPitchWay = 0.3;   // [m] of way, the mean of the pitch forgets by the factor e
constexpr double kPitched = 0.005;  // [rad] from it
/// [m] The near beam of a robot whose casters stand on an unseen step of 4 mm is so far off the
/// floor, at most. A step that is so far off would be 6 mm high.
constexpr double kTiltedOff = 0.008;
/// [m] A refused edge goes on to either side of the robot: nothing looked there.
constexpr double kBeside = 0.05;

}  // namespace

GroundSurvey::GroundSurvey(const RobotSpec& spec)
    : spec_(spec),
      sensors_(*spec.floor),
      reader_(*spec.floor),
      foot_(spec.floor->x + spec.floor->height / std::tan(spec.floor->angle)),
      limits_(spec.climbs.value_or(ClimbLimits{})) {
  left_ = {.y = sensors_.half_spacing, .trials = {sensors_, reader_.flat()}};
  right_ = {.y = -sensors_.half_spacing, .trials = {sensors_, reader_.flat()}};
  reset();
}

void GroundSurvey::reset() {
  reader_.reset();
  left_.look = reader_.left();
  right_.look = reader_.right();
  for (Side* side : {&left_, &right_}) {
    side->off = 0;
    side->level = 0;
  }
  forget_edge();
  state_ = SurveyState::Watch;
  driver_ = SurveyDriver::Nobody;
  last_W_.reset();
  stood_at_.reset();
  way_ = 0;
  creep_to_ = 0;
  finding_ = {};
  can_pass_ = true;
  to_left_ = true;
  refused_.reset();
}

void GroundSurvey::forget_edge() {
  for (Side* side : {&left_, &right_}) {
    side->seen = false;
    side->tried = false;
    side->past = 0;
    side->trials.restart();
    side->far_sum = side->near_sum = 0;
    side->far_count = side->near_count = 0;
  }
  edge_W_.reset();
  pitch_sum_ = 0;
  pitches_ = 0;
}

Vec2 GroundSurvey::foot_W(const Side& side) const {
  return to_parent(pose_W_, {foot_, side.y});
}

/// Follows the robot: the way of its axle, and of the foot of each beam past the edge.
void GroundSurvey::move(const SurveyInput& in) {
  pose_W_ = in.pose_W;
  if (!last_W_) last_W_ = in.pose_W;
  const Vec2 ahead = direction(in.pose_W.heading);
  const auto step = [&](const Vec2& point_R) {
    return (to_parent(in.pose_W, point_R) - to_parent(*last_W_, point_R)).dot(ahead);
  };
  const double ahead_by = step({spec_.axle, 0});
  way_ += ahead_by;
  pitch_ = in.pitch;
  if (!stood_at_ || state_ == SurveyState::Cross) stood_at_ = in.pitch;
  *stood_at_ += (1 - std::exp(-std::abs(ahead_by) / kPitchWay)) * (in.pitch - *stood_at_);
  for (Side* side : {&left_, &right_}) side->past += step({foot_, side->y});
  last_W_ = in.pose_W;
}

/// True if a small difference to the floor may come from the robot's own pitch (ours). On a step
/// too low to be seen, its nose is up by a degree until the drive wheels are on it too, and the
/// floor ahead looks like a trench.
bool GroundSurvey::wavers(const GroundLook& look) const {
  const bool looks_on = state_ == SurveyState::Watch || state_ == SurveyState::OneSide;
  return looks_on && std::abs(pitch_ - *stood_at_) > kPitched &&
         std::abs(look.near - reader_.flat().near) <= kTiltedOff;
}

void GroundSurvey::read(const SurveyInput& in) {
  fresh_ = in.ranges != nullptr;
  if (!fresh_) return;
  reader_.take(*in.ranges);
  // A beam that ends on an obstacle tells nothing of the ground; the controller keeps away from it.
  // It is shorter than one that ends on the floor, or folded: a drop before a wall is still seen.
  const auto look_at = [this](const GroundLook& look, double obstacle) {
    constexpr GroundThresholds kLimits;
    const FlatRanges& flat = reader_.flat();
    const bool folded = obstacle < sensors_.x + kFolds;
    const auto explained = [&](double range, double level) {
      return range < level || (folded && std::isnan(range));
    };
    const bool masked = std::isfinite(obstacle) && explained(look.far, flat.far + kLimits.far) &&
                        explained(look.near, flat.near + kLimits.near);
    return masked ? GroundLook{.far = flat.far, .near = flat.near} : look;
  };
  left_.look = look_at(reader_.left(), in.obstacle_left);
  right_.look = look_at(reader_.right(), in.obstacle_right);
  for (Side* side : {&left_, &right_}) {
    const bool off = side->look.near_off && !wavers(side->look);
    side->off = off ? side->off + 1 : 0;
    side->level = off ? 0 : side->level + 1;
  }
}

void GroundSurvey::see(Side& side) {
  if (side.seen || side.off < 2) return;
  side.seen = true;
  side.seen_W = foot_W(side);
  side.past = 0;
}

/// One trial of a side, from the first look that is neither flat nor pending.
void GroundSurvey::try_side(Side& side) {
  const GroundClass kind = side.look.kind;
  if (!side.tried && (kind == GroundClass::Flat || kind == GroundClass::Pending)) return;
  if (!side.tried) {
    side.tried = true;
    side.seen = true;
    side.seen_W = foot_W(side);
    side.past = 0;
  }
  side.trials.add(side.look, way_, limits_.trench + kTrenchMore);
}

void GroundSurvey::enter(SurveyState state, const SurveyInput& in) {
  state_ = state;
  entered_ = in.stamp;
  from_way_ = way_;
  from_heading_ = in.pose_W.heading;
  levelled_ = 0;
}

/// The edge as seen, moved back by what the median hid. A side that has not met it yet counts where
/// its beam is now.
void GroundSurvey::note_edge() {
  const Vec2 back = -kSeenLate * direction(pose_W_.heading);
  const auto end = [&](const Side& side) -> Vec2 {
    return side.seen ? Vec2(side.seen_W + back) : foot_W(side);
  };
  edge_W_ = {end(left_), end(right_)};
}

/// The finding of one side. A slope down has the angle measured at rest.
GroundFinding GroundSurvey::found(const Side& side) const {
  GroundFinding out = side.trials.finding();
  if (out.kind != GroundClass::SlopeDown || state_ != SurveyState::Measure) return out;
  const double far = side.far_sum / side.far_count;  // NaN of none: not passable
  const double near = side.near_sum / side.near_count;
  out.slope = ground_slope(far, near, sensors_.separation, sensors_.angle);
  return out;
}

/// Fig. 8: the findings of both sides against the robot's limits. One that cannot be passed counts
/// before one that can.
void GroundSurvey::decide(const SurveyInput& in, const Parameters& p) {
  const GroundFinding left = found(left_);
  const GroundFinding right = found(right_);
  const double pitch = pitches_ > 0 ? pitch_sum_ / pitches_ : 0;
  const bool left_can = passable(left, limits_, pitch, p);
  const bool right_can = passable(right, limits_, pitch, p);
  can_pass_ = left_can && right_can;
  finding_ = left_can == right_can ? worse(left, right) : left_can ? right : left;
  note_edge();
  if (finding_.kind == GroundClass::Flat || finding_.kind == GroundClass::Pending) {
    forget_edge();
    return enter(SurveyState::Watch, in);
  }
  if (!can_pass_) return refuse(in);
  enter(SurveyState::Cross, in);
}

/// Keeps the edge as an obstacle as wide as the robot, and a little more.
void GroundSurvey::refuse(const SurveyInput& in) {
  can_pass_ = false;
  note_edge();
  const auto& [left, right] = *edge_W_;
  const Vec2 along = (left - right).normalized();
  const double half = (left - right).norm() / 2;
  const double wanted = std::max(spec_.half_width, spec_.half_track) + kBeside;
  const Vec2 more = std::max(kBeside, wanted - half) * along;
  refused_.add(left + more, right - more, in.stamp);
  enter(driver_ == SurveyDriver::Goal ? SurveyState::BackOff : SurveyState::Refused, in);
}

/// True until the robot has backed off the refused edge, or turned from it.
bool GroundSurvey::still_ahead() const {
  if (!edge_W_) return false;
  constexpr double kTurned = 1.0;  // [rad]
  if (std::abs(wrap_angle(pose_W_.heading - from_heading_)) > kTurned) return false;
  const double nearest =
      std::min(to_child(pose_W_, (*edge_W_)[0]).x(), to_child(pose_W_, (*edge_W_)[1]).x());
  return nearest < foot_ + kSeenLate;
}

SurveyAnswer GroundSurvey::step(const SurveyInput& in, const Parameters& p) {
  move(in);
  read(in);
  refused_.forget(in.stamp, p[kGroundMemory]);
  if (in.driver != driver_) {
    driver_ = in.driver;
    // A maneuver of the robot's own ends with the goal, or when a driver takes the stick.
    const bool goes_on = state_ == SurveyState::Cross || state_ == SurveyState::Refused;
    if (!goes_on && state_ != SurveyState::Watch) {
      const bool refuses = state_ == SurveyState::BackOff || state_ == SurveyState::TurnAway;
      if (!refuses) forget_edge();
      enter(refuses ? SurveyState::Refused : SurveyState::Watch, in);
    }
  }
  switch (state_) {
    case SurveyState::Watch:
      return watch(in, p);
    case SurveyState::OneSide:
      return one_side(in, p);
    case SurveyState::Align:
      return align(in, p);
    case SurveyState::Approach:
      return approach(in, p);
    case SurveyState::Trials:
      return trials(in, p);
    case SurveyState::Measure:
      return measure(in, p);
    case SurveyState::Cross:
      return cross(in, p);
    case SurveyState::BackOff:
      return back_off(in, p);
    case SurveyState::TurnAway:
      return turn_away(in, p);
    case SurveyState::Refused:
      return refused(in, p);
  }
  return {};
}

/// Twenty trials a side while the beams creep over the edge. A side that sees flat floor all along
/// is flat.
SurveyAnswer GroundSurvey::trials(const SurveyInput& in, const Parameters& p) {
  constexpr double kLongest = 0.08;  // [m] of way
  constexpr double kBacked = -0.01;  // [m] a driver by hand gave it up
  const double way = way_ - from_way_;
  if (fresh_ && std::abs(way_ - tried_at_) >= kTrialWay) {
    tried_at_ = way_;
    try_side(left_);
    try_side(right_);
    pitch_sum_ += in.pitch;
    ++pitches_;
  }
  const bool done = (left_.trials.done() || !left_.tried) &&
                    (right_.trials.done() || !right_.tried) && (left_.tried || right_.tried);
  if (way < kBacked) {
    forget_edge();
    enter(SurveyState::Watch, in);
  } else if (done || way > kLongest) {
    const auto down = [](const Side& side) {
      return side.trials.finding().kind == GroundClass::SlopeDown;
    };
    if (down(left_) || down(right_)) {
      enter(SurveyState::Measure, in);
    } else {
      decide(in, p);
    }
  }
  return {.twist = driver_ == SurveyDriver::Goal ? std::optional(Twist2{p[kGroundCreep], 0})
                                                 : std::nullopt,
          .v_max = p[kGroundCreep],
          .why = "The ground ahead is not level: the robot looks at it, slowly."};
}

}  // namespace algo
