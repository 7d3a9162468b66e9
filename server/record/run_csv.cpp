// server/record/run_csv.cpp: writes the columns from the frames.
#include "server/record/run_csv.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "server/record/csv_cells.hpp"
#include "server/record/frame_codec.hpp"
#include "server/record/frame_columns.hpp"
#include "server/record/map_columns.hpp"
#include "server/record/run_json.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/run_spec.hpp"

namespace server {
namespace {

using Bytes = std::span<const std::byte>;
using Mounts = std::vector<algo::Pose2>;

/// `frame` at an address from which its numbers can be read; `copy` holds it if it must be moved.
Bytes aligned(Bytes frame, std::vector<std::byte>& copy) {
  if (reinterpret_cast<std::uintptr_t>(frame.data()) % alignof(double) == 0) return frame;
  copy.assign(frame.begin(), frame.end());
  return copy;
}

void put_columns(std::string& out, const algo::Telemetry& t) {
  for (const TickColumn& column : tick_columns()) {
    if (&column != tick_columns().data()) out += ',';
    const auto value = column.value(t);
    if (const auto* const number = std::get_if<double>(&value)) {
      put_number(out, *number);
    } else if (const auto* const word = std::get_if<std::string_view>(&value)) {
      put_text(out, *word);
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

void put_joints(std::string& out, const algo::Command& command, std::size_t joints) {
  for (std::size_t i = 0; i < joints; ++i) {
    out += ',';
    if (i < command.joints) put_number(out, command.joint_rates[i]);
  }
}

void add_mount(Mounts& mounts, const algo::Pose2& mount) {
  if (std::ranges::find(mounts, mount) == mounts.end()) mounts.push_back(mount);
}

/// The newest element of `list` at `mount`; nullptr if there is none.
template <typename List>
const auto* newest_at(const List& list, const algo::Pose2& mount) {
  decltype(list.begin()) found = nullptr;
  for (const auto& each : list) {
    if (each.mount_R == mount) found = &each;
  }
  return found;
}

/// [m] "inf" for nothing within range, "nan" for not measured.
void put_range(std::string& out, algo::Beam status, double range) {
  if (status == algo::Beam::Ok) {
    put_number(out, range);
  } else {
    out += status == algo::Beam::Free ? "inf" : "nan";
  }
}

/// Appends four cells: stamp, first bearing, step between bearings, and all ranges, separated by
/// blanks.
void put_scan(std::string& out, const algo::LaserScan* scan) {
  if (scan == nullptr) {
    out += ",,,,";
    return;
  }
  for (const double value : {scan->stamp, scan->angle_min, scan->angle_increment}) {
    out += ',';
    put_number(out, value);
  }
  out += ',';
  for (std::size_t i = 0; i < scan->size(); ++i) {
    if (i > 0) out += ' ';
    put_range(out, scan->status[i], scan->ranges[i]);
  }
}

}  // namespace

RunCsv::RunCsv(db::RunReader& reader, const db::RunRow& run, CsvOptions options)
    : run_(run.id), options_(options) {
  const nlohmann::json document = parse_json(run.what.document, kOwnDocument);
  if (document.contains("robot")) channels_ = robot_spec_from_json(document["robot"]).channels;
  algo::Telemetry t;
  std::vector<std::byte> copy;
  try {
    reader.frames(
        run_, 0, std::numeric_limits<std::size_t>::max(), [&](std::uint64_t, Bytes bytes) {
          const Bytes frame = aligned(bytes, copy);
          decode_frame(frame, t);
          learn(t);
          measures_.learn(frame);
        });
  } catch (const std::exception&) {
    // The record is damaged: lines() gives the ticks before the damage, and then says so.
  }
}

void RunCsv::learn(const algo::Telemetry& t) {
  for (const auto& r : t.observation.sonar) add_mount(sonar_, r.mount_R);
  infrared_ = infrared_ || !t.observation.infrared.empty();
  for (const auto& r : t.observation.bumpers) add_mount(bumpers_, r.mount_R);
  scanners_.learn(t.observation);
  joints_ = std::max<std::size_t>(joints_, t.command.joints);
  arm_ = arm_ || t.arm.present;
  map_ = map_ || t.observation.map_pose.has_value();
}

std::span<const FrameColumn> RunCsv::own_arm() const {
  return arm_ ? arm_columns() : std::span<const FrameColumn>{};
}

std::span<const FrameColumn> RunCsv::own_map() const {
  return map_ ? map_columns() : std::span<const FrameColumn>{};
}

bool RunCsv::has_column(std::string_view name) const {
  const auto in = [name](const auto& columns) {
    return std::ranges::any_of(columns, [name](const auto& each) { return each.name == name; });
  };
  constexpr std::array<std::string_view, 5> kLists{
      "sonar", "bumper", "joint_rate", "infrared", "moved"};
  return in(tick_columns()) || in(frame_columns()) || in(own_arm()) || in(own_map()) ||
         in(measures_.columns()) || std::ranges::find(kLists, name) != kLists.end();
}

std::string RunCsv::header() const {
  std::string out;
  const auto add = [&](std::string_view name, std::string_view unit) {
    if (!out.empty()) out += ',';
    const bool with = options_.units && !unit.empty();
    put_text(out, with ? fmt::format("{} [{}]", name, unit) : std::string(name));
  };
  const auto add_each = [&](std::string_view name, std::size_t count, std::string_view unit) {
    for (std::size_t i = 0; i < count; ++i) add(fmt::format("{}[{}]", name, i), unit);
  };
  for (const TickColumn& column : tick_columns()) add(column.name, column.unit);
  for (const algo::ChannelInfo& channel : channels_) {
    const std::string name = (has_column(channel.name) ? "channel." : "") + channel.name;
    if (channel.values == 1) add(name, channel.unit);
    if (channel.values > 1) add_each(name, channel.values, channel.unit);
  }
  for (const FrameColumn& column : frame_columns()) add(column.name, column.unit);
  add_each("sonar", sonar_.size(), "m");
  add_each("bumper", bumpers_.size(), "");
  add_each("joint_rate", joints_, "rad/s");
  for (const FrameColumn& column : own_arm()) add(column.name, column.unit);
  for (const FrameColumn& column : own_map()) add(column.name, column.unit);
  for (const auto& measure : measures_.columns()) add(measure.name, measure.unit);
  if (options_.arrays) {
    for (std::size_t i = 0; i < scanners_.size(); ++i) {
      add(fmt::format("scan[{}].stamp", i), "s");
      add(fmt::format("scan[{}].angle_min", i), "rad");
      add(fmt::format("scan[{}].angle_increment", i), "rad");
      add(fmt::format("scan[{}].ranges", i), "m");
    }
    if (infrared_) add("infrared", "");
    add("moved", "");
  }
  return out + '\n';
}

void RunCsv::put_rings(std::string& out, const algo::Observation& o) const {
  for (const algo::Pose2& mount : sonar_) {
    out += ',';
    const algo::RangeReading* const r = newest_at(o.sonar, mount);
    if (r != nullptr) put_range(out, r->status, r->range);
  }
  for (const algo::Pose2& mount : bumpers_) {
    out += ',';
    const algo::BumperReading* const r = newest_at(o.bumpers, mount);
    if (r != nullptr) out += r->pressed ? '1' : '0';
  }
}

/// Of each infrared beam "x y heading range" in R, of each moved obstacle "id x y heading" in W.
void RunCsv::put_arrays(std::string& out, const algo::Telemetry& t) const {
  for (std::size_t i = 0; i < scanners_.size(); ++i) {
    put_scan(out, scanners_.find(t.observation, i));
  }
  if (infrared_) out += ',';
  for (const algo::RangeReading& r : t.observation.infrared) {
    if (&r != t.observation.infrared.begin()) out += "; ";
    for (const double value : {r.mount_R.x, r.mount_R.y, r.mount_R.heading}) {
      put_number(out, value);
      out += ' ';
    }
    put_range(out, r.status, r.range);
  }
  out += ',';
  for (const algo::Moved& m : t.moved) {
    if (&m != t.moved.begin()) out += "; ";
    out += std::to_string(m.id);
    for (const double value : {m.pose_W.x, m.pose_W.y, m.pose_W.heading}) {
      out += ' ';
      put_float(out, value);
    }
  }
}

std::optional<std::uint64_t> RunCsv::lines(db::RunReader& reader,
                                           std::uint64_t from,
                                           std::size_t limit,
                                           std::string& out) const {
  algo::Telemetry t;
  std::vector<std::byte> copy;
  std::vector<double> measures;
  const auto put_line = [&](std::uint64_t, Bytes bytes) {
    const Bytes frame = aligned(bytes, copy);
    decode_frame(frame, t);
    put_columns(out, t);
    put_channels(out, t.observation, channels_);
    for (const FrameColumn& column : frame_columns()) {
      out += ',';
      column.put(out, t);
    }
    put_rings(out, t.observation);
    put_joints(out, t.command, joints_);
    for (const auto& own : {own_arm(), own_map()}) {
      for (const FrameColumn& column : own) {
        out += ',';
        column.put(out, t);
      }
    }
    measures_.read(frame, measures);
    for (const double measure : measures) {
      out += ',';
      put_float(out, measure);
    }
    if (options_.arrays) put_arrays(out, t);
    out += '\n';
  };
  return reader.frames(run_, from, limit, put_line);
}

}  // namespace server
