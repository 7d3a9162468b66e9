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

namespace tautline::wire {
struct LayerInfo;
struct LayerMore;
struct News;
}  // namespace tautline::wire

namespace server {

/// Of one metre. Nobody sees less than a millimetre, and the record would keep it at twice the
/// size.
constexpr float kSteps = 1024;

/// To the next step, the even one of two equally near, as nearbyint() gives it but many at once.
inline float rounded(float value) {
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
    Offset<flatbuffers::Vector<std::int16_t>> narrow{};
    Offset<flatbuffers::Vector<float>> wide{};  // where a value does not fit into the other
    Tables<tautline::wire::LayerMore> more{};
  };

  /// None when nothing is new.
  Offset<tautline::wire::News> write_news(Builder& b, const algo::Telemetry& t);
  Shown write_shown(Builder& b, const algo::Telemetry& t);

 private:
  Tables<tautline::wire::LayerInfo> write_legend(Builder& b, const algo::Telemetry& t);
  Tables<tautline::wire::LayerMore> write_more(Builder& b, const algo::Telemetry& t);

  std::vector<Offset<tautline::wire::LayerInfo>> infos_{};
  std::vector<Offset<tautline::wire::LayerMore>> more_{};
  std::string lines_{};  // workspace, as the next two
  std::vector<float> scratch_{};
  std::vector<std::int16_t> narrow_{};
};

}  // namespace server
