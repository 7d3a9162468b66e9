// server/lab/soak/ground_courses.cpp: courses from a seed, and what became of the robot on them.
#include "server/lab/soak/ground_courses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "algo/pipeline/pipeline.hpp"
#include "algo/terrain/ground_verdict.hpp"
#include "algo/units.hpp"
#include "server/lab/soak/drive_hash.hpp"
#include "server/run/robot_library.hpp"
#include "sim/random.hpp"
#include "sim/world.hpp"

namespace server::soak {
namespace {

using algo::GroundClass;
using namespace algo::units;

constexpr std::uint64_t kCoursePurpose = 0x47524e44;
constexpr double kWide = 12;          // [m] of the ground across the way
constexpr double kPiecesApart = 1.2;  // [m] at least
constexpr double kMore = 0.4;         // [m] at most added to it
constexpr double kSlopeRun = 0.9;     // [m] of a slope on the map
constexpr double kSkew = 10 * kRadiansPerDegree;
constexpr double kDeep = 0.03;         // [m] of a trench
constexpr double kSmallest = 1.0 / 3;  // of a limit
constexpr double kLargest = 1.5;
constexpr double kOnFloor = 1e-6;    // [m]
constexpr double kHighEnough = 0.1;  // [m] for a slope down
constexpr double kNarrow = 0.02;     // [m] such trenches are recognised about half the time

double limit_of(GroundClass kind, const algo::ClimbLimits& limits) {
  switch (kind) {
    case GroundClass::StepUp:
      return limits.step_up;
    case GroundClass::StepDown:
      return limits.step_down;
    case GroundClass::Trench:
      return limits.trench;
    case GroundClass::SlopeUp:
      return limits.slope_up;
    default:
      return limits.slope_down;
  }
}

/// What the robot should still accept.
double accepted(GroundClass kind, const algo::ClimbLimits& limits) {
  switch (kind) {
    case GroundClass::StepUp:
    case GroundClass::StepDown:
      return limit_of(kind, limits) - algo::kStepMargin.initial;
    case GroundClass::Trench:
      return limits.trench * algo::kTrenchRatio.initial;
    case GroundClass::SlopeUp:
      return limits.slope_up - algo::kUphillMargin.initial;
    default:
      return limits.slope_down - algo::kDownhillMargin.initial;
  }
}

/// Lays pieces one after the other, all askew to the robot's way along x by the same angle.
class CourseBuilder {
 public:
  CourseBuilder(GroundCourse& course, double skew) : course_(course), skew_(skew) {}

  void flat(double length) { plateau(length); }
  /// After the last piece.
  void finish() {
    constexpr double kBeforeEnd = 0.4;  // [m]
    course_.scenario.name = "ground course";
    course_.scenario.robot = builtin_robot("masuda");
    course_.scenario.physics = sim::PhysicsKind::Bullet;
    course_.scenario.goal = algo::SetGoal{{x() - kBeforeEnd, 0}, std::nullopt};
  }
  void lay(GroundClass kind, double size) {
    CoursePiece piece{.kind = kind, .size = size, .from = x()};
    if (kind == GroundClass::StepUp) level_ += size;
    if (kind == GroundClass::StepDown) level_ -= size;
    if (kind == GroundClass::Trench) {
      add(size / 2, 0, algo::Trench{size, kWide, kDeep}, 0);
      along_ += size;
    }
    if (kind == GroundClass::SlopeUp || kind == GroundClass::SlopeDown) {
      const double rise = kSlopeRun * std::tan(size);
      const bool up = kind == GroundClass::SlopeUp;
      const double low = up ? level_ : std::max(0.0, level_ - rise);
      add(kSlopeRun / 2, up ? 0 : std::numbers::pi, algo::Ramp{kSlopeRun, kWide, low}, low + rise);
      level_ = up ? low + rise : low;
      along_ += kSlopeRun;
    }
    piece.to = x();
    course_.pieces.push_back(piece);
  }
  double level() const { return level_; }

 private:
  /// [m] of the end of the course, along the robot's way.
  double x() const { return along_ / std::cos(skew_); }
  void plateau(double length) {
    if (level_ > kOnFloor) add(length / 2, 0, algo::Ramp{length, kWide, level_}, level_);
    along_ += length;
  }
  /// A piece whose middle is `ahead` [m] of the end of the course.
  void add(double ahead, double heading, const algo::Shape& shape, double height) {
    algo::Obstacle piece{.id = ++id_, .shape = shape};
    if (height > 0) piece.height = height;  // a trench has none
    piece.pose_W = algo::compose({0, 0, skew_}, {along_ + ahead, 0, heading});
    course_.scenario.obstacles.push_back(piece);
  }

  GroundCourse& course_;
  double skew_ = 0;
  double along_ = 0;  // [m] of the end, at right angles to the edges
  double level_ = 0;
  std::uint32_t id_ = 0;
};

std::string verdict_of(const algo::Telemetry& t) {
  for (const algo::Layer& layer : t.layers) {
    if (layer.name == "ground.verdict") return layer.text;
  }
  return {};
}

}  // namespace

PieceFit fit_of(const CoursePiece& piece, const algo::ClimbLimits& limits) {
  if (piece.size > limit_of(piece.kind, limits)) return PieceFit::Above;
  return piece.size < accepted(piece.kind, limits) ? PieceFit::Below : PieceFit::Within;
}

bool is_narrow(const CoursePiece& piece) {
  return piece.kind == GroundClass::Trench && piece.size < kNarrow;
}

algo::ClimbLimits masuda_limits() {
  constexpr double kTick = 0.025;  // [s]
  constexpr algo::ClimbLimits kSafe{.step_up = 0.008,
                                    .step_down = 0.02,
                                    .trench = 0.025,
                                    .slope_up = 20_deg,
                                    .slope_down = 20_deg};
  return sim::spec_of(builtin_robot("masuda"), kTick).climbs.value_or(kSafe);
}

GroundCourse random_course(std::uint64_t seed, const algo::ClimbLimits& limits) {
  sim::Random random(seed, kCoursePurpose);
  GroundCourse course;
  CourseBuilder builder(course, random.uniform(-kSkew, kSkew));
  builder.flat(kPiecesApart);
  for (int k = 0; k < 3; ++k) {
    // Down only from above, and trenches in the floor alone.
    std::vector<GroundClass> kinds{GroundClass::StepUp, GroundClass::SlopeUp};
    const double level = builder.level();
    if (level <= kOnFloor) kinds.push_back(GroundClass::Trench);
    if (level >= kLargest * limits.step_down) kinds.push_back(GroundClass::StepDown);
    if (level >= kHighEnough) kinds.push_back(GroundClass::SlopeDown);
    const auto pick =
        static_cast<std::size_t>(random.uniform(0, static_cast<double>(kinds.size())));
    const GroundClass kind = kinds[std::min(pick, kinds.size() - 1)];
    double size = limit_of(kind, limits) * random.uniform(kSmallest, kLargest);
    // A slope down ends on the floor at the latest.
    if (kind == GroundClass::SlopeDown) size = std::min(size, std::atan(level / kSlopeRun));
    builder.lay(kind, size);
    builder.flat(kPiecesApart + random.uniform(0, kMore));
  }
  builder.finish();
  return course;
}

GroundCourse course_of(const std::vector<std::pair<GroundClass, double>>& pieces, double skew) {
  GroundCourse course;
  CourseBuilder builder(course, skew);
  builder.flat(kPiecesApart);
  for (const auto& [kind, size] : pieces) {
    builder.lay(kind, size);
    builder.flat(kPiecesApart);
  }
  builder.finish();
  return course;
}

CourseEnd drive_course(const GroundCourse& course,
                       const algo::ClimbLimits& limits,
                       std::uint64_t seed,
                       double seconds) {
  sim::World world(course.scenario, seed);
  algo::RobotSpec spec = world.spec();
  spec.climbs = limits;
  algo::Pipeline pipeline({.controller = "go_to_goal", .by_hand = false}, spec);
  algo::Telemetry t;
  world.reset(t.observation);
  pipeline.reset(t.observation.odometry.pose);
  t.requests.push_back(*course.scenario.goal);
  double farthest = 0;  // [m] of the rear axle
  CourseEnd end{.hash = 0xcbf29ce484222325ULL};
  const auto ticks = static_cast<int>(seconds / spec.period);
  for (int k = 0; k < ticks; ++k) {
    pipeline.tick(t);
    t.requests.clear();
    end.arrived = t.mission == algo::Mission::Arrived;
    // A second refusal of the same piece tells no more than the first.
    if (end.arrived || t.mission == algo::Mission::Stuck) break;
    world.step(t.command, t.observation);
    const algo::Pose2& pose_W = world.pose_W();
    for (const double value : {pose_W.x, pose_W.y, pose_W.heading}) mix(end.hash, value);
    farthest = std::max(farthest, pose_W.x + spec.axle);
    end.fell = world.overturned();
    if (end.fell) break;
  }
  for (const CoursePiece& piece : course.pieces) {
    const bool passed = farthest > piece.to;
    if (!passed && end.arrived) break;
    end.met.push_back({piece, fit_of(piece, limits), passed});
    if (passed) continue;
    end.words = std::string(name(piece.kind)) + ", found " + verdict_of(t);
    break;
  }
  return end;
}

}  // namespace server::soak
