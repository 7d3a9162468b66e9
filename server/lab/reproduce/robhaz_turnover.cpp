// server/lab/reproduce/robhaz_turnover.cpp: the operator of Fig. 12, and what Fig. 13 shows.
#include "server/lab/reproduce/robhaz_turnover.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "algo/pipeline/shared_control.hpp"
#include "algo/teleop/speed_limit.hpp"
#include "algo/units.hpp"
#include "server/lab/soak/hand_drive.hpp"
#include "server/lab/soak/slope_world.hpp"
#include "server/run/robot_library.hpp"
#include "sim/robot_model.hpp"

namespace server::reproduce {
namespace {

using algo::units::kRadiansPerDegree;

constexpr double kFigureSlope = 10 * kRadiansPerDegree;
constexpr double kFigureSeconds = 11;
constexpr double kPlateLength = 8;    // [m] along the slope
constexpr double kPlateWidth = 12;    // [m]
constexpr double kStartBefore = 1.5;  // [m] from the robot to the foot
constexpr double kStandsFor = 0.5;    // [s]
constexpr double kTurnsAt = 0.55;     // [m] past the foot
constexpr double kTurnRate = 0.7;     // [rad/s] onto the contour
constexpr double kOnContour = 6 * kRadiansPerDegree;
constexpr double kLastTurnAt = 1.6;          // [m] along the contour
constexpr double kFigureAcceleration = 0.8;  // [m/s2]
constexpr double kUphill = 0.02;             // [rad] of roll: the left side is the upper one
constexpr double kAlmost = 1e-6;

sim::Scenario figure_scenario(const std::string& robot, double slope) {
  const double on_map = kPlateLength * std::cos(slope);
  const soak::Facet plate{on_map, slope};
  sim::Scenario scenario;
  scenario.name = "fig12";
  scenario.robot = builtin_robot(robot);
  scenario.obstacles = soak::ridge({0, 0, std::numbers::pi / 2}, {&plate, 1}, kPlateWidth);
  scenario.start = {0, -kStartBefore, std::numbers::pi / 2};
  scenario.drive.max_acceleration = kFigureAcceleration;
  return scenario;
}

/// The operator of Fig. 12: up the slope, right onto the contour, along it, then full left.
class FigureOperator {
 public:
  explicit FigureOperator(double w_max) : w_max_(w_max) {}

  algo::Joystick at(double stamp, const algo::Pose2& pose_W) {
    algo::Joystick stick{.mode = algo::StickMode::Raw};
    if (stamp < kStandsFor) return stick;
    stick.forward = 1;
    if (part_ == Part::Up && pose_W.y > kTurnsAt) part_ = Part::Onto;
    if (part_ == Part::Onto && std::abs(pose_W.heading) < kOnContour) part_ = Part::Along;
    if (part_ == Part::Along && pose_W.x > kLastTurnAt) part_ = Part::Left;
    if (part_ == Part::Onto) stick.turn = -kTurnRate / w_max_;
    if (part_ == Part::Left) stick.turn = 1;
    return stick;
  }

 private:
  enum class Part : std::uint8_t { Up, Onto, Along, Left };
  double w_max_ = 0;  // [rad/s]
  Part part_ = Part::Up;
};

TurnoverSample sample_of(const soak::HandDrive& robot, double w_max) {
  const algo::Telemetry& t = robot.telemetry();
  const auto measure = [&t](std::string_view name) {
    return t.output.measure(name).value_or(std::numeric_limits<double>::quiet_NaN());
  };
  const sim::VehicleState& state = robot.state();
  return {.stamp = t.observation.stamp,
          .x = state.pose_W.x,
          .y = state.pose_W.y,
          .heading = state.pose_W.heading,
          .roll = state.roll,
          .pitch = state.pitch,
          .roll_predicted = measure("turnover.roll_predicted"),
          .pitch_predicted = measure("turnover.pitch_predicted"),
          .v = t.command.base.v,
          .w_cmd = robot.heard().turn * w_max,
          .w = t.command.base.omega,
          .w_lb = measure("turnover.w_min"),
          .w_ub = measure("turnover.w_max"),
          .q_offset = measure("turnover.q_offset"),
          .dead_band = measure("turnover.dead_band"),
          .force_left = measure("turnover.force_left"),
          .force_forward = t.output.measure("teleop.force_forward").value_or(0)};
}

TurnoverRun drive_figure(const std::string& name, double slope, bool with_guard) {
  const sim::Scenario scenario = figure_scenario(name, slope);
  const algo::Stance stance = sim::stance_of(scenario.robot);
  soak::HandDrive robot(scenario, 1, with_guard ? std::optional(stance) : std::nullopt);
  TurnoverRun run{.robot = name,
                  .mass_height = scenario.robot.mass_height,
                  .with_guard = with_guard,
                  .w_max = algo::full_stick(robot.spec(), scenario.parameters).omega};
  FigureOperator driver(run.w_max);
  double next_sample = 0;
  while (robot.observation().stamp < kFigureSeconds && !robot.overturned()) {
    robot.tick(driver.at(robot.observation().stamp, robot.truth().pose));
    run.steepest =
        std::max({run.steepest, std::abs(robot.state().roll), std::abs(robot.state().pitch)});
    if (robot.observation().stamp < next_sample) continue;
    run.samples.push_back(sample_of(robot, run.w_max));
    next_sample += algo::kTeleopPeriod;
  }
  run.seconds = robot.observation().stamp;
  run.overturned = robot.overturned();
  return run;
}

const TurnoverRun& run_of(const TurnoverStudy& study, std::string_view robot, bool with_guard) {
  return *std::ranges::find_if(study.runs, [&](const TurnoverRun& run) {
    return run.robot == robot && run.with_guard == with_guard;
  });
}

/// Fig. 13 on the run with the guard and the mass high.
void judge_bounds(const TurnoverRun& run, std::vector<TurnoverFinding>& findings) {
  int bound = 0;   // samples in which the upper limit was active
  int within = 0;  // samples in which w is w_cmd within the range
  int other = 0;   // and neither
  double least_ub = run.w_max;
  double most_lb = -run.w_max;
  double band_error = 0;
  double forward = 0;
  double pushed = 0;
  for (const TurnoverSample& s : run.samples) {
    if (!std::isfinite(s.w_ub)) continue;
    const double expected = std::clamp(s.w_cmd, s.w_lb, s.w_ub);
    if (std::abs(s.w - expected) > kAlmost) {
      ++other;
    } else if (s.w_cmd > s.w_ub + kAlmost) {
      ++bound;
      // Where the slope runs along the tracks, our share of grip narrows both limits.
      if (s.roll > kUphill) most_lb = std::max(most_lb, s.w_lb);
      pushed = std::min(pushed, s.force_left);
    } else {
      ++within;
    }
    least_ub = std::min(least_ub, s.w_ub);
    band_error = std::max({band_error,
                           std::abs(s.q_offset - (s.w_lb + s.w_ub) / 2 / run.w_max),
                           std::abs(s.dead_band - (s.w_ub - s.w_lb) / 2 / run.w_max)});
    forward = std::max(forward, std::abs(s.force_forward));
  }
  findings.push_back({"The upper limit of w is active while the operator turns left on the slope",
                      bound > 0 && pushed < 0,
                      fmt::format("in {} samples, w_ub down to {:.2f} rad/s; the force about X "
                                  "reaches {:.2f} of full",
                                  bound,
                                  least_ub,
                                  pushed)});
  findings.push_back({"The lower limit stays truncated at -w_max while the turn leads uphill",
                      most_lb < -run.w_max + kAlmost,
                      fmt::format("w_lb at most {:.3f} rad/s", most_lb)});
  findings.push_back({"w is w_cmd within the range, and the limit beyond it",
                      other == 0 && within > 0,
                      fmt::format("within in {} samples, neither in {}", within, other)});
  findings.push_back({"q_offset and W_DB follow from the two bounds (Eq. 28, 29)",
                      band_error < 1e-9,
                      fmt::format("off by {:.1e} at most", band_error)});
  findings.push_back(
      {"No force about Y", forward == 0, fmt::format("{:.2f} of full at most", forward)});
}

std::vector<TurnoverFinding> judge(const TurnoverStudy& study) {
  const TurnoverRun& low = run_of(study, kLowRobot, false);
  const TurnoverRun& low_guarded = run_of(study, kLowRobot, true);
  const TurnoverRun& high = run_of(study, kTallRobot, false);
  const TurnoverRun& high_guarded = run_of(study, kTallRobot, true);
  std::vector<TurnoverFinding> out;
  out.push_back({"h 0.25 m: no turnover on this slope (path 1)",
                 !low.overturned && !low_guarded.overturned,
                 fmt::format("leans by {:.1f} degrees at most", low.steepest / kRadiansPerDegree)});
  out.push_back({"h 0.90 m without the controller: it turns over",
                 high.overturned,
                 fmt::format("after {:.1f} s; the paper's run with the controller lasted 6.3 s",
                             high.seconds)});
  out.push_back(
      {"h 0.90 m with the controller: it stays up (path 2)",
       !high_guarded.overturned,
       fmt::format("leans by {:.1f} degrees at most", high_guarded.steepest / kRadiansPerDegree)});
  judge_bounds(high_guarded, out);
  return out;
}

}  // namespace

TurnoverStudy study_turnover(double slope) {
  TurnoverStudy study{.slope = slope};
  for (const std::string_view robot : {kLowRobot, kTallRobot}) {
    for (const bool with_guard : {false, true}) {
      study.runs.push_back(drive_figure(std::string(robot), slope, with_guard));
    }
  }
  study.findings = judge(study);
  return study;
}

TurnoverStudy study_turnover() {
  return study_turnover(kFigureSlope);
}

bool all_hold(const TurnoverStudy& study) {
  return std::ranges::all_of(study.findings, &TurnoverFinding::holds);
}

experiment::Table runs_table(const TurnoverStudy& study) {
  experiment::Table out{
      .header = {"h [m]", "controller", "outcome", "seconds", "leans at most [deg]"}, .words = 3};
  for (const TurnoverRun& run : study.runs) {
    out.rows.push_back({fmt::format("{:.2f}", run.mass_height),
                        run.with_guard ? "with" : "without",
                        run.overturned ? "turns over" : "stays up",
                        fmt::format("{:.1f}", run.seconds),
                        fmt::format("{:.1f}", run.steepest / kRadiansPerDegree)});
  }
  return out;
}

experiment::Table findings_table(const TurnoverStudy& study) {
  experiment::Table out{.header = {"finding", "", "figures"}, .words = 3};
  for (const TurnoverFinding& each : study.findings) {
    out.rows.push_back({each.claim, each.holds ? "holds" : "FAILS", each.figures});
  }
  return out;
}

nlohmann::json to_json(const TurnoverStudy& study) {
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
  };
  nlohmann::json runs = nlohmann::json::array();
  for (const TurnoverRun& run : study.runs) {
    nlohmann::json samples = nlohmann::json::array();
    for (const TurnoverSample& s : run.samples) {
      samples.push_back({{"stamp", s.stamp},
                         {"x", s.x},
                         {"y", s.y},
                         {"heading", s.heading},
                         {"roll", s.roll},
                         {"pitch", s.pitch},
                         {"roll_predicted", number(s.roll_predicted)},
                         {"pitch_predicted", number(s.pitch_predicted)},
                         {"v", s.v},
                         {"w_cmd", s.w_cmd},
                         {"w", s.w},
                         {"w_lb", number(s.w_lb)},
                         {"w_ub", number(s.w_ub)},
                         {"q_offset", number(s.q_offset)},
                         {"dead_band", number(s.dead_band)},
                         {"force_left", number(s.force_left)},
                         {"force_forward", number(s.force_forward)}});
    }
    runs.push_back({{"robot", run.robot},
                    {"mass_height", run.mass_height},
                    {"controller", run.with_guard},
                    {"overturned", run.overturned},
                    {"seconds", run.seconds},
                    {"steepest", run.steepest},
                    {"samples", std::move(samples)}});
  }
  nlohmann::json findings = nlohmann::json::array();
  for (const TurnoverFinding& each : study.findings) {
    findings.push_back({{"claim", each.claim}, {"holds", each.holds}, {"figures", each.figures}});
  }
  return {{"slope", study.slope}, {"runs", std::move(runs)}, {"findings", std::move(findings)}};
}

std::string to_markdown(const TurnoverStudy& study, const std::string& pictures) {
  return fmt::format(
      "## Fig. 12 and 13: turnover on a slope\n\n"
      "The slope rises by {:.0f} degrees; the paper gives neither its slope nor its path. The "
      "operator drives up, turns right onto the contour and along it, then holds the stick full "
      "left (90 degrees/s at 0.86 m/s). The controller senses by the simulated laser line and "
      "inclinometer alone. The paper's run lasted 6.3 s; on this path the last turn comes later, "
      "and without the controller the robot falls {:.1f} s after the start.\n\n{}\n{}\n![The "
      "quantities of Fig. 13]({}/{})\n",
      study.slope / kRadiansPerDegree,
      run_of(study, kTallRobot, false).seconds,
      experiment::to_markdown(runs_table(study)),
      experiment::to_markdown(findings_table(study)),
      pictures,
      kTurnoverPicture);
}

}  // namespace server::reproduce
