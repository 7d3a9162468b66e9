// server/experiment/judges/motion.cpp: how direct, how roomy and how calm the motion is.
#include <cmath>
#include <limits>
#include <optional>

#include "server/experiment/judge.hpp"

namespace server::experiment::judges {
namespace {

constexpr double kTurns = 0.05;  // [rad/s] a slower command is no turn

constexpr Column kMotionColumns[] = {
    {"path_ratio", Aggregate::Mean, 2},        // driven / straight from the start through the goals
    {"mean_clearance_m", Aggregate::Mean, 3},  // over time, from the hull
    {"jerk_rms_m_s3", Aggregate::Mean, 2},     // second difference of the true speed / period^2
    {"effort_m2_s3", Aggregate::Mean, 3},      // integral of (dv/dt)^2 of the commanded speed
    {"turn_flips", Aggregate::Mean, 1},        // commanded turns that follow one the other way
    {"turn_rms_rad_s2", Aggregate::Mean, 2},   // change of the commanded turn / period
};

class Motion final : public Judge {
 public:
  explicit Motion(const JudgedRun& run) : period_(run.robot.period) {
    algo::Vec2 from_W = run.spec.scenario.start.position();
    for (const algo::SetGoal& goal : way_of(run.spec.scenario)) {
      straight_ += (goal.position_W - from_W).norm();
      from_W = goal.position_W;
    }
  }

  void see(const algo::Telemetry& t) override {
    follow_command(t.command.base);
    if (!t.ground_truth) return;
    const algo::Pose2& pose = t.ground_truth->pose;
    if (std::isfinite(t.ground_truth->clearance)) {
      clearance_ += t.ground_truth->clearance;
      ++clearances_;
    }
    if (last_W_) follow_step(pose);
    last_W_ = pose;
  }

  void write(std::span<double> row) const override {
    row[0] = straight_ > 0 ? length_ / straight_ : kUnknown;
    row[1] = clearances_ > 0 ? clearance_ / clearances_ : kUnknown;
    row[2] = jerks_ > 0 ? std::sqrt(squared_jerk_ / jerks_) : kUnknown;
    row[3] = effort_;
    row[4] = flips_;
    row[5] = changes_ > 0 ? std::sqrt(squared_change_ / changes_) : kUnknown;
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  void follow_command(const algo::Twist2& command) {
    if (last_) {
      const double change = command.v - last_->v;
      effort_ += change * change / period_;
      const double turn = (command.omega - last_->omega) / period_;
      squared_change_ += turn * turn;
      ++changes_;
    }
    last_ = command;
    if (std::abs(command.omega) < kTurns) return;
    const double side = std::copysign(1.0, command.omega);
    if (side_ * side < 0) flips_ += 1;
    side_ = side;
  }

  void follow_step(const algo::Pose2& pose) {
    const algo::Vec2 step_W = pose.position() - last_W_->position();
    length_ += step_W.norm();
    // Negative backwards.
    const double speed =
        std::copysign(step_W.norm(), step_W.dot(algo::direction(last_W_->heading))) / period_;
    if (steps_ >= 2) {
      const double jerk = (speed - 2 * speeds_[0] + speeds_[1]) / (period_ * period_);
      squared_jerk_ += jerk * jerk;
      ++jerks_;
    }
    speeds_[1] = speeds_[0];
    speeds_[0] = speed;
    ++steps_;
  }

  double straight_ = 0;  // [m] from the start through the goals
  double period_ = 0;    // [s]
  std::optional<algo::Pose2> last_W_{};
  double length_ = 0;                   // [m]
  double clearance_ = 0;                // [m] sum over ticks
  double clearances_ = 0;               // count
  double speeds_[2]{0, 0};              // [m/s] of the last step and of the one before
  std::size_t steps_ = 0;               // count
  double squared_jerk_ = 0;             // [m2/s6] sum
  double jerks_ = 0;                    // count
  std::optional<algo::Twist2> last_{};  // commanded
  double effort_ = 0;                   // [m2/s3]
  double squared_change_ = 0;           // [rad2/s4] sum
  double changes_ = 0;                  // count
  double side_ = 0;                     // of the last commanded turn: 1 left, -1 right
  double flips_ = 0;                    // count
};

}  // namespace

JudgeInfo motion() {
  return {.help = "Path / straight line, mean clearance, jerk, control effort, turns that flip",
          .columns = kMotionColumns,
          .make = make_judge<Motion>};
}

}  // namespace server::experiment::judges
