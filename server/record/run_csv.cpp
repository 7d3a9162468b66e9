// server/record/run_csv.cpp: the columns from the rows, the channels from the frames.
#include "server/record/run_csv.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "server/record/frame_codec.hpp"
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

void put_row(std::string& out, const db::TickRow& row) {
  out += std::to_string(row.tick);
  for (const double value : {row.t, row.x, row.y, row.heading, row.v, row.omega, row.clearance}) {
    out += ',';
    put_number(out, value);
  }
  out += ',';
  out += row.hold.empty() ? "none" : row.hold;
  out += ',';
  out += row.behaviour;
}

/// ",1.5,,3" for channels of 1, 1 and 1 values of which the second has no reading.
std::string cells_of(const algo::Observation& observation,
                     const std::vector<algo::ChannelInfo>& channels) {
  std::string cells;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const algo::ChannelReading* found = nullptr;
    for (const algo::ChannelReading& reading : observation.channels) {
      if (reading.channel == i) found = &reading;
    }
    for (std::uint32_t k = 0; k < channels[i].values; ++k) {
      cells += ',';
      if (found != nullptr && k < found->values.size()) put_number(cells, found->values[k]);
    }
  }
  return cells;
}

}  // namespace

RunCsv::RunCsv(const db::RunRow& run) : run_(run.id) {
  const nlohmann::json document = parse_json(run.what.document, kOwnDocument);
  if (document.contains("robot")) channels_ = robot_spec_from_json(document["robot"]).channels;
}

std::string RunCsv::header() const {
  std::string out = "tick,t,x,y,heading,v,omega,clearance,hold,behaviour";
  for (const algo::ChannelInfo& channel : channels_) {
    for (std::uint32_t k = 0; k < channel.values; ++k) {
      out += ',' + channel.name;
      if (channel.values > 1) out += fmt::format("[{}]", k);
    }
  }
  return out + '\n';
}

std::vector<std::string> RunCsv::channel_cells(db::RunReader& reader,
                                               std::uint64_t from,
                                               std::size_t limit) const {
  std::vector<std::string> cells;
  algo::Telemetry t;
  reader.frames(run_, from, limit, [&](std::uint64_t, std::span<const std::byte> frame) {
    decode_frame(frame, t);
    cells.push_back(cells_of(t.observation, channels_));
  });
  return cells;
}

std::optional<std::uint64_t> RunCsv::lines(db::RunReader& reader,
                                           std::uint64_t from,
                                           std::size_t limit,
                                           std::string& out) const {
  const db::TickPage page = reader.ticks(run_, from, limit);
  std::vector<std::string> cells;
  if (!channels_.empty()) cells = channel_cells(reader, from, page.ticks.size());
  for (std::size_t i = 0; i < page.ticks.size(); ++i) {
    put_row(out, page.ticks[i]);
    if (i < cells.size()) out += cells[i];
    out += '\n';
  }
  return page.next;
}

}  // namespace server
