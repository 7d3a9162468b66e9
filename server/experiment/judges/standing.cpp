// server/experiment/judges/standing.cpp: how long a robot rests on its way.
#include <cmath>
#include <optional>

#include "algo/driving.hpp"
#include "server/experiment/judge.hpp"

namespace server::experiment::judges {
namespace {

constexpr double kSlow = 0.05;      // share of the top speed; slower counts as rest
constexpr double kPause = 0.1;      // [s] of rest that make a pause
constexpr double kRounding = 1e-9;  // [s] by which a sum of periods may be less than their product

constexpr Column kStandingColumns[] = {
    {"standing_s", Aggregate::Mean, 1},  // all rest
    // Times it rested for 0.1 s or more and then drove on. The rest before the first motion and the
    // rest at the end of a run do not count.
    {"pauses", Aggregate::Mean, 1},
    {"pause_s", Aggregate::Mean, 2},  // rest in pauses
};

/// At rest means, by the true pose, slower than 5 % of the top speed and of the top turn rate. A
/// robot that turns on the spot does not rest.
class Standing final : public Judge {
 public:
  explicit Standing(const JudgedRun& run)
      : v_max_(run.spec.parameters[algo::kMaxSpeed]),
        omega_max_(run.spec.parameters[algo::kMaxTurnRate]),
        period_(run.robot.period) {}

  void see(const algo::Telemetry& t) override {
    if (!t.ground_truth) return;
    const algo::Pose2& pose = t.ground_truth->pose;
    if (last_W_ && at_rest(*last_W_, pose)) {
      time_ += period_;
      spell_ += period_;
    } else if (last_W_) {
      if (moved_ && spell_ >= kPause - kRounding) {
        pauses_ += 1;
        pause_time_ += spell_;
      }
      moved_ = true;
      spell_ = 0;
    }
    last_W_ = pose;
  }

  void write(std::span<double> row) const override {
    row[0] = time_;
    row[1] = pauses_;
    row[2] = pause_time_;
  }

 private:
  bool at_rest(const algo::Pose2& from_W, const algo::Pose2& to_W) const {
    const double moved = (to_W.position() - from_W.position()).norm();
    const double turned = std::abs(algo::wrap_angle(to_W.heading - from_W.heading));
    return moved < kSlow * v_max_ * period_ && turned < kSlow * omega_max_ * period_;
  }

  double v_max_ = 0;      // [m/s]
  double omega_max_ = 0;  // [rad/s]
  double period_ = 0;     // [s]
  std::optional<algo::Pose2> last_W_{};
  double time_ = 0;        // [s]
  double pauses_ = 0;      // count
  double pause_time_ = 0;  // [s]
  double spell_ = 0;       // [s] of the current rest
  bool moved_ = false;
};

}  // namespace

JudgeInfo standing() {
  return {.help = "Time at rest, and pauses from which the robot drives on",
          .columns = kStandingColumns,
          .make = make_judge<Standing>};
}

}  // namespace server::experiment::judges
