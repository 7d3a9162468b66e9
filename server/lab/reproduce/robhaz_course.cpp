// server/lab/reproduce/robhaz_course.cpp: reads the course, and drives it.
#include "server/lab/reproduce/robhaz_course.hpp"

#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "algo/pipeline/shared_control.hpp"
#include "algo/teleop/teleop_parameters.hpp"
#include "server/run/json_fields.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/text_file.hpp"

namespace server::reproduce {
namespace {

using nlohmann::json;

constexpr std::size_t kMostIntentions = 1000;
constexpr NumberRange kStickAxis{-1, 1};
constexpr NumberRange kCompliance{0, 10};

constexpr Field<HandConfig> kHand[] = {
    required("time_constant", &HandConfig::time_constant, {1e-3, 10}),
    required("forward_compliance", &HandConfig::forward_compliance, kCompliance),
    required("turn_compliance", &HandConfig::turn_compliance, kCompliance),
};
constexpr Field<Intention> kIntention[] = {
    required("stamp", &Intention::stamp, {0, 1e6}),
    required("forward", &Intention::forward, kStickAxis),
    required("turn", &Intention::turn, kStickAxis),
};

CourseSample sample_of(const algo::Telemetry& t,
                       const algo::Joystick& stick,
                       const CourseRun& run,
                       const algo::GroundTruth& truth) {
  const auto measure = [&t](std::string_view name) {
    return t.output.measure(name).value_or(std::numeric_limits<double>::quiet_NaN());
  };
  return {.stamp = t.observation.stamp,
          .pose_W = truth.pose,
          .clearance = truth.clearance,
          .nearest = measure("teleop.nearest"),
          .rho = measure("teleop.seen_rho"),
          .theta = measure("teleop.seen_theta"),
          .v_sprs = measure("teleop.v_sprs"),
          .v_cmd = stick.forward * run.v_max,
          .v = t.command.base.v,
          .w_cmd = stick.turn * run.w_max,
          .w_d = measure("teleop.w_d"),
          .w = t.command.base.omega,
          .q_offset_forward = measure("teleop.q_offset_forward"),
          .q_offset_left = measure("teleop.q_offset_left"),
          .dead_band_left = measure("teleop.dead_band_left"),
          .force_forward = measure("teleop.force_forward"),
          .force_left = measure("teleop.force_left")};
}

}  // namespace

RobhazCourse robhaz_course_from_json(const json& document) {
  const JsonReader in(document, "");
  in.only({"about", "seconds", "seed", "hand", "script", "scenario"});
  RobhazCourse course;
  course.seconds = in.number("seconds", {1, 3600});
  course.seed = in.whole("seed", std::numeric_limits<std::uint32_t>::max());
  read_only_fields(in.object("hand"), kHand, course.hand);
  in.each("script", kMostIntentions, [&](const json& value, const std::string& at) {
    Intention& next = course.script.emplace_back();
    read_only_fields({value, at}, kIntention, next);
    const std::size_t before = course.script.size() - 1;
    if (before > 0 && next.stamp <= course.script[before - 1].stamp) {
      throw DocumentError(at + "/stamp", "must be later than the one before");
    }
  });
  course.scenario = scenario_from_json(in.object("scenario").raw());
  return course;
}

namespace {

RobhazCourse course_from_text(std::string_view text) {
  return robhaz_course_from_json(parse_json(text, {.max_depth = 64, .max_bytes = 1u << 20}));
}

}  // namespace

RobhazCourse read_robhaz_course(const std::string& path) {
  const std::string text = read_text(path);
  try {
    return course_from_text(text);
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("{}: {}", path, e.what()));
  }
}

RobhazCourse embedded_robhaz_course() {
  return course_from_text(embedded_robhaz());
}

CourseRun drive_course(const RobhazCourse& course, const algo::Parameters& changed) {
  RunSpec spec = make_spec(course.scenario, {.seed = course.seed});
  for (const auto& [parameter, value] : changed.settings()) spec.parameters.set(*parameter, value);
  const std::unique_ptr<algo::Robot> robot = make_robot(spec);
  algo::Pipeline pipeline(pipeline_config(spec), robot->spec());
  const algo::Twist2 full = algo::full_stick(robot->spec(), spec.parameters);
  CourseRun run{
      .v_max = full.v, .w_max = full.omega, .d_ref = spec.parameters[algo::kWallDistance]};

  SimulatedHand hand(course.hand);
  algo::Telemetry t;
  robot->reset(t.observation);
  pipeline.reset(t.observation.odometry.pose);
  double next_sample = 0;
  while (t.observation.stamp < course.seconds) {
    const double stamp = t.observation.stamp;
    t.requests.clear();
    t.requests.push_back(hand.stick());
    if (const auto refusal = pipeline.refusal(hand.stick())) throw std::runtime_error(*refusal);
    pipeline.tick(t);
    const algo::GroundTruth truth = *robot->ground_truth();
    run.collided = run.collided || truth.collided;
    if (stamp >= next_sample - 1e-9) {
      run.samples.push_back(sample_of(t, hand.stick(), run, truth));
      next_sample += algo::kTeleopPeriod;
    }
    hand.feel(intention_at(course.script, stamp),
              t.output.measure("teleop.force_forward").value_or(0),
              t.output.measure("teleop.force_left").value_or(0),
              robot->spec().period);
    if (!robot->step(t.command, t.observation)) break;
  }
  return run;
}

}  // namespace server::reproduce
