// server/record/layers_writer.cpp: writes values into each frame, and their names only now and
// then.
#include "server/record/layers_writer.hpp"

#include <algorithm>
#include <bit>
#include <string_view>

#include "telemetry_generated.h"

#include "algo/wide.hpp"

namespace server {
namespace {

namespace fb = tautline::wire;

// Most values of a layer; a multiple of the count per position, per arrow and per circle.
constexpr std::size_t kMostValues = 65532;
constexpr float kMostNarrow = 32767;
constexpr std::uint32_t kNoNumber = 0x8000;  // -32768
// A float this large has no fraction. A smaller number added to it is rounded to the nearest whole
// number, ties to even, and stands in its last bits.
constexpr float kBase = 0x1.8p23F;

template <typename Visit>
void each_layer(const algo::Telemetry& t, const Visit& visit) {
  for (const auto* list : {&t.layers, &t.output.layers}) {
    for (const algo::Layer& layer : *list) visit(layer);
  }
}

std::size_t count_of(const algo::Layer& layer) {
  return std::min(layer.values.size(), kMostValues);
}

/// Writes `count` values as 16 bits each.
/// @return true if every value fits
TAUTLINE_WIDE bool write_narrow(const float* values,
                                std::size_t count,
                                std::int16_t* __restrict out) {
  std::uint32_t too_large = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float steps = values[i] * kSteps;
    too_large |= std::abs(steps) > kMostNarrow ? 1U : 0U;
    const std::uint32_t whole =
        std::bit_cast<std::uint32_t>(steps + kBase) - std::bit_cast<std::uint32_t>(kBase);
    out[i] = static_cast<std::int16_t>(steps == steps ? whole : kNoNumber);  // NaN: kNoNumber
  }
  return too_large == 0;
}

flatbuffers::Offset<flatbuffers::String> write_text(flatbuffers::FlatBufferBuilder& b,
                                                    std::string_view text) {
  return text.empty() ? 0 : b.CreateString(text.data(), text.size());
}

}  // namespace

LayersWriter::Tables<fb::LayerInfo> LayersWriter::write_legend(Builder& b,
                                                               const algo::Telemetry& t) {
  infos_.clear();
  each_layer(t, [&](const algo::Layer& layer) {
    const auto name = write_text(b, layer.name);
    const auto label = write_text(b, layer.label);
    const auto unit = write_text(b, layer.unit);
    infos_.push_back(fb::CreateLayerInfo(b,
                                         name,
                                         label,
                                         unit,
                                         static_cast<fb::LayerKind>(layer.kind),
                                         static_cast<fb::LayerFrame>(layer.frame),
                                         static_cast<fb::Tone>(layer.tone),
                                         static_cast<fb::LayerStyle>(layer.style),
                                         layer.axes,
                                         layer.level));
  });
  return b.CreateVector(infos_);
}

LayersWriter::Offset<fb::News> LayersWriter::write_news(Builder& b, const algo::Telemetry& t) {
  if (!t.words_fresh && !t.legend_fresh) return 0;
  const auto what = t.words_fresh ? write_text(b, t.words.what) : 0;
  const auto why = t.words_fresh ? write_text(b, t.words.why) : 0;
  if (!t.legend_fresh) return fb::CreateNews(b, what, why);
  const auto layers = write_legend(b, t);
  const auto write_lines = [&](std::string_view algo::Measure::*text) {
    lines_.clear();
    for (const algo::Measure& each : t.output.measures) {
      if (&each != t.output.measures.begin()) lines_ += '\n';
      lines_ += each.*text;
    }
    return write_text(b, lines_);
  };
  const auto names = write_lines(&algo::Measure::name);
  const auto units = write_lines(&algo::Measure::unit);
  return fb::CreateNews(b, what, why, layers, names, units);
}

LayersWriter::Tables<fb::LayerMore> LayersWriter::write_more(Builder& b, const algo::Telemetry& t) {
  more_.clear();
  std::uint16_t index = 0;
  each_layer(t, [&](const algo::Layer& layer) {
    if (!layer.empty() && (!layer.cells.empty() || !layer.text.empty())) {
      const auto cells = layer.cells.empty() ? 0 : b.CreateVector(layer.cells);
      more_.push_back(fb::CreateLayerMore(b, index, cells, write_text(b, layer.text)));
    }
    ++index;
  });
  return more_.empty() ? 0 : b.CreateVector(more_);
}

LayersWriter::Shown LayersWriter::write_shown(Builder& b, const algo::Telemetry& t) {
  Shown out{.more = write_more(b, t)};
  std::size_t size = t.output.measures.size();
  each_layer(t, [&](const algo::Layer& layer) { size += 1 + count_of(layer); });
  scratch_.resize(size);
  float* next = scratch_.data();
  each_layer(t, [&](const algo::Layer& layer) {
    const std::size_t count = count_of(layer);
    *next++ = static_cast<float>(count) / kSteps;
    next = std::copy_n(layer.values.data(), count, next);
  });
  for (const algo::Measure& each : t.output.measures) *next++ = static_cast<float>(each.value);

  narrow_.resize(size);
  if (write_narrow(scratch_.data(), size, narrow_.data())) {
    out.narrow = b.CreateVector(narrow_);
    return out;
  }
  float* wide = nullptr;
  out.wide = b.CreateUninitializedVector(size, &wide);
  std::ranges::transform(scratch_, wide, rounded);
  each_layer(t, [&](const algo::Layer& layer) {
    *wide *= kSteps;  // a count of values, not metres
    wide += 1 + count_of(layer);
  });
  return out;
}

}  // namespace server
