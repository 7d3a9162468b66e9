// server/run/planning_thread.hpp: plans of a live robot's arm, made beside its control loop.
#pragma once

#include <future>
#include <vector>

#include "algo/arm/reach_thinker.hpp"

namespace server {

/// A thread for each question. The answer to one that was replaced is thrown away once it comes.
class PlanningThread final : public algo::ReachThinker {
 public:
  void ask(const algo::MobileArm& body, const algo::ReachQuestion& question) override;
  bool ready() override;
  algo::ReachPlan take() override;

 private:
  std::future<algo::ReachPlan> coming_{};
  std::vector<std::future<algo::ReachPlan>>
      abandoned_{};  // their ends would wait for their threads
};

}  // namespace server
