// server/record/layers_block.cpp: built once for a set of layers, filled each tick.
#include "server/record/layers_block.hpp"

#include <string_view>

#include "telemetry_generated.h"

namespace server {
namespace {

namespace fb = tautline::wire;
template <typename T>
using Offset = flatbuffers::Offset<T>;

Offset<flatbuffers::String> write_text(flatbuffers::FlatBufferBuilder& b, std::string_view text) {
  return text.empty() ? 0 : b.CreateString(text.data(), text.size());
}

/// A vector to be filled.
flatbuffers::uoffset_t make_room(flatbuffers::FlatBufferBuilder& b, std::size_t values) {
  float* unused = nullptr;
  return b.CreateUninitializedVector(values, &unused).o;
}

}  // namespace

LayersBlock::Form LayersBlock::form_of(const algo::Layer& layer) {
  return {layer.name.data(),
          layer.label.data(),
          layer.unit.data(),
          layer.kind,
          layer.frame,
          layer.tone,
          layer.style,
          layer.axes,
          layer.level,
          layer.values.size()};
}

/// Finds the layers of the tick that have something to show. True when values are all they have.
bool LayersBlock::collect(const algo::Telemetry& t) {
  shown_.clear();
  bool plain = true;
  for (const auto* list : {&t.layers, &t.output.layers}) {
    for (const algo::Layer& layer : *list) {
      if (layer.empty()) continue;
      plain = plain && layer.cells.empty() && layer.text.empty();
      shown_.push_back(&layer);
    }
  }
  return plain;
}

/// Whether the kept bytes are of such layers and measures; takes these for the next time.
bool LayersBlock::as_before(const algo::Telemetry& t) {
  const algo::Recycled<algo::Measure>& measures = t.output.measures;
  bool same = forms_.size() == shown_.size() && names_.size() == measures.size();
  forms_.resize(shown_.size());
  names_.resize(measures.size());
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const Form form = form_of(*shown_[i]);
    same = same && forms_[i] == form;
    forms_[i] = form;
  }
  for (std::size_t i = 0; i < measures.size(); ++i) {
    same = same && names_[i] == measures[i].name.data();
    names_[i] = measures[i].name.data();
  }
  return same;
}

Offset<fb::Layer> LayersBlock::build_layer(Builder& b, const algo::Layer& layer) {
  const auto name = write_text(b, layer.name);
  const auto label = write_text(b, layer.label);
  const auto unit = write_text(b, layer.unit);
  const auto text = write_text(b, layer.text);
  const auto cells = layer.cells.empty() ? 0 : b.CreateVector(layer.cells);
  values_.push_back(make_room(b, layer.values.size()));
  fb::LayerBuilder out(b);
  out.add_name(name);
  out.add_values(values_.back());
  out.add_label(label);
  out.add_unit(unit);
  out.add_text(text);
  out.add_cells(cells);
  out.add_level(layer.level);
  out.add_kind(static_cast<fb::LayerKind>(layer.kind));
  out.add_frame(static_cast<fb::LayerFrame>(layer.frame));
  out.add_tone(static_cast<fb::Tone>(layer.tone));
  out.add_style(static_cast<fb::LayerStyle>(layer.style));
  out.add_axes(layer.axes);
  return out.Finish();
}

Offset<fb::Measures> LayersBlock::build_measures(Builder& b,
                                                 const algo::Recycled<algo::Measure>& measures) {
  measured_ = 0;
  if (measures.empty()) return 0;
  const auto write_lines = [&](std::string_view algo::Measure::*text) {
    lines_.clear();
    for (const algo::Measure& each : measures) {
      if (&each != measures.begin()) lines_ += '\n';
      lines_ += each.*text;
    }
    return b.CreateString(lines_);
  };
  const auto names = write_lines(&algo::Measure::name);
  const auto units = write_lines(&algo::Measure::unit);
  measured_ = make_room(b, measures.size());
  return fb::CreateMeasures(b, names, units, measured_);
}

LayersBlock::Written LayersBlock::build(Builder& b, const algo::Telemetry& t) {
  Written written;
  tables_.clear();
  values_.clear();
  for (const algo::Layer* layer : shown_) tables_.push_back(build_layer(b, *layer));
  if (!tables_.empty()) written.layers = b.CreateVector(tables_);
  written.measures = build_measures(b, t.output.measures);
  b.Align(kAlignment);
  return written;
}

void LayersBlock::fill(Builder& b, const algo::Telemetry& t) const {
  std::uint8_t* const end = b.GetCurrentBufferPointer() + b.GetSize();
  const auto place = [end](flatbuffers::uoffset_t vector) {
    return reinterpret_cast<float*>(end - vector + sizeof(flatbuffers::uoffset_t));
  };
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    float* out = place(values_[i]);
    for (const float value : shown_[i]->values) *out++ = rounded(value);
  }
  if (measured_ == 0) return;
  float* out = place(measured_);
  for (const algo::Measure& each : t.output.measures) {
    *out++ = rounded(static_cast<float>(each.value));
  }
}

LayersBlock::Written LayersBlock::write(Builder& b, const algo::Telemetry& t) {
  b.Align(kAlignment);
  const bool plain = collect(t);
  if (shown_.empty() && t.output.measures.empty()) return {};
  if (!plain) {  // a grid comes seldom and is large: not to be kept
    forms_.clear();
    names_.clear();
    const Written written = build(b, t);
    fill(b, t);
    return written;
  }
  if (!as_before(t)) {
    block_.Clear();
    kept_ = build(block_, t);
  }
  fill(block_, t);
  const flatbuffers::uoffset_t before = b.GetSize();
  b.PushBytes(block_.GetCurrentBufferPointer(), block_.GetSize());
  const auto moved = [before](auto offset) {
    return offset.IsNull() ? offset : decltype(offset)(before + offset.o);
  };
  return {moved(kept_.layers), moved(kept_.measures)};
}

}  // namespace server
