// algo/legend.cpp: compares entries by the addresses of their texts, and numbers them by content.
#include "algo/legend.hpp"

#include <bit>
#include <string_view>

namespace algo {
namespace {

/// Kind, frame, tone, style and axes in one number.
std::uint32_t look_of(const Layer& layer) {
  std::uint32_t look = static_cast<std::uint32_t>(layer.kind);
  look = look << 4 | static_cast<std::uint32_t>(layer.frame);
  look = look << 8 | static_cast<std::uint32_t>(layer.tone);
  look = look << 4 | static_cast<std::uint32_t>(layer.style);
  return look << 8 | layer.axes;
}

/// FNV-1a.
struct Digest {
  std::uint32_t value = 2166136261U;

  void add(std::uint8_t byte) { value = (value ^ byte) * 16777619U; }
  void add(std::string_view text) {
    for (const char c : text) add(static_cast<std::uint8_t>(c));
    add(std::uint8_t{0});
  }
  void add(std::uint32_t number) {
    for (int shift = 0; shift < 32; shift += 8) add(static_cast<std::uint8_t>(number >> shift));
  }
};

}  // namespace

/// Stores the entries of `t`; true if they equal the previous ones.
bool Legend::as_before(const Telemetry& t) {
  std::size_t count = 0;
  bool same = true;
  const auto take = [&](const Entry& entry) {
    if (count == entries_.size()) {
      entries_.push_back(entry);
      same = false;
    } else if (entries_[count] != entry) {
      entries_[count] = entry;
      same = false;
    }
    ++count;
  };
  for (const auto* list : {&t.layers, &t.output.layers}) {
    for (const Layer& layer : *list) {
      take({layer.name.data(), layer.label.data(), layer.unit.data(), look_of(layer), layer.level});
    }
  }
  for (const Measure& each : t.output.measures) {
    take({.name = each.name.data(), .unit = each.unit.data()});
  }
  same = same && count == entries_.size();
  entries_.resize(count);
  return same;
}

std::uint32_t Legend::of(const Telemetry& t) {
  if (as_before(t)) return number_;
  Digest digest;
  for (const auto* list : {&t.layers, &t.output.layers}) {
    for (const Layer& layer : *list) {
      for (const std::string_view text : {layer.name, layer.label, layer.unit}) digest.add(text);
      digest.add(look_of(layer));
      digest.add(std::bit_cast<std::uint32_t>(layer.level));
    }
  }
  digest.add(std::string_view{});  // the start of the measures
  for (const Measure& each : t.output.measures) {
    digest.add(each.name);
    digest.add(each.unit);
  }
  number_ = digest.value;
  return number_;
}

}  // namespace algo
