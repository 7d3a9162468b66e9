// server/record/layers_block.hpp: the layers and measures of a frame, written with little work from
// tick to tick.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <flatbuffers/flatbuffers.h>

#include "algo/telemetry.hpp"

namespace tautline::wire {
struct Layer;
struct Measures;
}  // namespace tautline::wire

namespace server {

/// What only people look at: nobody sees less than a millimetre, and the record would keep it at
/// twice the size.
inline float rounded(float value) {
  constexpr float kSteps = 1024;
  constexpr float kMost = 0x1p20F;  // beyond it a float resolves little more
  if (!(std::abs(value) < kMost)) return value;
  return static_cast<float>(std::lrint(value * kSteps)) / kSteps;
}

/// Names, labels and the tables round them are mostly those of the tick before: the bytes made for
/// that are kept, and only values are written anew. What comes out does not depend on what was
/// written before.
class LayersBlock {
 public:
  using Layers =
      flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<tautline::wire::Layer>>>;
  struct Written {
    Layers layers{};
    flatbuffers::Offset<tautline::wire::Measures> measures{};
  };

  /// Into `b`. Those of the pipeline come first; a layer that has nothing to show is left out.
  Written write(flatbuffers::FlatBufferBuilder& b, const algo::Telemetry& t);
  static constexpr std::size_t kAlignment = sizeof(double);

 private:
  using Builder = flatbuffers::FlatBufferBuilder;
  /// All of a layer that its bytes depend on but its values. Texts of one name lie in one place.
  struct Form {
    const char* name = nullptr;
    const char* label = nullptr;
    const char* unit = nullptr;
    algo::LayerKind kind{};
    algo::LayerFrame frame{};
    algo::Tone tone{};
    algo::LayerStyle style{};
    std::uint8_t axes = 0;
    float level = 0;
    std::size_t values = 0;
    bool operator==(const Form&) const = default;
  };
  static Form form_of(const algo::Layer& layer);

  bool collect(const algo::Telemetry& t);
  bool as_before(const algo::Telemetry& t);
  Written build(Builder& b, const algo::Telemetry& t);
  flatbuffers::Offset<tautline::wire::Layer> build_layer(Builder& b, const algo::Layer& layer);
  flatbuffers::Offset<tautline::wire::Measures> build_measures(
      Builder& b, const algo::Recycled<algo::Measure>& measures);
  void fill(Builder& b, const algo::Telemetry& t) const;

  std::vector<const algo::Layer*> shown_{};  // in this tick
  std::vector<flatbuffers::Offset<tautline::wire::Layer>> tables_{};
  // Of the kept bytes, or of what was last built: where values lie, from the end of the buffer.
  std::vector<flatbuffers::uoffset_t> values_{};
  flatbuffers::uoffset_t measured_ = 0;
  std::vector<Form> forms_{};
  std::vector<const char*> names_{};  // of the measures
  std::string lines_{};               // workspace
  Builder block_{512};
  Written kept_{};
};

}  // namespace server
