// algo/terrain/survey_states.cpp: what the survey does in each of its states.
#include <algorithm>
#include <cmath>

#include "algo/terrain/ground_survey.hpp"

namespace algo {
namespace {

constexpr int kSettled = 10;           // readings on flat floor: aligned, or clear of an edge
constexpr double kAlignTime = 10;      // [s] at most
constexpr int kSlopeReadings = 200;    // of each sensor, at rest
constexpr double kApproachWay = 0.15;  // [m] back to the edge, at most
constexpr double kClear = 0.05;        // [m] past the edge, behind the drive wheels
constexpr double kTurnAway = 0.8;      // [rad] from a refused edge
constexpr double kTurned = 0.05;       // [rad]
constexpr double kKnown = 0.06;  // [m] past the foot of a beam, an edge is still the one it met
constexpr double kBesideBeam = 0.03;  // [m]
constexpr double kBefore = 0.04;      // [m] the hull keeps from a refused edge,
constexpr double kBesideHull = 0.02;  // [m] also beside it
constexpr double kCreepOn = 0.15;     // [m] after the far beam left the floor
constexpr double kParallel = 0.007;   // [m] between the places where the sides met the edge
/// [m] The near beam of a robot whose casters stand on a step of 3 mm wavers about its threshold.
constexpr double kWavers = GroundThresholds{}.near + 0.0015;

}  // namespace

/// True if the near beam of a side is off the floor, and no refused edge lies before its foot.
bool GroundSurvey::meets_unknown(const Side& side) const {
  if (side.off < 2) return false;
  const Pose2 beam_W = compose(pose_W_, {0, side.y, 0});
  return refused_.ahead(beam_W, kBesideBeam) > foot_ + kKnown;
}

SurveyAnswer GroundSurvey::watch(const SurveyInput& in, const Parameters& p) {
  const bool near = left_.look.near_off || right_.look.near_off;
  const bool far = reader_.ready() && (left_.look.far_off || right_.look.far_off);
  if (far || near) creep_to_ = way_ + kCreepOn;
  const bool level = left_.level > kSettled && right_.level > kSettled;
  if (level && !far) {
    finding_ = {};
    can_pass_ = true;
  } else if (far && !near) {
    finding_ = {.kind = GroundClass::Pending};
    can_pass_ = true;
  }
  if (fresh_ && driver_ != SurveyDriver::Nobody &&
      (meets_unknown(left_) || meets_unknown(right_))) {
    see(left_);
    see(right_);
    const bool both = left_.seen && right_.seen;
    if (driver_ == SurveyDriver::Goal && both) {
      begin_align(in);
    } else if (driver_ == SurveyDriver::Goal) {
      left_.farthest_off = right_.farthest_off = 0;
      enter(SurveyState::OneSide, in);
    } else {
      tried_at_ = way_;
      enter(SurveyState::Trials, in);
    }
  }
  const bool creeps = near || way_ < creep_to_ || !reader_.ready();
  SurveyAnswer out{.v_max = creeps ? p[kGroundCreep] : p[kGroundSpeed],
                   .omega_min = -p[kGroundTurn],
                   .omega_max = p[kGroundTurn]};
  out.why = creeps ? "Something lies ahead on the ground: slowly, until it is known."
                   : "The floor sensors look no farther: no faster than they can read.";
  const double front = spec_.half_length > 0 ? spec_.half_length : spec_.radius;
  const double half_width = spec_.half_length > 0 ? spec_.half_width : spec_.radius;
  if (refused_.ahead(in.pose_W, half_width + kBesideHull) < front + kBefore) {
    out.v_max = 0;
    out.why = "Ground that the robot cannot drive over lies just ahead.";
  }
  return out;
}

/// An edge that was never there, since neither beam was clearly off the floor, is forgotten.
SurveyAnswer GroundSurvey::one_side(const SurveyInput& in, const Parameters& p) {
  if (fresh_) {
    for (Side* side : {&left_, &right_}) {
      see(*side);
      // Written so that NaN is clearly off the floor.
      const double off = std::abs(side->look.near - reader_.flat().near);
      if (!(off <= side->farthest_off)) side->farthest_off = off;
    }
  }
  const bool late = in.stamp - entered_ > p[kGroundSkew];
  if (left_.seen && right_.seen) {
    begin_align(in);
  } else if (late && left_.farthest_off <= kWavers && right_.farthest_off <= kWavers) {
    forget_edge();
    enter(SurveyState::Watch, in);
  } else if (late) {
    finding_ = {.kind = GroundClass::Unknown, .confidence = 0};
    refuse(in);
  }
  return {.twist = Twist2{p[kGroundCreep], 0},
          .why = "One side sees an edge: the robot creeps until the other does too."};
}

void GroundSurvey::begin_align(const SurveyInput& in) {
  parallel_ = std::abs(left_.past - right_.past) < kParallel;
  enter(SurveyState::Align, in);
}

/// Section 5.2. A side that is past a narrow trench sees flat floor again, but reverses to where it
/// first saw the edge. A robot that is parallel to the edge already backs straight (ours): noise
/// alone would turn it, and on a slope a turn may begin a slide.
SurveyAnswer GroundSurvey::align(const SurveyInput& in, const Parameters& p) {
  bool left_back = left_.look.near_off || left_.past > 0;
  bool right_back = right_.look.near_off || right_.past > 0;
  if (parallel_) left_back = right_back = left_back || right_back;
  if (left_back || right_back) {
    levelled_ = 0;
  } else if (fresh_) {
    ++levelled_;
  }
  if (levelled_ >= kSettled) {
    forget_edge();
    enter(SurveyState::Approach, in);
  } else if (in.stamp - entered_ > kAlignTime) {
    finding_ = {.kind = GroundClass::Unknown, .confidence = 0};
    refuse(in);
  }
  const double v_left = left_back ? -p[kGroundCreep] : 0;
  const double v_right = right_back ? -p[kGroundCreep] : 0;
  return {.twist = Twist2{(v_left + v_right) / 2, (v_right - v_left) / (2 * spec_.half_track)},
          .why = "The robot turns until its front is parallel to the edge."};
}

SurveyAnswer GroundSurvey::approach(const SurveyInput& in, const Parameters& p) {
  const auto other = [](const GroundLook& look) {
    return look.kind != GroundClass::Flat && look.kind != GroundClass::Pending;
  };
  if (fresh_ && (other(left_.look) || other(right_.look))) {
    tried_at_ = way_;
    enter(SurveyState::Trials, in);
    try_side(left_);
    try_side(right_);
  } else if (way_ - from_way_ > kApproachWay) {
    enter(SurveyState::Watch, in);  // nothing is there after all
  }
  return {.twist = Twist2{p[kGroundCreep], 0},
          .why = "The robot goes back to the edge, straight this time."};
}

/// Section 5.4: a slope down is measured at rest. A surface that falls away lets the readings vary
/// most.
SurveyAnswer GroundSurvey::measure(const SurveyInput& in, const Parameters& p) {
  const auto add = [](double range, double& sum, int& count) {
    if (!std::isfinite(range)) return;
    sum += range;
    ++count;
  };
  if (fresh_) {
    add(in.ranges->far_left, left_.far_sum, left_.far_count);
    add(in.ranges->near_left, left_.near_sum, left_.near_count);
    add(in.ranges->far_right, right_.far_sum, right_.far_count);
    add(in.ranges->near_right, right_.near_sum, right_.near_count);
    ++levelled_;
  }
  if (levelled_ >= kSlopeReadings) decide(in, p);
  return {.twist = driver_ == SurveyDriver::Goal ? std::optional(Twist2{}) : std::nullopt,
          .v_max = 0,
          .omega_min = 0,
          .omega_max = 0,
          .why = "The ground falls away: the robot stands and measures the slope."};
}

SurveyAnswer GroundSurvey::cross(const SurveyInput& in, const Parameters& p) {
  const double way = way_ - from_way_;
  const double rear = std::min(spec_.axle, 0.0) - kClear;
  if (way < -kClear || way > foot_ - rear) {
    forget_edge();
    for (Side* side : {&left_, &right_}) side->off = 0;
    enter(SurveyState::Watch, in);
  }
  // By hand, the second side of an edge that was met obliquely is crossed later.
  if (driver_ == SurveyDriver::Hand && fresh_) {
    for (Side* side : {&left_, &right_}) {
      const bool seen = side->seen;
      see(*side);
      if (!seen && side->seen) from_way_ = way_;
    }
  }
  return {.twist = driver_ == SurveyDriver::Goal ? std::optional(Twist2{p[kGroundSpeed], 0})
                                                 : std::nullopt,
          .v_max = p[kGroundSpeed],
          .omega_min = -p[kGroundTurn],
          .omega_max = p[kGroundTurn],
          .why = "The robot can drive over what lies ahead."};
}

SurveyAnswer GroundSurvey::back_off(const SurveyInput& in, const Parameters& p) {
  if (from_way_ - way_ >= p[kGroundBackOff]) {
    // Away from an edge that only one side sees; else to the same side as before, so that it does
    // not turn to and fro.
    if (left_.seen != right_.seen) to_left_ = right_.seen;
    away_ = wrap_angle(in.pose_W.heading + (to_left_ ? kTurnAway : -kTurnAway));
    forget_edge();
    enter(SurveyState::TurnAway, in);
  }
  return {.twist = Twist2{-p[kGroundCreep], 0},
          .why = "The robot backs off ground that it cannot drive over."};
}

SurveyAnswer GroundSurvey::turn_away(const SurveyInput& in, const Parameters& p) {
  const double error = wrap_angle(away_ - in.pose_W.heading);
  if (std::abs(error) < kTurned) enter(SurveyState::Watch, in);
  const double rate = std::clamp(2 * error, -p[kGroundTurn], p[kGroundTurn]);
  return {.twist = Twist2{0, rate},
          .why = "The robot turns away from ground that it cannot drive over."};
}

/// By hand. An edge on one side also forbids turns towards it: a front wheel could swing over it.
SurveyAnswer GroundSurvey::refused(const SurveyInput& in, const Parameters& p) {
  if (!still_ahead() || driver_ == SurveyDriver::Goal) {
    const bool again = driver_ == SurveyDriver::Goal && still_ahead();
    if (!again) forget_edge();
    enter(again ? SurveyState::BackOff : SurveyState::Watch, in);
  }
  SurveyAnswer out{.v_max = 0, .omega_min = -p[kGroundTurn], .omega_max = p[kGroundTurn]};
  if (left_.seen && !right_.seen) out.omega_max = 0;
  if (right_.seen && !left_.seen) out.omega_min = 0;
  out.why = "The robot cannot drive over what lies ahead. Back off, and go round.";
  return out;
}

}  // namespace algo
