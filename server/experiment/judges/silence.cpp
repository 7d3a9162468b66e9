// server/experiment/judges/silence.cpp: whether a robot that stands still gives a reason.
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "algo/gate.hpp"
#include "server/experiment/judge.hpp"

namespace server::experiment::judges {
namespace {

constexpr double kSilenceTimeLimit = 300;  // [s] unless the trial sets another
constexpr double kStands = 20;             // [s] without moving or turning, unless it sets another
constexpr double kWay = 0.05;              // [m]
constexpr double kTurn = 0.2;              // [rad]

constexpr Column kSilenceColumns[] = {
    {"silent", Aggregate::Sum, 0},        // 1: it stood for 20 s and gave no reason
    {"not_finite", Aggregate::Sum, 0},    // 1: a command was not a number
    {"end_state", Aggregate::Largest, 0}  // of the controller, as its words explain it
};
constexpr std::string_view kStandsSetting = "stands_s";
constexpr std::string_view kLimitSetting = "limit_s";
constexpr std::string_view kSilenceSettings[] = {kStandsSetting, kLimitSetting};

bool finite(const algo::Telemetry& t) {
  return std::isfinite(t.output.twist.v) && std::isfinite(t.output.twist.omega) &&
         std::isfinite(t.command.base.v) && std::isfinite(t.command.base.omega) &&
         t.hold != algo::holds::kNotFinite;
}

/// True for a reason to stand still. Everything else promises motion.
bool gives_reason(const algo::Telemetry& t) {
  return t.mission == algo::Mission::Stuck || t.mission == algo::Mission::Held || t.output.waits;
}

/// How long the robot has stayed in its place.
class Stand {
 public:
  double seconds(const algo::Pose2& pose, double stamp) {
    const bool moved = (pose.position() - at_.position()).norm() > kWay ||
                       std::abs(algo::wrap_angle(pose.heading - at_.heading)) > kTurn;
    if (moved || since_ < 0) {
      at_ = pose;
      since_ = stamp;
    }
    return stamp - since_;
  }

 private:
  algo::Pose2 at_{};
  double since_ = -1;  // [s]
};

/// Ends a run when the robot arrives, collides, stands for `stands_s` or has driven for `limit_s`.
/// The reason is the robot's last sentence.
class Silence final : public Judge {
 public:
  explicit Silence(const JudgedRun& run)
      : stands_(run.setting(kStandsSetting, kStands)),
        limit_(run.setting(kLimitSetting, kSilenceTimeLimit)) {}

  void see(const algo::Telemetry& t) override {
    if (!t.ground_truth || ending_) return;
    const double stamp = t.observation.stamp;
    state_ = t.output.state;
    reason_ = gives_reason(t) ? stamp : reason_;
    not_finite_ = !finite(t);
    if (not_finite_) return end(algo::Outcome::Failed, t);
    if (t.ground_truth->overturned) return end(algo::Outcome::Overturned, t);
    if (t.ground_truth->fallen) return end(algo::Outcome::Fallen, t);
    if (t.ground_truth->collided) return end(algo::Outcome::Collided, t);
    if (t.mission == algo::Mission::Arrived) return end(algo::Outcome::Reached, t);
    if (stand_.seconds(t.ground_truth->pose, stamp) > stands_) {
      // A reason given at any time while it stood counts: between attempts it may announce the
      // attempt instead.
      silent_ = stamp - reason_ >= stands_;
      return end(algo::Outcome::Stuck, t);
    }
    if (stamp > limit_) end(algo::Outcome::OutOfTime, t);
  }

  void write(std::span<double> row) const override {
    row[0] = silent_ ? 1 : 0;
    row[1] = not_finite_ ? 1 : 0;
    row[2] = state_;
  }

  std::optional<Ending> ending() const override { return ending_; }

 private:
  void end(algo::Outcome outcome, const algo::Telemetry& t) {
    ending_ = Ending{outcome, t.words.why};
  }

  double stands_ = 0;  // [s]
  double limit_ = 0;   // [s]
  Stand stand_{};
  double reason_ = -std::numeric_limits<double>::infinity();  // [s] when it last gave a reason
  int state_ = 0;
  bool silent_ = false;
  bool not_finite_ = false;
  std::optional<Ending> ending_{};
};

}  // namespace

JudgeInfo silence() {
  return {.help = "Whether the robot stood still without saying why, or commanded no number",
          .columns = kSilenceColumns,
          .make = make_judge<Silence>,
          .settings = kSilenceSettings,
          .ends = true};
}

}  // namespace server::experiment::judges
