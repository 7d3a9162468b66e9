// db/sweeps.hpp: the windows of samples, foretold by the maps of earlier ones, in both directions.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "db/block_codec.hpp"
#include "db/block_format.hpp"
#include "db/motion_finder.hpp"
#include "db/range_map.hpp"

namespace db::detail {

/// The n-th sample windows of a block's frames share a map. Their residuals are sorted by how rough
/// their surroundings are, as rough ones are spread wider. Both directions learn the same from the
/// same samples. Keeps its buffers.
class Sweeps {
 public:
  /// A block begins.
  void clear();
  /// Appends the `which`-th sample window of a frame to the streams.
  void write(std::size_t which,
             std::span<const std::byte> samples,
             std::size_t per_half_turn,
             Streams& streams);
  /// Fills in what write() was given, in the same order. `motions` reads Stream kMotion.
  void read(std::size_t which,
            std::span<std::byte> samples,
            std::size_t per_half_turn,
            const Streams& streams,
            Cursor& motions);
  /// True when read() has used up what the streams hold.
  bool at_end(const Streams& streams) const;

 private:
  RangeMap& map(std::size_t which);

  std::vector<RangeMap> maps_{};
  MotionFinder finder_{};
  std::array<std::size_t, kClasses> read_{};  // residuals of each class
};

}  // namespace db::detail
