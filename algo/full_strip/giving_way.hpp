// algo/full_strip/giving_way.hpp: the beam search decides while moving obstacles may cross.
#pragma once

#include <optional>

#include "algo/controller.hpp"
#include "algo/full_strip/space_time.hpp"
#include "algo/full_strip/strip_state.hpp"
#include "algo/full_strip/velocity_stage.hpp"

namespace algo {

/// The strip gives the direction, the search in space and time the command.
class GivingWay {
 public:
  void reset() { search_.reset(); }
  /// Nothing if no track may come near. `lead` [s]: see SpaceTimeInput.
  std::optional<StripCommand> next(const StageInput& stage,
                                   const HullCheck& hull,
                                   const Tracker& tracker,
                                   const ControlInput& in,
                                   double lead,
                                   Weighing& out);

 private:
  SpaceTimeSearch search_{};
};

}  // namespace algo
