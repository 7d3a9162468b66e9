// server/experiment/judges/path.cpp: the papers' path measures beyond algo/metrics.hpp.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "algo/driving.hpp"
#include "algo/metrics.hpp"
#include "server/experiment/judge.hpp"

namespace server::experiment::judges {
namespace {

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
    if (path_.begun() && clearance < safety_distance_) body_infringed_ += period_;
    if (const auto bend = path_.add(t.ground_truth->pose.position())) {
      bending_ += bend->change * bend->change / bend->length;
    }
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
  algo::ResampledPath path_{};
  double shares_ = 0;  // count
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
