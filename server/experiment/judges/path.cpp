// server/experiment/judges/path.cpp: the papers' path measures beyond algo/metrics.hpp.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "algo/driving.hpp"
#include "server/experiment/judge.hpp"

namespace server::experiment::judges {
namespace {

constexpr double kResample = 0.050;  // [m] between kept positions, as for the turning

constexpr Column kPathColumns[] = {
    {"body_infringed_s", Aggregate::Largest, 1},  // an obstacle within d_safe of the hull
    {"body_depth_m", Aggregate::Largest, 3},      // its greatest depth
    // Sum of (change of direction)^2 / length of the later segment, of the path resampled at 50 mm
    // steps.
    {"bending_rad2_per_m", Aggregate::Mean, 2},
    // The share of the strip before its via point, |P^j - P^{j-1}| / (|P^j - P^{j-1}| + |P^{j+1} -
    // P^j|), over the ticks with an external force. The papers say that K_c keeps it.
    {"strip_share", Aggregate::Mean, 3},
    {"strip_share_deviation", Aggregate::Mean, 3},  // standard deviation within a run
    {"internal_force_m", Aggregate::Largest, 3},    // the largest |F_int|
};

class Path final : public Judge {
 public:
  explicit Path(const JudgedRun& run)
      : safety_distance_(run.spec.parameters[algo::kSafetyDistance]),
        radius_(run.robot.radius),
        period_(run.robot.period) {}

  void see(const algo::Telemetry& t) override {
    if (!t.ground_truth) return;
    const double clearance = t.ground_truth->obstacle_distance - radius_;
    body_depth_ = std::max(body_depth_, safety_distance_ - clearance);
    // A tick counts the time since the last one; at the start there is none.
    if (kept_W_ && clearance < safety_distance_) body_infringed_ += period_;
    follow(t.ground_truth->pose.position());
    follow_strip(t.output);
  }

  void write(std::span<double> row) const override {
    row[0] = body_infringed_;
    row[1] = body_depth_;
    row[2] = bending_;
    row[3] = share_mean_;
    row[4] = shares_ > 1 ? std::sqrt(squares_ / (shares_ - 1)) : 0;
    row[5] = largest_internal_;
  }

 private:
  void follow(const algo::Vec2& position_W) {
    if (!kept_W_) {
      kept_W_ = position_W;
      return;
    }
    const algo::Vec2 segment = position_W - *kept_W_;
    const double length = segment.norm();
    if (length < kResample) return;
    const double direction = std::atan2(segment.y(), segment.x());
    if (direction_) {
      const double change = algo::wrap_angle(direction - *direction_);
      bending_ += change * change / length;
    }
    direction_ = direction;
    kept_W_ = position_W;
  }

  void follow_strip(const algo::ControlOutput& output) {
    const auto measure = [&](std::string_view name) { return output.measure(name).value_or(0); };
    largest_internal_ = std::max(largest_internal_, measure("strip.internal"));
    const std::optional<double> share = output.measure("strip.share");
    const bool pushed = measure("strip.left") + measure("strip.right") > 0;
    if (!share || !pushed) return;
    shares_ += 1;
    const double off = *share - share_mean_;
    share_mean_ += off / shares_;
    squares_ += off * (*share - share_mean_);
  }

  double safety_distance_ = 0;  // [m]
  double radius_ = 0;           // [m]
  double period_ = 0;           // [s]
  double body_infringed_ = 0;   // [s]
  double body_depth_ = 0;       // [m]
  double bending_ = 0;          // [rad2/m]
  std::optional<algo::Vec2> kept_W_{};
  std::optional<double> direction_{};  // [rad] of the last kept segment
  double shares_ = 0;                  // count
  double share_mean_ = 0;
  double squares_ = 0;           // sum of squared deviations (Welford)
  double largest_internal_ = 0;  // [m]
};

}  // namespace

JudgeInfo path() {
  return {.help = "Circle about the hull, bending, and what the strip does along the way",
          .columns = kPathColumns,
          .make = make_judge<Path>};
}

}  // namespace server::experiment::judges
