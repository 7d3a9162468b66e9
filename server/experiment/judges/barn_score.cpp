// server/experiment/judges/barn_score.cpp: the clock, the ending and the score of the BARN
// Challenge.
//
// Perille, Truong, Xiao, Stone: Benchmarking Metric Ground Navigation, SSRR 2020.
#include <algorithm>
#include <optional>

#include "server/experiment/judge.hpp"

namespace server::experiment::judges {
namespace {

constexpr double kMoved = 0.1;         // [m] from the start, at which the clock begins
constexpr double kTimeLimit = 100;     // [s] of that clock
constexpr double kPatience = 60;       // [s] for a robot that never moves
constexpr double kOptimalSpeed = 2.0;  // [m/s]

constexpr Column kBarnColumns[] = {
    {"barn_time_s", Aggregate::Mean, 2},        // of the benchmark's clock
    {"barn_score", Aggregate::Mean, 4},         // at most 0.5: editions since 2024
    {"barn_score_quarter", Aggregate::Mean, 4}  // at most 0.25: 2022 and 2023
};
constexpr std::string_view kBarnSettings[] = {"goal_radius", "optimal_length"};

/// Settings: `goal_radius` [m], default the benchmark's 1; `optimal_length` [m] of the best known
/// path, default the straight line.
class BarnScore final : public Judge {
 public:
  explicit BarnScore(const JudgedRun& run)
      : start_W_(run.spec.scenario.start.position()), goal_radius_(run.setting("goal_radius", 1)) {
    if (run.spec.scenario.goal) goal_W_ = run.spec.scenario.goal->position_W;
    const double straight = goal_W_ ? (*goal_W_ - start_W_).norm() : 0;
    optimal_time_ = run.setting("optimal_length", straight) / kOptimalSpeed;
  }

  void see(const algo::Telemetry& t) override {
    if (!t.ground_truth || !goal_W_ || ending_) return;
    const algo::Vec2 at_W = t.ground_truth->pose.position();
    const double stamp = t.observation.stamp;
    if (!moved_at_ && (at_W - start_W_).norm() > kMoved) moved_at_ = stamp;
    time_ = moved_at_ ? stamp - *moved_at_ : 0;
    if (t.ground_truth->overturned) {
      ending_ = Ending{algo::Outcome::Overturned, "The robot turned over."};
    } else if (t.ground_truth->fallen) {
      ending_ = Ending{algo::Outcome::Fallen, "The robot drove off an edge."};
    } else if (t.ground_truth->collided) {
      ending_ = Ending{algo::Outcome::Collided, "The hull touched an obstacle."};
    } else if ((at_W - *goal_W_).norm() < goal_radius_) {
      ending_ = Ending{algo::Outcome::Reached, ""};
    } else if (moved_at_ ? time_ >= kTimeLimit : stamp >= kPatience) {
      ending_ = Ending{algo::Outcome::OutOfTime, "The benchmark's time was over."};
    }
  }

  void write(std::span<double> row) const override {
    const bool reached = ending_ && ending_->outcome == algo::Outcome::Reached;
    row[0] = time_;
    row[1] = reached ? score(2) : 0;
    row[2] = reached ? score(4) : 0;
  }

  std::optional<Ending> ending() const override { return ending_; }

 private:
  /// s = OT / clip(AT, low OT, 8 OT).
  double score(double low) const {
    return optimal_time_ / std::clamp(time_, low * optimal_time_, 8 * optimal_time_);
  }

  algo::Vec2 start_W_{0, 0};
  std::optional<algo::Vec2> goal_W_{};
  double goal_radius_ = 1;            // [m]
  double optimal_time_ = 0;           // [s]
  std::optional<double> moved_at_{};  // [s] run clock
  double time_ = 0;                   // [s] of the benchmark's clock
  std::optional<Ending> ending_{};
};

}  // namespace

JudgeInfo barn_score() {
  return {.help = "Clock, ending and score of the BARN Challenge",
          .columns = kBarnColumns,
          .make = make_judge<BarnScore>,
          .settings = kBarnSettings,
          .ends = true};
}

}  // namespace server::experiment::judges
