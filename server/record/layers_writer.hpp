// server/record/layers_writer.hpp: what is shown of a tick: its news, and the values of its layers
// and measures.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <flatbuffers/flatbuffers.h>

#include "algo/telemetry.hpp"
#include "db/block_codec.hpp"

namespace tautline::wire {
struct LayerInfo;
struct LayerMore;
struct News;
}  // namespace tautline::wire

namespace server {

/// What only people look at: nobody sees less than a millimetre, and the record would keep it at
/// twice the size. To the next even one of two equally near, as lrint() does, but many at once.
inline float rounded(float value) {
  constexpr float kSteps = 1024;
  constexpr float kWhole = 0x1p23F;  // from here on a float has no fraction
  const float steps = value * kSteps;
  const float push = std::copysign(kWhole, steps);  // leaves the fraction no room
  const float whole = (steps + push) - push;
  return std::abs(steps) < kWhole ? whole / kSteps : value;
}

/// Layers of the pipeline come first, then the controller's, in every list. Keeps its buffers. What
/// comes out does not depend on what was written before.
class LayersWriter {
 public:
  template <typename T>
  using Offset = flatbuffers::Offset<T>;
  using Builder = flatbuffers::FlatBufferBuilder;
  template <typename T>
  using Tables = Offset<flatbuffers::Vector<Offset<T>>>;

  struct Shown {
    Offset<flatbuffers::Vector<std::uint16_t>> counts{};
    Offset<flatbuffers::Vector<float>> values{};
    Tables<tautline::wire::LayerMore> more{};
  };

  /// Empty ones when they are not new, which are nevertheless there: a field that came and went
  /// would move all that follows the frame's own table.
  Offset<tautline::wire::News> write_news(Builder& b, const algo::Telemetry& t);
  Shown write_shown(Builder& b, const algo::Telemetry& t);
  /// Appends the long lines of the `t` that write_shown() wrote last, by where the finished frame
  /// has its values.
  void add_windows(const algo::Telemetry& t,
                   std::uint32_t values_offset,
                   std::vector<db::Window>& windows) const;

 private:
  Tables<tautline::wire::LayerInfo> write_legend(Builder& b, const algo::Telemetry& t);

  std::vector<Offset<tautline::wire::LayerInfo>> infos_{};
  std::vector<Offset<tautline::wire::LayerMore>> more_{};
  std::string lines_{};  // workspace
};

}  // namespace server
