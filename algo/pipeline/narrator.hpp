// algo/pipeline/narrator.hpp: decides when a tick needs new words, and keeps the newest.
#pragma once

#include <optional>

#include "algo/controller.hpp"
#include "algo/legend.hpp"
#include "algo/pipeline/arm_behaviour.hpp"

namespace algo {

class Narrator {
 public:
  void reset() {
    said_.reset();
    shown_at_.reset();
  }
  /// Fills t.words: new words if hold, limit, mission, behaviour or the controller's state has
  /// changed, else twice a second; otherwise the words of the previous tick. Fills t.legend, which
  /// is fresh when it has changed, and every two seconds.
  /// `by_ramps`: there are ramps, and no sensor tells them from walls.
  /// `arm` is null for a robot without one.
  void tell(const Controller& controller, const ArmBehaviour* arm, bool by_ramps, Telemetry& t);

 private:
  /// The facts that the words explain.
  struct Said {
    double stamp = 0;  // [s] run clock
    Hold hold{};
    Halt halt = Halt::None;
    Mission mission = Mission::Idle;
    Limit limit{};
    Name behaviour{};
    ArmState arm = ArmState::Rest;
    std::uint8_t state = 0;
    bool same_state(const Said& other) const;
  };
  void show_legend(Telemetry& t);

  std::optional<Said> said_{};
  Explanation words_{};
  Legend legend_{};
  std::uint32_t shown_ = 0;           // legend
  std::optional<double> shown_at_{};  // [s] run clock
};

}  // namespace algo
