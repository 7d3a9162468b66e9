// server/experiment/judges/contact.cpp: whether a contact with a moving obstacle could have been
// avoided.
#include <deque>

#include "server/experiment/judge.hpp"
#include "server/experiment/oracle.hpp"

namespace server::experiment::judges {
namespace {

constexpr double kTrail = 4;  // [s] kept: a little more than the oracle goes back

constexpr Column kContactColumns[] = {{"contact", Aggregate::Largest, 0}};  // a Contact

class ContactJudge final : public Judge {
 public:
  explicit ContactJudge(const JudgedRun& run)
      : scenario_(run.spec.scenario),
        robot_(run.robot),
        moving_(algo::any_moves(scenario_.obstacles)) {}

  void see(const algo::Telemetry& t) override {
    if (!moving_ || !t.ground_truth || collided_) return;
    const double stamp = t.observation.stamp;
    trail_.push_back({stamp, t.ground_truth->pose, t.observation.odometry.twist});
    while (trail_.front().stamp < stamp - kTrail) trail_.pop_front();
    collided_ = t.ground_truth->collided;
  }

  void write(std::span<double> row) const override {
    const Contact contact = collided_
                                ? judge_contact(scenario_, robot_, {trail_.begin(), trail_.end()})
                                : Contact::None;
    row[0] = static_cast<double>(contact);
  }

 private:
  const sim::Scenario& scenario_;
  algo::RobotSpec robot_;
  bool moving_ = false;  // true if an obstacle in the world moves
  bool collided_ = false;
  std::deque<Moment> trail_{};
};

}  // namespace

JudgeInfo contact() {
  return {.help =
              "Whether a contact with something that moves could have been avoided: 0 none, "
              "1 avoidable, 2 not, 3 with an obstacle that had jumped",
          .columns = kContactColumns,
          .make = make_judge<ContactJudge>};
}

}  // namespace server::experiment::judges
