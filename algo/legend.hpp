// algo/legend.hpp: which layers and measures a tick has, as one number: viewers are told names,
// labels and kinds only when it changes.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/telemetry.hpp"

namespace algo {

/// Remembers the tick before, so that the same legend costs a comparison.
class Legend {
 public:
  /// The same number for the same names, labels, units, kinds, frames, tones, styles, axes and
  /// levels in the same order, in every program; those of layers that are empty count too. Values,
  /// cells and texts do not.
  std::uint32_t of(const Telemetry& t);

 private:
  /// Texts of one description lie in one place.
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
