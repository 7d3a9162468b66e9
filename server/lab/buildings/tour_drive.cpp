// server/lab/buildings/tour_drive.cpp: the loop of robot and pipeline, with a judge for each goal.
#include "server/lab/buildings/tour_drive.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "algo/full_strip/full_strip_controller.hpp"
#include "algo/pipeline/pipeline.hpp"
#include "server/experiment/judge.hpp"
#include "server/lab/buildings/map_trueness.hpp"
#include "server/run/matched_robot.hpp"
#include "server/run/run_spec.hpp"

namespace server::buildings {
namespace {

using algo::Vec2;

constexpr std::array<std::string_view, kOdometries.size()> kOdometryNames{
    "true", "wheels", "matched"};
constexpr std::array<std::string_view, kVerdicts> kVerdictNames{
    "reached", "refused_rightly", "refused_wrongly", "late", "searched", "blocked", "collided"};
constexpr double kVisitEvery = 1.0;  // [s] the map's pieces are told where they lie

/// [MB] of this process that lie in memory.
double resident_memory() {
  std::ifstream file("/proc/self/statm");
  double total = 0;
  double resident = 0;
  file >> total >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

/// The built-in controllers, with a look at the strip that is made of them.
class LentStrip {
 public:
  explicit LentStrip(const std::string& controller) {
    std::vector<algo::ControllerInfo> entries = algo::builtin_controllers().entries();
    for (algo::ControllerInfo& entry : entries) {
      if (entry.name != controller) continue;
      entry.make = [this, make = entry.make] {
        auto made = make();
        strip_ = dynamic_cast<const algo::FullStripController*>(made.get());
        return made;
      };
    }
    catalogue_ = algo::ControllerCatalogue(std::move(entries));
  }
  LentStrip(const LentStrip&) = delete;
  LentStrip& operator=(const LentStrip&) = delete;

  const algo::ControllerCatalogue& catalogue() const { return catalogue_; }
  /// Null if the controller is no full strip.
  const algo::FullStripController* strip() const { return strip_; }

 private:
  algo::ControllerCatalogue catalogue_{};
  const algo::FullStripController* strip_ = nullptr;
};

RunSpec spec_of(const sim::Scenario& scenario, std::uint64_t seed, Odometry odometry) {
  RunSpec spec = make_spec(scenario, {});
  spec.seed = seed;
  if (odometry == Odometry::True) return spec;
  spec.scenario.drive.odometry_scale = kScaleError;
  spec.scenario.drive.odometry_noise = kOdometryNoise;
  return spec;
}

std::unique_ptr<algo::Robot> robot_of(const RunSpec& spec, Odometry odometry) {
  std::unique_ptr<algo::Robot> robot = make_robot(spec);
  if (odometry != Odometry::Matched) return robot;
  return std::make_unique<MatchedRobot>(std::move(robot));
}

/// The point `p` of the frame of `from` in which `from` is replaced by `to`.
Vec2 carried_over(const algo::Pose2& from, const algo::Pose2& to, const Vec2& p) {
  return to_parent(to, to_child(from, p));
}

class TourDrive {
 public:
  TourDrive(std::uint64_t seed, const TourOptions& options)
      : tour_building_(tour_building_of(seed, options.controller)),
        goals_(tour_building_, seed),
        spec_(spec_of(tour_building_.building.scenario, seed, options.odometry)),
        robot_(robot_of(spec_, options.odometry)),
        lent_(options.controller),
        pipeline_(config_of(spec_), robot_->spec(), lent_.catalogue()) {
    robot_->reset(t_.observation);
    pipeline_.reset(t_.observation.odometry.pose);
  }

  /// Drives to the next goal.
  Leg drive(const std::stop_token& stop) {
    Leg leg{.goal = goals_.next(truth().position())};
    const Vec2 told_W = carried_over(truth(), believed(), leg.goal.position_W);
    const double begin = t_.observation.stamp;
    const experiment::Settings settings{{"stands_s", kStandsLong},
                                        {"limit_s", begin + limit_of(leg.goal.truth)}};
    const experiment::JudgeInfo& silence = experiment::find_judge("silence");
    const auto judge = silence.make({spec_, robot_->spec(), settings});
    t_.requests.push_back(algo::SetGoal{told_W, std::nullopt});
    while (!judge->ending() && !stop.stop_requested()) tick(*judge);
    if (!judge->ending()) return leg;
    std::array<double, 3> figures{};
    judge->write(figures);
    leg.end = end_of(judge->ending()->outcome, figures[0] > 0, static_cast<int>(figures[2]));
    leg.reason = judge->ending()->reason;
    leg.seconds = t_.observation.stamp - begin;
    leg.end_W = truth().position();
    leg.drift = (believed().position() - leg.end_W).norm();
    if (leg.end == End::Refused && leg.goal.truth.has_way) {
      const Vec2 now_W = carried_over(believed(), truth(), told_W);
      leg.drifted_off = !goals_.between(leg.end_W, now_W).has_way;
    }
    leg.memory_mb = resident_memory();
    return leg;
  }

  void judge_map(Tour& tour) const {
    tour.doubled = std::numeric_limits<double>::quiet_NaN();
    if (lent_.strip() == nullptr) return;
    const std::vector<Vec2> walls_W = remembered_walls(lent_.strip()->senses());
    tour.walls = walls_W.size();
    tour.doubled = doubled_share(walls_W, pieces_, goals_.oracle());
  }

  const Building& building() const { return tour_building_.building; }

 private:
  static algo::PipelineConfig config_of(const RunSpec& spec) {
    algo::PipelineConfig config = pipeline_config(spec);
    config.by_hand = false;  // no operator
    return config;
  }
  algo::Pose2 truth() const { return robot_->ground_truth()->pose; }
  const algo::Pose2& believed() const { return t_.observation.odometry.pose; }

  void tick(experiment::Judge& judge) {
    if (t_.observation.stamp >= next_visit_) {
      next_visit_ = t_.observation.stamp + kVisitEvery;
      pieces_.visit(believed(), truth());
    }
    pipeline_.tick(t_);
    t_.ground_truth = robot_->ground_truth();
    judge.see(t_);
    t_.requests.clear();
    robot_->step(t_.command, t_.observation);
  }

  TourBuilding tour_building_;
  TourGoals goals_;
  RunSpec spec_;
  std::unique_ptr<algo::Robot> robot_;
  LentStrip lent_;
  algo::Pipeline pipeline_;
  algo::Telemetry t_{};
  MapPieces pieces_{};
  double next_visit_ = 0;  // [s] run clock
};

}  // namespace

std::string_view name(Odometry odometry) {
  return kOdometryNames.at(static_cast<std::size_t>(odometry));
}

Odometry odometry_named(std::string_view name) {
  const auto found = std::ranges::find(kOdometryNames, name);
  if (found == kOdometryNames.end()) {
    throw std::invalid_argument(fmt::format(
        "No odometry is called '{}'; there are {}.", name, fmt::join(kOdometryNames, ", ")));
  }
  return kOdometries.at(static_cast<std::size_t>(found - kOdometryNames.begin()));
}

std::string_view name(Verdict verdict) {
  return kVerdictNames.at(static_cast<std::size_t>(verdict));
}

Verdict verdict_of(const Leg& leg) {
  switch (leg.end) {
    case End::Reached:
      return Verdict::Reached;
    case End::Refused:
      return leg.goal.truth.has_way && !leg.drifted_off ? Verdict::RefusedWrongly
                                                        : Verdict::RefusedRightly;
    case End::Collided:
      return Verdict::Collided;
    case End::OutOfTime:
      return leg.goal.truth.has_way ? Verdict::Late : Verdict::Searched;
    default:
      return Verdict::Blocked;
  }
}

bool is_fault(const Leg& leg) {
  const Verdict verdict = verdict_of(leg);
  return verdict != Verdict::Reached && verdict != Verdict::RefusedRightly;
}

Tour drive_tour(std::uint64_t seed, const TourOptions& options, const std::stop_token& stop) {
  TourDrive drive(seed, options);
  Tour tour{.seed = seed, .odometry = options.odometry, .building = drive.building()};
  tour.building.scenario.obstacles.clear();
  tour.legs.reserve(options.goals);
  while (tour.legs.size() < options.goals && !stop.stop_requested()) {
    tour.legs.push_back(drive.drive(stop));
    if (tour.legs.back().end == End::Collided) break;
  }
  drive.judge_map(tour);
  return tour;
}

}  // namespace server::buildings
