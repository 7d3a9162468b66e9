// server/record/frame_measures.cpp: reads the end of the values that viewers show.
#include "server/record/frame_measures.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "telemetry_generated.h"

#include "server/record/layers_writer.hpp"

namespace server {
namespace {

namespace fb = tautline::wire;

constexpr std::int16_t kNoNumber = -32768;

std::vector<std::string> lines_of(const flatbuffers::String* text) {
  std::vector<std::string> out;
  if (text == nullptr) return out;
  std::istringstream lines(text->str());
  for (std::string line; std::getline(lines, line);) out.push_back(line);
  return out;
}

}  // namespace

std::size_t FrameMeasures::column_of(const std::string& name, const std::string& unit) {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].name == name) return i;
  }
  columns_.push_back({name, unit});
  return columns_.size() - 1;
}

void FrameMeasures::learn(std::span<const std::byte> frame) {
  const fb::Frame& f = *fb::GetFrame(frame.data());
  if (f.news() == nullptr || f.news()->measures() == nullptr) return;
  const std::uint32_t legend = f.decision()->legend();
  if (legends_.contains(legend)) return;
  const auto names = lines_of(f.news()->measures());
  const auto units = lines_of(f.news()->units());
  std::vector<std::size_t>& columns = legends_[legend];
  for (std::size_t i = 0; i < names.size(); ++i) {
    columns.push_back(column_of(names[i], i < units.size() ? units[i] : std::string()));
  }
}

void FrameMeasures::read(std::span<const std::byte> frame, std::vector<double>& values) const {
  values.assign(columns_.size(), std::numeric_limits<double>::quiet_NaN());
  const fb::Frame& f = *fb::GetFrame(frame.data());
  const auto found = legends_.find(f.decision()->legend());
  if (found == legends_.end()) return;
  const auto& columns = found->second;
  const auto put = [&](const auto& shown, const auto& number) {
    if (shown.size() < columns.size()) return;
    const auto first = static_cast<flatbuffers::uoffset_t>(shown.size() - columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      values[columns[i]] = number(shown.Get(first + static_cast<flatbuffers::uoffset_t>(i)));
    }
  };
  if (f.shown() != nullptr) {
    put(*f.shown(), [](std::int16_t steps) {
      return steps == kNoNumber ? std::nan("") : static_cast<double>(steps) / kSteps;
    });
  } else if (f.shown_wide() != nullptr) {
    put(*f.shown_wide(), [](float value) { return static_cast<double>(value); });
  }
}

}  // namespace server
