// algo/arm/reach_thinker.hpp: where a robot's plans are made: at once, or elsewhere meanwhile.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "algo/arm/reach_planner.hpp"

namespace algo {

class ReachThinker {
 public:
  virtual ~ReachThinker() = default;
  /// Takes a question; an earlier one is forgotten.
  virtual void ask(const MobileArm& body, const ReachQuestion& question) = 0;
  /// True if take() needs not wait.
  virtual bool ready() = 0;
  /// The answer to the newest question. Waits for it.
  virtual ReachPlan take() = 0;
};

/// Makes the plan when it is taken.
class LateThinker final : public ReachThinker {
 public:
  void ask(const MobileArm& body, const ReachQuestion& question) override {
    body_ = body;
    question_ = question;
  }
  bool ready() override { return true; }
  ReachPlan take() override { return answer(body_, question_); }

 private:
  MobileArm body_{};
  ReachQuestion question_{};
};

/// Makes the thinker of a pipeline; empty: a LateThinker.
using MakeThinker = std::function<std::unique_ptr<ReachThinker>()>;

}  // namespace algo
