// server/record/layers_writer.cpp: values in each frame, the words for them now and then.
#include "server/record/layers_writer.hpp"

#include <algorithm>
#include <string_view>

#include "telemetry_generated.h"

namespace server {
namespace {

namespace fb = tautline::wire;

// Of a layer; a multiple of the numbers of any position, arrow or circle.
constexpr std::size_t kMostValues = 65532;
// Points from which on a line is coded as differences; of a shorter one each value follows its own
// of the tick before better.
constexpr std::uint32_t kLongLine = 8;

template <typename Visit>
void each_layer(const algo::Telemetry& t, const Visit& visit) {
  for (const auto* list : {&t.layers, &t.output.layers}) {
    for (const algo::Layer& layer : *list) visit(layer);
  }
}

std::size_t count_of(const algo::Layer& layer) {
  return std::min(layer.values.size(), kMostValues);
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

LayersWriter::Shown LayersWriter::write_shown(Builder& b, const algo::Telemetry& t) {
  Shown out;
  more_.clear();
  std::uint16_t index = 0;
  std::size_t values = t.output.measures.size();
  each_layer(t, [&](const algo::Layer& layer) {
    values += count_of(layer);
    if (!layer.empty() && (!layer.cells.empty() || !layer.text.empty())) {
      const auto cells = layer.cells.empty() ? 0 : b.CreateVector(layer.cells);
      more_.push_back(fb::CreateLayerMore(b, index, cells, write_text(b, layer.text)));
    }
    ++index;
  });
  if (!more_.empty()) out.more = b.CreateVector(more_);

  float* first = nullptr;
  out.values = b.CreateUninitializedVector(values, &first);
  float* value = first;
  each_layer(t, [&](const algo::Layer& layer) {
    value = std::copy_n(layer.values.data(), count_of(layer), value);
  });
  for (const algo::Measure& each : t.output.measures) *value++ = static_cast<float>(each.value);
  std::transform(first, value, first, rounded);  // all in one go: in vectors
  std::uint16_t* count = nullptr;
  out.counts = b.CreateUninitializedVector(index, &count);
  each_layer(
      t, [&](const algo::Layer& layer) { *count++ = static_cast<std::uint16_t>(count_of(layer)); });
  return out;
}

void LayersWriter::add_windows(const algo::Telemetry& t,
                               std::uint32_t values_offset,
                               std::vector<db::Window>& windows) const {
  std::uint32_t first = 0;
  each_layer(t, [&](const algo::Layer& layer) {
    const auto count = static_cast<std::uint32_t>(count_of(layer));
    const std::uint32_t axes = layer.axes;
    const bool line = layer.kind == algo::LayerKind::Polyline && count >= kLongLine * axes;
    if (line && windows.size() < db::kMaxFrameWindows) {
      windows.push_back({.offset = values_offset + first * std::uint32_t{sizeof(float)},
                         .count = count - count % axes,
                         .kind = db::Window::Kind::Floats,
                         .stride = axes});
    }
    first += count;
  });
}

}  // namespace server
