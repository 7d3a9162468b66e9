// server/experiment/judges/backing.cpp: how far and how often a robot drives backwards.
#include <optional>

#include "server/experiment/judge.hpp"

namespace server::experiment::judges {
namespace {

constexpr double kSpell = 0.05;  // [m] backwards without a break, to count as one spell

constexpr Column kBackingColumns[] = {{"backing_m", Aggregate::Mean, 2},
                                      {"backing_spells", Aggregate::Mean, 1}};

class Backing final : public Judge {
 public:
  explicit Backing(const JudgedRun& /*run*/) {}

  void see(const algo::Telemetry& t) override {
    if (!t.ground_truth) return;
    const algo::Pose2& pose = t.ground_truth->pose;
    if (last_W_) {
      const algo::Vec2 step_W = pose.position() - last_W_->position();
      const double ahead = step_W.dot(algo::direction(last_W_->heading));
      const double before = spell_;
      spell_ = ahead < 0 ? spell_ - ahead : 0;
      if (ahead < 0) length_ -= ahead;
      if (before < kSpell && spell_ >= kSpell) spells_ += 1;
    }
    last_W_ = pose;
  }

  void write(std::span<double> row) const override {
    row[0] = length_;
    row[1] = spells_;
  }

 private:
  std::optional<algo::Pose2> last_W_{};
  double length_ = 0;  // [m]
  double spell_ = 0;   // [m] of the current spell
  double spells_ = 0;  // count
};

}  // namespace

JudgeInfo backing() {
  return {.help = "How far and how often the robot drives backwards",
          .columns = kBackingColumns,
          .make = make_judge<Backing>};
}

}  // namespace server::experiment::judges
