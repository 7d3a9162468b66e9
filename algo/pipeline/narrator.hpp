// algo/pipeline/narrator.hpp: when a tick is worth new words, and the newest of them.
#pragma once

#include <optional>

#include "algo/controller.hpp"
#include "algo/legend.hpp"

namespace algo {

class Narrator {
 public:
  void reset() {
    said_.reset();
    shown_at_.reset();
  }
  /// Fills t.words: anew when hold, limit, mission, behaviour or the controller's state has
  /// changed, else twice a second; the same as in the tick before otherwise. Fills t.legend, which
  /// is fresh when it has changed, and every two seconds.
  void tell(const Controller& controller, Telemetry& t);

 private:
  /// What the words were about.
  struct Said {
    double stamp = 0;  // [s] run clock
    Hold hold{};
    Halt halt = Halt::None;
    Mission mission = Mission::Idle;
    Limit limit{};
    Name behaviour{};
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
