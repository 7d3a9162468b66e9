// server/experiment/judges/place.cpp: the true place where a run ends.
#include <limits>

#include "server/experiment/judge.hpp"

namespace server::experiment::judges {
namespace {

constexpr Column kPlaceColumns[] = {{"end_x_m"}, {"end_y_m"}, {"end_heading_rad"}};

class Place final : public Judge {
 public:
  explicit Place(const JudgedRun& /*run*/) {}

  void see(const algo::Telemetry& t) override {
    if (t.ground_truth) end_W_ = t.ground_truth->pose;
  }

  void write(std::span<double> row) const override {
    row[0] = end_W_.x;
    row[1] = end_W_.y;
    row[2] = end_W_.heading;
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  algo::Pose2 end_W_{kUnknown, kUnknown, kUnknown};
};

}  // namespace

JudgeInfo place() {
  return {.help = "The true pose in which the run ends",
          .columns = kPlaceColumns,
          .make = make_judge<Place>};
}

}  // namespace server::experiment::judges
