// algo/legend.hpp: a number that identifies the layers and measures of a tick. Viewers get names,
// labels and kinds only when it changes.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/telemetry.hpp"

namespace algo {

/// Remembers the previous tick, so that an unchanged legend costs one comparison.
class Legend {
 public:
  /// The same number, in every program, for the same names, labels, units, kinds, frames, tones,
  /// styles, axes and levels in the same order. Empty layers count too. Values, cells and texts do
  /// not.
  std::uint32_t of(const Telemetry& t);

 private:
  /// The texts of one description always have the same address.
  struct Entry {
    const char* name = nullptr;
    const char* label = nullptr;
    const char* unit = nullptr;
    std::uint32_t look = 0;
    float level = 0;
    bool operator==(const Entry&) const = default;
  };
  bool as_before(const Telemetry& t);

  std::vector<Entry> entries_{};
  std::uint32_t number_ = 0;
};

}  // namespace algo
