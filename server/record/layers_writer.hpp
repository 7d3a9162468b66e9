// server/record/layers_writer.hpp: writes the parts of a tick that viewers show: news, and the
// values of layers and measures.
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

/// Steps in one metre. Nobody sees less than a millimetre, and finer steps would double the
/// record's size.
constexpr float kSteps = 1024;

/// Rounds to the nearest step, ties to even, as nearbyint() does, but vectorises.
inline float rounded(float value) {
  constexpr float kWhole = 0x1p23F;  // from here on a float has no fraction
  const float steps = value * kSteps;
  const float push = std::copysign(kWhole, steps);  // leaves no bits for the fraction
  const float whole = (steps + push) - push;
  return std::abs(steps) < kWhole ? whole / kSteps : value;
}

/// Every list has the pipeline's layers first, then the controller's. Keeps its buffers. The output
/// does not depend on earlier calls.
class LayersWriter {
 public:
  template <typename T>
  using Offset = flatbuffers::Offset<T>;
  using Builder = flatbuffers::FlatBufferBuilder;
  template <typename T>
  using Tables = Offset<flatbuffers::Vector<Offset<T>>>;

  struct Shown {
    Offset<flatbuffers::Vector<std::int16_t>> narrow{};
    Offset<flatbuffers::Vector<float>> wide{};  // used if a value does not fit into `narrow`
    Tables<tautline::wire::LayerMore> more{};
  };

  /// Offset 0 when nothing is new.
  Offset<tautline::wire::News> write_news(Builder& b, const algo::Telemetry& t);
  Shown write_shown(Builder& b, const algo::Telemetry& t);

 private:
  Tables<tautline::wire::LayerInfo> write_legend(Builder& b, const algo::Telemetry& t);
  Tables<tautline::wire::LayerMore> write_more(Builder& b, const algo::Telemetry& t);

  std::vector<Offset<tautline::wire::LayerInfo>> infos_{};
  std::vector<Offset<tautline::wire::LayerMore>> more_{};
  std::string lines_{};  // workspace, like the next two
  std::vector<float> scratch_{};
  std::vector<std::int16_t> narrow_{};
};

}  // namespace server
