// server/external/answer_reader.cpp: checks every byte that a controller sends.
#include <algorithm>
#include <cmath>

#include "controller_generated.h"
#include <fmt/format.h>

#include "server/external/messages.hpp"

namespace server::external {
namespace {

namespace fb = tautline::external;

static_assert(static_cast<int>(algo::LayerKind::Text) == fb::LayerKind_MAX);
static_assert(static_cast<int>(algo::Tone::Good) == fb::Tone_MAX);
static_assert(static_cast<int>(algo::LayerStyle::Faint) == fb::LayerStyle_MAX);

/// The bytes must begin at a multiple of eight, as a vector's do.
const fb::Message& read_message(std::span<const std::byte> bytes) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  flatbuffers::Verifier verifier(data, bytes.size());
  if (bytes.size() < 2 * kPrefix ||
      flatbuffers::ReadScalar<std::uint32_t>(data) != bytes.size() - kPrefix ||
      !fb::VerifySizePrefixedMessageBuffer(verifier)) {
    throw ControllerError("It sent bytes that are no message of controller.fbs.");
  }
  return *fb::GetSizePrefixedMessage(data);
}

std::string_view text_of(const flatbuffers::String* text) {
  return text == nullptr ? std::string_view() : text->string_view();
}

/// A sentence for people, of at most kMostLetters bytes.
void read_sentence(const flatbuffers::String* text, std::string& out) {
  const std::string_view given = text_of(text);
  if (given.size() > kMostLetters) {
    throw ControllerError(fmt::format(
        "It sent a sentence of {} bytes; at most {} are allowed.", given.size(), kMostLetters));
  }
  out.assign(given);
}

/// `now` if it is `text` already, else a kept copy.
void read_text(const flatbuffers::String* text, Texts& texts, std::string_view& now) {
  const std::string_view given = text_of(text);
  if (now != given || now.empty()) now = texts.keep(given);
}

template <typename T>
void check_enum(T value, T max, const char* what) {
  if (value > max) throw ControllerError(fmt::format("It sent a layer of an unknown {}.", what));
}

template <typename Wire, typename T>
void read_list(const flatbuffers::Vector<Wire>* list, std::size_t most, std::vector<T>& out) {
  out.clear();
  if (list == nullptr) return;
  if (list->size() > most) {
    throw ControllerError(
        fmt::format("It sent a layer of {} values; at most {} are allowed.", list->size(), most));
  }
  if (reinterpret_cast<std::uintptr_t>(list->Data()) % alignof(T) != 0) {
    throw ControllerError("It sent a layer whose values are not aligned.");
  }
  out.assign(list->begin(), list->end());
}

/// Numbers per item of a layer.
std::size_t stride(const algo::Layer& layer) {
  switch (layer.kind) {
    case algo::LayerKind::Arrows:
      return std::size_t{2} * layer.axes;
    case algo::LayerKind::Circles:
      return std::size_t{1} + layer.axes;
    case algo::LayerKind::Arcs:
      return 2;
    case algo::LayerKind::Grid:
      return 4;
    case algo::LayerKind::Polar:
      return 1;
    default:
      return layer.axes;
  }
}

void check_shape(const algo::Layer& layer) {
  if (layer.values.size() % stride(layer) != 0) {
    throw ControllerError(
        fmt::format("It sent {} values in the layer '{}', which do not make whole items.",
                    layer.values.size(),
                    layer.name));
  }
  if (layer.kind != algo::LayerKind::Grid || layer.empty()) return;
  const float columns = layer.values[3];
  const bool whole =
      columns >= 1 && columns <= static_cast<float>(kMostCells) && columns == std::floor(columns);
  if (layer.values.size() != 4 || !whole ||
      layer.cells.size() % static_cast<std::size_t>(columns) != 0) {
    throw ControllerError(
        fmt::format("It sent the grid '{}', whose cells do not fill its columns.", layer.name));
  }
}

/// Rates of all joints of an arm, or none.
void read_joint_rates(const flatbuffers::Vector<double>* rates, algo::ControlOutput& out) {
  if (rates == nullptr) return;
  algo::JointValues& values = out.joint_rates.emplace();
  if (rates->size() != values.size()) {
    throw ControllerError(
        fmt::format("It commanded {} joints; an arm has {}.", rates->size(), values.size()));
  }
  if (reinterpret_cast<std::uintptr_t>(rates->Data()) % alignof(double) != 0) {
    throw ControllerError("It commanded joints by numbers that are not aligned.");
  }
  std::ranges::copy(*rates, values.begin());
}

void read_layer(const fb::Layer& in, Texts& texts, algo::Layer& layer) {
  read_text(in.name(), texts, layer.name);
  if (layer.name.empty()) throw ControllerError("It sent a layer without a name.");
  read_text(in.label() == nullptr ? in.name() : in.label(), texts, layer.label);
  read_text(in.unit(), texts, layer.unit);
  check_enum(in.kind(), fb::LayerKind_MAX, "kind");
  check_enum(in.frame(), fb::LayerFrame_MAX, "frame");
  check_enum(in.tone(), fb::Tone_MAX, "tone");
  check_enum(in.style(), fb::LayerStyle_MAX, "style");
  if (in.axes() != 2 && in.axes() != 3) {
    throw ControllerError("It sent a layer whose positions have neither 2 nor 3 axes.");
  }
  layer.kind = static_cast<algo::LayerKind>(in.kind());
  layer.frame = static_cast<algo::LayerFrame>(in.frame());
  layer.tone = static_cast<algo::Tone>(in.tone());
  layer.style = static_cast<algo::LayerStyle>(in.style());
  layer.axes = in.axes();
  layer.level = in.level();
  read_list(in.values(), kMostValues, layer.values);
  read_list(in.cells(), kMostCells, layer.cells);
  read_sentence(in.text(), layer.text);
  check_shape(layer);
}

template <typename List>
void check_count(const List* list, std::size_t most, const char* what) {
  if (list != nullptr && list->size() > most) {
    throw ControllerError(
        fmt::format("It sent {} {}; at most {} are allowed.", list->size(), what, most));
  }
}

void read_shown(const fb::Command& in, Texts& texts, algo::ControlOutput& out) {
  check_count(in.layers(), kMostLayers, "layers");
  check_count(in.measures(), kMostMeasures, "measures");
  if (in.layers() != nullptr) {
    for (const fb::Layer* layer : *in.layers()) read_layer(*layer, texts, out.layers.append());
  }
  if (in.measures() == nullptr) return;
  for (const fb::Measure* each : *in.measures()) {
    algo::Measure& measure = out.measures.append();
    read_text(each->name(), texts, measure.name);
    read_text(each->unit(), texts, measure.unit);
    if (measure.name.empty()) throw ControllerError("It sent a measure without a name.");
    measure.value = each->value();
  }
}

}  // namespace

void check_speeds(const algo::ControlOutput& out) {
  const auto good = [](double rate) { return std::isfinite(rate); };
  if (algo::finite(out.twist) &&
      (!out.joint_rates || std::ranges::all_of(*out.joint_rates, good))) {
    return;
  }
  throw ControllerError("It commanded a speed that is not a finite number.");
}

Hello read_hello(std::span<const std::byte> message) {
  const fb::Hello* hello = read_message(message).body_as_Hello();
  if (hello == nullptr) throw ControllerError("It did not begin with a Hello.");
  return {hello->version(), std::string(text_of(hello->token()))};
}

void read_answer(std::span<const std::byte> message,
                 std::uint64_t tick,
                 Texts& texts,
                 algo::ControlOutput& out,
                 algo::Explanation& words) {
  const fb::Command* command = read_message(message).body_as_Command();
  if (command == nullptr) throw ControllerError("It sent a message that is no Command.");
  if (command->failure() != nullptr) {
    std::string sentence;
    read_sentence(command->failure(), sentence);
    throw ControllerError("It gave up: " + sentence);
  }
  if (command->tick() != tick) {
    throw ControllerError(
        fmt::format("It answered tick {} where tick {} was asked.", command->tick(), tick));
  }
  if (command->twist() == nullptr) throw ControllerError("It sent a Command without a twist.");
  out.twist = {command->twist()->v(), command->twist()->omega()};
  read_joint_rates(command->joint_rates(), out);
  check_speeds(out);
  out.waits = command->waits();
  out.state = command->state();
  read_sentence(command->what(), words.what);
  read_sentence(command->why(), words.why);
  read_shown(*command, texts, out);
}

}  // namespace server::external
