// algo/pipeline/narrator.hpp: when a tick is worth new words, and the newest of them.
#pragma once

#include <optional>

#include "algo/controller.hpp"

namespace algo {

class Narrator {
 public:
  void reset() { said_.reset(); }
  /// Fills t.words: anew when hold, mission, behaviour or the controller's state has changed, else
  /// twice a second; the same as in the tick before otherwise.
  void tell(const Controller& controller, Telemetry& t);

 private:
  /// What the words were about.
  struct Said {
    double stamp = 0;  // [s] run clock
    Hold hold = Hold::None;
    Halt halt = Halt::None;
    Mission mission = Mission::Idle;
    BehaviourId behaviour = BehaviourId::Rest;
    std::uint8_t state = 0;
    bool same_state(const Said& other) const;
  };
  std::optional<Said> said_{};
  Explanation words_{};
};

}  // namespace algo
