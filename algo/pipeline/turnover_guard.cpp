// algo/pipeline/turnover_guard.cpp: the attitudes of a tick, and the limits that they set.
#include "algo/pipeline/turnover_guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace algo {
namespace {

constexpr std::size_t kLongestLine = 128;  // points of a line; more would allocate
constexpr double kLeastRamp = 0.2;         // [m/s2] even where the slope allows less: it must stop
constexpr double kReached = 0.02;          // [m/s] between speeds that count as equal
// [s] The trend of the measured attitude counts so far ahead. The inclinometer lags by 0.05 s, the
// roll follows the heading on a slope, and a robot of h 0.9 m tips over by the factor e in 0.33 s.
constexpr double kTrendLead = 0.35;
constexpr double kGrip = 0.5;        // friction that the robot counts on
constexpr double kLeastShare = 0.3;  // of the bound, however steep along the track
constexpr double kSlow = 0.15;       // [m/s] no turn lifts a track
constexpr double kSlides = 0.5;      // W/(2h) above which a robot slides before it turns over

constexpr LayerInfo kLine{.name = "terrain.line",
                          .label = "Laser line on the ground",
                          .kind = LayerKind::Points,
                          .tone = Tone::External,
                          .axes = 3};

/// Eq. 25 with a share of either bound. A bound beyond zero has no share to give away.
SidewaysRange shared(const SidewaysRange& range, double share) {
  return {range.min < 0 ? share * range.min : range.min,
          range.max > 0 ? share * range.max : range.max};
}

bool may_tip(const Stance& stance) {
  return stance.width < 2 * kSlides * stance.mass_height;
}

}  // namespace

TurnoverGuard::TurnoverGuard(const RobotSpec& spec)
    : spec_(spec), max_acceleration_(spec.max_acceleration), prediction_(*spec.stance) {
  line_R_.reserve(kLongestLine);
  line_W_.reserve(kLongestLine);
  reset({});
}

void TurnoverGuard::reset(const Pose2& /*start_W*/) {
  spec_.max_acceleration = max_acceleration_;
  prediction_.reset();
  line_R_.clear();
  line_W_.clear();
  measured_ = {};
  trend_.reset();
  sent_ = 0;
  turn_ = {-spec_.max_omega, spec_.max_omega};
  predicted_ = {};
  band_ = {};
  force_ = 0;
  stance_ = *spec_.stance;
  margin_ = standing_margin({}, stance_);
  along_ = max_acceleration_;
  here_ = true;
  ahead_ = true;
}

Proposal TurnoverGuard::propose(const Resource& in, ControlOutput& /*output*/) {
  sense(in);
  bound(in);
  reflect(in);
  return limits_of_tick(in);
}

void TurnoverGuard::sense(const Resource& in) {
  const Observation& seen = *in.observation;
  const auto& reading = seen.inclinometer;
  if (reading && std::isfinite(reading->roll) && std::isfinite(reading->pitch)) {
    measured_ = {reading->roll, reading->pitch};
    trend_.take(reading->stamp, measured_);
  }
  const Odometry& odometry = in.odometry;
  if (!finite(odometry.pose) || !finite(odometry.twist)) return;
  prediction_.move(odometry.twist, odometry.pose.heading, measured_, in.dt);
  if (spec_.line && seen.line.fresh) take_line(seen.line);
  const double cos_h = std::cos(odometry.pose.heading);
  const double sin_h = std::sin(odometry.pose.heading);
  if (!seen.line.fresh) return;
  line_W_.clear();
  for (const Vec3& p_R : line_R_) {
    const Vec3 p = to_level(measured_, p_R);
    line_W_.push_back({odometry.pose.x + cos_h * p.x() - sin_h * p.y(),
                       odometry.pose.y + sin_h * p.x() + cos_h * p.y(),
                       prediction_.height() + p.z()});
  }
}

void TurnoverGuard::take_line(const LineImage& image) {
  line_R_.clear();
  for (const LinePixel& pixel : image.pixels) {
    if (line_R_.size() == kLongestLine) break;
    const auto p_C = triangulated(*spec_.line, pixel.u, pixel.v);
    if (p_C) line_R_.push_back(to_robot(*spec_.line, *p_C));
  }
  if (const auto tracks = under_tracks(line_R_, stance_.width)) prediction_.take(*tracks);
}

/// Eq. 26 with `share` of the bounds.
TurnRange TurnoverGuard::turns(const Attitude& attitude, double v, double share) const {
  return turn_range(
      shared(sideways_range(attitude, stance_), share), v, spec_.max_v, spec_.max_omega);
}

/// The bound on a turn uphill alone, which is the nearer one. It has less where the slope runs
/// along the tracks: the track that this turn unloads must still hold its half of the weight's
/// pull. Where it slides, the robot turns about the other one, faster than its encoders know. The
/// turn takes the share q of the bound, so N (1 - q)/2 is left on that track, and kGrip of it must
/// hold m g |k_X|/2.
TurnRange TurnoverGuard::turns_uphill(const Attitude& attitude, double v, double share) const {
  const GravityShares k = gravity_shares(attitude);
  const double holds = std::max(kLeastShare, 1 - std::abs(k.x) / (kGrip * k.z));
  SidewaysRange range = sideways_range(attitude, stance_);
  const bool right = std::abs(range.min) < std::abs(range.max);
  range = shared(range, std::min(share, holds));
  (right ? range.max : range.min) = (right ? 1 : -1) * std::numeric_limits<double>::infinity();
  return turn_range(range, v, spec_.max_v, spec_.max_omega);
}

/// Narrows this tick's turn to `range` at the speed `v`. A robot that must turn to stay up may not
/// turn uphill while it moves.
void TurnoverGuard::narrow(const TurnRange& range, double v) {
  if (!range.must_turn) {
    turn_.min = std::max(turn_.min, range.min);
    turn_.max = std::min(turn_.max, range.max);
  } else if (std::abs(v) > kSlow) {
    const bool left = range.min > 0;
    if (left) turn_.min = std::max(turn_.min, 0.0);
    if (!left) turn_.max = std::min(turn_.max, 0.0);
  }
}

/// Eq. 28, 29: the force about X on a hand that asks for more than the bounds.
void TurnoverGuard::reflect(const Resource& in) {
  const double full = full_stick(in).omega;
  band_ = band_between(turn_.min, turn_.max, full);
  const double q = in.manual ? kFullStick * in.joystick.turn : 0;
  force_ = in.manual ? reflected_force(q, band_, {}, (*in.parameters)[kForceRamp]) : 0;
}

/// The bounds of this tick: for the attitude now, and for each one that the robot drives into.
void TurnoverGuard::bound(const Resource& in) {
  const Parameters& p = *in.parameters;
  const double share = p[kTurnoverShare];
  const double v = std::isfinite(in.odometry.twist.v) ? in.odometry.twist.v : 0;
  stance_ = *spec_.stance;
  stance_.mass_height *= 1 + p[kMassMargin];

  here_ = standing_margin(measured_, stance_) >= 0;
  ahead_ = true;
  turn_ = {.min = -spec_.max_omega, .max = spec_.max_omega};
  narrow(turns(measured_, v, share), v);
  narrow(turns_uphill(measured_, v, share), v);
  narrow(turns_uphill(trend_.after(kTrendLead), v, share), v);
  predicted_ = measured_;
  margin_ = standing_margin(measured_, *spec_.stance);
  along_ = along_limit(measured_, stance_, share);

  // Eq. 26: the speed at the place ahead, on the way to the speed last commanded.
  const double gap = sent_ - v;
  const double a = std::abs(gap) < kReached ? 0 : std::copysign(max_acceleration_, gap);
  double farthest = -1;
  prediction_.within(p[kTurnoverPreview], [&](const PredictedTilt& there) {
    double then = v + speed_change(v, a, there.ahead);
    then = a > 0 ? std::min(then, std::max(v, sent_)) : std::max(then, sent_);
    ahead_ = ahead_ && standing_margin(there.attitude, stance_) >= 0;
    // Where it must turn, it does not drive: see limits_of_tick().
    for (const TurnRange& range : {turns(there.attitude, std::max(0.0, then), share),
                                   turns_uphill(there.attitude, std::max(0.0, then), share)}) {
      if (!range.must_turn) narrow(range, v);
    }
    along_ = std::min(along_, along_limit(there.attitude, stance_, share));
    margin_ = std::min(margin_, standing_margin(there.attitude, *spec_.stance));
    if (there.ahead > farthest) {
      farthest = there.ahead;
      predicted_ = there.attitude;
    }
  });
  spec_.max_acceleration = std::min(max_acceleration_, std::max(along_, kLeastRamp));
}

Proposal TurnoverGuard::limits_of_tick(const Resource& in) const {
  Proposal out;
  TwistLimits& set = out.limits;
  set.reason = limits::kTurnover;
  set.omega_min = turn_.min;
  set.omega_max = turn_.max;
  if (!here_) {
    set.v_min = -kRetreat;
    set.v_max = 0;
    set.reason = limits::kTooSteepHere;
    return out;
  }
  if (!ahead_) {
    set.v_max = 0;
    set.reason = limits::kTooSteepAhead;
  }
  const bool raw = in.manual && in.joystick.mode == StickMode::Raw;
  if (raw && may_tip(*spec_.stance)) {
    set.v_min = -kBlindBack;
    if (in.joystick.forward < 0) set.reason = limits::kBlindBack;
  }
  return out;
}

double TurnoverGuard::eased(double wanted, const Odometry& odometry) {
  double from = sent_;
  const bool brakes = std::abs(wanted) < std::abs(sent_) || wanted * sent_ < 0;
  if (brakes && std::isfinite(odometry.twist.v)) {
    from = std::clamp(odometry.twist.v, std::min(sent_, wanted), std::max(sent_, wanted));
  }
  const double most = std::max(along_, kLeastRamp) * spec_.period;
  sent_ = towards(from, wanted, most);
  return sent_;
}

void TurnoverGuard::show(Telemetry& t) const {
  if (spec_.line) {
    Layer& line = add_layer(t.layers, kLine, 3 * kLongestLine);
    for (const Vec3& p : line_W_) put(line, p.x(), p.y(), p.z());
  }
  auto& out = t.output.measures;
  out.push_back({"turnover.roll_predicted", "rad", predicted_.roll});
  out.push_back({"turnover.pitch_predicted", "rad", predicted_.pitch});
  out.push_back({"turnover.w_min", "rad/s", turn_.min});
  out.push_back({"turnover.w_max", "rad/s", turn_.max});
  out.push_back({"turnover.q_offset", "", band_.offset / kFullStick});
  out.push_back({"turnover.dead_band", "", band_.half_width / kFullStick});
  out.push_back({"turnover.force_left", "", force_ / kFullStick});
  out.push_back({"turnover.a_max", "m/s2", along_});
  out.push_back({"turnover.margin", "rad", margin_});
  const auto newest = prediction_.newest();
  if (spec_.line) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    out.push_back({"terrain.profile_slope", "rad", newest ? -newest->attitude.pitch : kNone});
    out.push_back({"terrain.profile_roll", "rad", newest ? newest->attitude.roll : kNone});
  }
}

}  // namespace algo
