// server/lab/reproduce/robhaz_findings.cpp: the rules by which the sections A to H of Fig. 10 and
// 11 hold in a run.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "algo/teleop/speed_limit.hpp"
#include "algo/units.hpp"
#include "server/lab/reproduce/robhaz_study.hpp"

namespace server::reproduce {
namespace {

using Samples = std::vector<CourseSample>;

using algo::units::kRadiansPerDegree;
constexpr double kAhead = 45 * kRadiansPerDegree;  // a wall with its foot within this is in front
constexpr double kAside = 15 * kRadiansPerDegree;  // an obstacle beyond this is on one side
constexpr double kLeastStay = 1.0;                 // [s] shorter states are no section of a plot
constexpr double kTurnsWithin = 3.0;               // [s] in which left and right take turns
constexpr std::size_t kLeastTurns = 4;             // changes of sign
constexpr double kFallen = 0.8;                    // v_sprs at the end, of that at the start
constexpr double kFollowed = 0.95;                 // v of v_cmd
constexpr double kFullSpeed = 0.9;                 // of v_max: from here a wall is followed
constexpr double kDriving = 0.2;                   // of v_max: before the obstacle comes near
constexpr double kStanding = 0.05;                 // of v_max
constexpr double kLargestDrop = 0.1;               // of v_max in one sample
constexpr double kHandNear = 0.5;                  // of w_d: the hand's mean distance from it
constexpr double kLeastTurn = 0.1;                 // of w_max
constexpr double kDeadBand = 0.01;                 // W_DB 100
constexpr double kExactly = 1e-9;

/// Samples [begin, end).
struct Stretch {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

/// The longest stretch in which every sample `holds`.
template <typename Holds>
Stretch longest(const Samples& samples, const Holds& holds) {
  Stretch best;
  Stretch now;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!holds(samples[i])) {
      now.begin = i + 1;
      continue;
    }
    now.end = i + 1;
    if (now.size() > best.size()) best = now;
  }
  return best;
}

double length(const Stretch& stretch) {
  return static_cast<double>(stretch.size()) * algo::kTeleopPeriod;
}

std::span<const CourseSample> part(const Samples& samples, const Stretch& stretch) {
  return std::span(samples).subspan(stretch.begin, stretch.size());
}

/// Least and greatest of a member.
std::pair<double, double> extent(std::span<const CourseSample> samples,
                                 double CourseSample::*member) {
  const auto [least, most] = std::ranges::minmax_element(samples, {}, member);
  if (least == samples.end()) return {NAN, NAN};
  return {(*least).*member, (*most).*member};
}

CourseFinding found(const char* section, const char* claim, const Samples& samples, Stretch at) {
  CourseFinding out{.section = section, .claim = claim};
  if (at.size() == 0) return out;
  out.from = samples[at.begin].stamp;
  out.to = samples[at.end - 1].stamp;
  return out;
}

template <typename Where>
CourseFinding wall_seen(const char* section,
                        const char* claim,
                        const Samples& samples,
                        const Where& where) {
  const Stretch at = longest(samples, [&](const CourseSample& s) { return where(s.theta); });
  CourseFinding out = found(section, claim, samples, at);
  out.holds = length(at) >= kLeastStay - kExactly;
  const auto [right, left] = extent(part(samples, at), &CourseSample::theta);
  const auto [near, far] = extent(part(samples, at), &CourseSample::rho);
  out.figures = fmt::format("{:.1f} s; theta' {:.1f} to {:.1f} degrees, rho' {:.2f} to {:.2f} m",
                            length(at),
                            right / kRadiansPerDegree,
                            left / kRadiansPerDegree,
                            near,
                            far);
  return out;
}

/// The stretch of kTurnsWithin with the most changes of side.
CourseFinding sides_take_turns(const Samples& samples) {
  std::vector<std::size_t> changes;
  double side = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!(std::abs(samples[i].theta) > kAside)) continue;
    const double now = std::copysign(1.0, samples[i].theta);
    if (side != 0 && now != side) changes.push_back(i);
    side = now;
  }
  Stretch best;
  std::size_t most = 0;
  for (std::size_t first = 0, k = 0; k < changes.size(); ++k) {
    while (samples[changes[k]].stamp - samples[changes[first]].stamp > kTurnsWithin) ++first;
    if (k + 1 - first <= most) continue;
    most = k + 1 - first;
    best = {changes[first], changes[k] + 1};
  }
  CourseFinding out = found("D", "theta' changes its sign again and again", samples, best);
  out.holds = most >= kLeastTurns;
  out.figures = fmt::format(
      "{} changes within {:.0f} s, {} in the whole run", most, kTurnsWithin, changes.size());
  return out;
}

CourseFinding speed_follows_the_hand(const Samples& samples) {
  Stretch at;
  for (const CourseSample& s : samples) {
    if (!(s.v_cmd < s.v_sprs && s.v >= kFollowed * s.v_cmd)) break;
    ++at.end;
  }
  CourseFinding out =
      found("E", "v_sprs falls from its first value, v_cmd < v_sprs, v >= 0.95 v_cmd", samples, at);
  if (at.size() == 0) return out;
  const CourseSample& first = samples.front();
  const CourseSample& last = samples[at.end - 1];
  out.holds = length(at) >= kLeastStay && last.v_sprs <= kFallen * first.v_sprs && last.v_cmd > 0;
  double least = 1;
  for (const CourseSample& s : part(samples, at)) {
    if (s.v_cmd > 0) least = std::min(least, s.v / s.v_cmd);
  }
  out.figures =
      fmt::format("{:.1f} s; v_sprs {:.3f} to {:.3f}, v_cmd {:.3f} m/s, v / v_cmd at least {:.3f}",
                  length(at),
                  first.v_sprs,
                  last.v_sprs,
                  last.v_cmd,
                  least);
  return out;
}

CourseFinding speed_fades(const CourseRun& run) {
  const Samples& samples = run.samples;
  const auto stands = [&](const CourseSample& s) {
    return std::abs(s.theta) <= kAhead && s.v_cmd > 0.5 * run.v_max && s.v <= kStanding * run.v_max;
  };
  Stretch at;
  const auto end = std::ranges::find_if(samples, stands);
  if (end != samples.end()) {
    at.end = static_cast<std::size_t>(end - samples.begin()) + 1;
    at.begin = at.end - 1;
    while (at.begin > 0 && samples[at.begin].v < kDriving * run.v_max) --at.begin;
  }
  CourseFinding out = found(
      "F", "v goes to zero by degrees before the obstacle ahead, which comes nearer", samples, at);
  if (at.size() == 0) return out;
  double drop = 0;
  for (std::size_t i = at.begin + 1; i < at.end; ++i) {
    drop = std::max(drop, samples[i - 1].v - samples[i].v);
  }
  const CourseSample& first = samples[at.begin];
  const CourseSample& last = samples[at.end - 1];
  out.holds =
      length(at) >= kLeastStay && drop <= kLargestDrop * run.v_max && last.nearest < first.nearest;
  out.figures = fmt::format(
      "v {:.3f} to {:.3f} m/s in {:.1f} s, at most {:.3f} at once; nearest {:.2f} to {:.2f} m; "
      "v_cmd {:.3f} m/s",
      first.v,
      last.v,
      length(at),
      drop,
      first.nearest,
      last.nearest,
      last.v_cmd);
  return out;
}

CourseFinding wall_is_followed(const CourseRun& run) {
  const Stretch at =
      longest(run.samples, [](const CourseSample& s) { return std::isfinite(s.w_d); });
  CourseFinding out = found(
      "G", "w = w_d; q_offset tracks w_d with W_DB 100; the hand's w_cmd follows", run.samples, at);
  if (at.size() == 0) return out;
  double off_turn = 0, off_offset = 0, off_hand = 0, most_wanted = 0, wanted = 0, off_band = 0;
  for (const CourseSample& s : part(run.samples, at)) {
    off_turn = std::max(off_turn, std::abs(s.w - s.w_d));
    off_offset =
        std::max(off_offset, std::abs(s.q_offset_left - std::clamp(s.w_d / run.w_max, -1.0, 1.0)));
    off_band = std::max(off_band, std::abs(s.dead_band_left - kDeadBand));
    off_hand += std::abs(s.w_cmd - s.w_d);
    wanted += std::abs(s.w_d);
    most_wanted = std::max(most_wanted, std::abs(s.w_d));
  }
  out.holds = length(at) >= kLeastStay && off_turn <= kExactly && off_offset <= kExactly &&
              off_band <= kExactly && most_wanted >= kLeastTurn * run.w_max &&
              off_hand <= kHandNear * wanted;
  const double n = static_cast<double>(at.size());
  out.figures = fmt::format(
      "{:.1f} s; |w - w_d| at most {:.1f}, |w_d| at most {:.1f} and {:.1f} on average, |w_cmd - "
      "w_d| {:.1f} "
      "degrees/s on average",
      length(at),
      off_turn / kRadiansPerDegree,
      most_wanted / kRadiansPerDegree,
      wanted / n / kRadiansPerDegree,
      off_hand / n / kRadiansPerDegree);
  return out;
}

CourseFinding wall_is_left_alone(const CourseRun& run) {
  const auto slow_beside_wall = [&](const CourseSample& s) {
    return s.v_cmd > 0 && s.v_cmd <= kFullSpeed * run.v_max && s.rho <= 2 * run.d_ref;
  };
  const Stretch at = longest(run.samples, slow_beside_wall);
  CourseFinding out = found("H",
                            "v_cmd <= 0.9 v_max: no wall is followed, W_DB 10000, no force about X",
                            run.samples,
                            at);
  const auto is_free = [&](const CourseSample& s) {
    if (s.v_cmd > kFullSpeed * run.v_max) return true;
    return std::isnan(s.w_d) && s.dead_band_left == 1 && s.force_left == 0;
  };
  const auto taken =
      run.samples.size() - static_cast<std::size_t>(std::ranges::count_if(run.samples, is_free));
  out.holds = length(at) >= kLeastStay && taken == 0;
  out.figures =
      fmt::format("{:.1f} s beside a wall; {} samples with a force about X", length(at), taken);
  return out;
}

}  // namespace

std::vector<CourseFinding> judge_course(const CourseRun& run) {
  const Samples& samples = run.samples;
  return {wall_seen("A",
                    "the wall model comes from the left",
                    samples,
                    [](double theta) { return theta > kAhead; }),
          wall_seen("B",
                    "the wall model comes from the front",
                    samples,
                    [](double theta) { return std::abs(theta) <= kAhead; }),
          wall_seen("C",
                    "the wall model comes from the right",
                    samples,
                    [](double theta) { return theta < -kAhead; }),
          sides_take_turns(samples),
          speed_follows_the_hand(samples),
          speed_fades(run),
          wall_is_followed(run),
          wall_is_left_alone(run)};
}

}  // namespace server::reproduce
