// server/record/run_csv.cpp: writes writes columns and channels from the frames.
#include "server/record/run_csv.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "server/record/frame_codec.hpp"
#include "server/record/run_json.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/run_spec.hpp"

namespace server {
namespace {

void put_number(std::string& out, double value) {
  if (std::isnan(value)) return;  // an empty cell
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

void put_columns(std::string& out, const algo::Telemetry& t) {
  for (const TickColumn& column : tick_columns()) {
    if (&column != tick_columns().data()) out += ',';
    const auto value = column.value(t);
    if (const auto* const number = std::get_if<double>(&value)) {
      put_number(out, *number);
    } else if (const auto* const word = std::get_if<std::string_view>(&value)) {
      out += *word;
    } else {
      out += std::to_string(std::get<std::uint64_t>(value));
    }
  }
}

/// Appends ",1.5,,3" for three channels of one value each, of which the second has no reading.
void put_channels(std::string& out,
                  const algo::Observation& observation,
                  const std::vector<algo::ChannelInfo>& channels) {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const algo::ChannelReading* found = nullptr;
    for (const algo::ChannelReading& reading : observation.channels) {
      if (reading.channel == i) found = &reading;
    }
    for (std::uint32_t k = 0; k < channels[i].values; ++k) {
      out += ',';
      if (found != nullptr && k < found->values.size()) put_number(out, found->values[k]);
    }
  }
}

}  // namespace

RunCsv::RunCsv(const db::RunRow& run) : run_(run.id) {
  const nlohmann::json document = parse_json(run.what.document, kOwnDocument);
  if (document.contains("robot")) channels_ = robot_spec_from_json(document["robot"]).channels;
}

std::string RunCsv::header() const {
  std::string out;
  for (const TickColumn& column : tick_columns()) {
    if (!out.empty()) out += ',';
    out += column.name;
  }
  for (const algo::ChannelInfo& channel : channels_) {
    for (std::uint32_t k = 0; k < channel.values; ++k) {
      out += ',' + channel.name;
      if (channel.values > 1) out += fmt::format("[{}]", k);
    }
  }
  return out + '\n';
}

std::optional<std::uint64_t> RunCsv::lines(db::RunReader& reader,
                                           std::uint64_t from,
                                           std::size_t limit,
                                           std::string& out) const {
  algo::Telemetry t;
  return reader.frames(run_, from, limit, [&](std::uint64_t, std::span<const std::byte> frame) {
    decode_frame(frame, t);
    put_columns(out, t);
    put_channels(out, t.observation, channels_);
    out += '\n';
  });
}

}  // namespace server
