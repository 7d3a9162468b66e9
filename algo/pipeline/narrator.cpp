// algo/pipeline/narrator.cpp: makes words twice a second, not forty times.
#include "algo/pipeline/narrator.hpp"

#include <string_view>

#include "algo/explain.hpp"

namespace algo {
namespace {

constexpr double kNarrationPeriod = 0.5;  // [s]
constexpr double kLegendPeriod = 2.0;     // [s] longest wait of a viewer who missed a frame
constexpr std::string_view kRamps = " A scanner that looks level sees a ramp as a wall.";
// Room for the longest words, so that words longer than all before do not allocate.
constexpr std::size_t kLongestWhat = 60;
constexpr std::size_t kLongestWhy = 350;

void make_room(Explanation& words) {
  words.what.reserve(kLongestWhat);
  words.why.reserve(kLongestWhy);
}

}  // namespace

bool Narrator::Said::same_state(const Said& other) const {
  return hold == other.hold && halt == other.halt && limit == other.limit &&
         mission == other.mission && behaviour == other.behaviour && arm == other.arm &&
         state == other.state;
}

void Narrator::tell(const Controller& controller,
                    const ArmBehaviour* arm,
                    bool by_ramps,
                    Telemetry& t) {
  show_legend(t);
  const Said now{.stamp = t.observation.stamp,
                 .hold = t.hold,
                 .halt = t.observation.halt,
                 .mission = t.mission,
                 .limit = t.limit,
                 .behaviour = t.behaviour,
                 .arm = t.arm.state,
                 .state = t.output.state};
  // Written so that a NaN stamp makes new words.
  t.words_fresh =
      !said_ || !now.same_state(*said_) || !(now.stamp - said_->stamp < kNarrationPeriod);
  make_room(t.words);
  if (t.words_fresh) {
    make_room(words_);
    explain(t, controller, words_);
    if (arm != nullptr && !t.hold && t.behaviour != behaviours::kAvoid &&
        t.behaviour != behaviours::kManual) {
      arm->explain(t, words_);
    }
    if (by_ramps && t.mission == Mission::Stuck && !t.hold) words_.why += kRamps;
    said_ = now;
  }
  t.words = words_;
}

void Narrator::show_legend(Telemetry& t) {
  t.legend = legend_.of(t);
  const double now = t.observation.stamp;
  t.legend_fresh = !shown_at_ || t.legend != shown_ || !(now - *shown_at_ < kLegendPeriod);
  if (!t.legend_fresh) return;
  shown_ = t.legend;
  shown_at_ = now;
}

}  // namespace algo
