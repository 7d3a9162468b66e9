// drivers/roboteq_protocol.cpp: lines of Roboteq motor controllers.
#include "drivers/roboteq_protocol.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace drivers::roboteq {
namespace {

constexpr int kFull = 1000;
constexpr std::string_view kEnd = "\r";

void append_number(Line& line, int value) {
  std::array<char, 12> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  line.append(std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())));
}

void append(Line& line, std::string_view name, int first) {
  line.append(name);
  line.append(" ");
  append_number(line, first);
}

void append(Line& line, std::string_view name, int first, int second) {
  append(line, name, first);
  line.append(" ");
  append_number(line, second);
}

bool is_name(std::string_view text) {
  constexpr std::size_t kLongest = 8;
  return !text.empty() && text.size() <= kLongest &&
         std::ranges::all_of(text, [](char c) { return c >= 'A' && c <= 'Z'; });
}

/// Parses integers separated by colons into `reply`; false for any other `text`.
bool parse_values(std::string_view text, Reply& reply) {
  const char* at = text.data();
  const char* const end = at + text.size();
  while (reply.count < Reply::kValues) {
    const auto [after, error] = std::from_chars(at, end, reply.values[reply.count]);
    if (error != std::errc{}) return false;
    ++reply.count;
    if (after == end) return true;
    if (*after != ':') return false;
    at = after + 1;
  }
  return false;
}

/// Names of the bits that are set.
template <std::size_t N>
std::string words_of(std::uint16_t bits, const std::array<const char*, N>& words) {
  std::string text;
  for (std::size_t i = 0; i < N; ++i) {
    if (((bits >> i) & 1U) == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(words[i]);
  }
  if ((bits >> N) != 0) text += (text.empty() ? "" : ", ") + std::string("something unknown");
  return text;
}

std::optional<std::array<double, 2>> pair_of(const Reply& reply, double unit) {
  return std::array<double, 2>{reply.values[0] * unit, reply.values[1] * unit};
}

}  // namespace

Line command(std::string_view name) {
  Line line;
  line.append(name);
  line.append(kEnd);
  return line;
}

Line command(std::string_view name, int value) {
  Line line;
  append(line, name, value);
  line.append(kEnd);
  return line;
}

Line command(std::string_view name, int channel, int value) {
  Line line;
  append(line, name, channel, value);
  line.append(kEnd);
  return line;
}

Line drive(int left, int right) {
  Line line;
  append(line, "!G", 1, std::clamp(left, -kFull, kFull));
  line.append("_");
  append(line, "!G", 2, std::clamp(right, -kFull, kFull));
  line.append(kEnd);
  return line;
}

Line query(std::string_view name) {
  Line line;
  line.append("?");
  line.append(name);
  line.append(kEnd);
  return line;
}

Line read_parameter(std::string_view name) {
  Line line;
  line.append("~");
  line.append(name);
  line.append(kEnd);
  return line;
}

Line repeat_queries(std::span<const std::string_view> names, int milliseconds) {
  constexpr std::size_t kRoom = 96 - 20;  // less the start, the number and the end of the line
  Line line;
  line.append("# C");
  for (const std::string_view name : names) {
    if (line.size() + name.size() + 2 > kRoom) return {};
    line.append("_?");
    line.append(name);
  }
  line.append("_");
  append(line, "#", milliseconds);
  line.append(kEnd);
  return line;
}

Line end_repetition() {
  return command("#");
}

Reply parse_reply(std::string_view line) {
  using Kind = Reply::Kind;
  Reply reply;
  if (line == "+") reply.kind = Kind::Accepted;
  if (line == "-") reply.kind = Kind::Refused;
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos || !is_name(line.substr(0, equals))) return reply;
  reply.name = line.substr(0, equals);
  reply.text = line.substr(equals + 1);
  if (reply.text.empty()) return reply;
  reply.kind = parse_values(reply.text, reply) ? Kind::Values : Kind::Text;
  if (reply.kind == Kind::Text) reply.count = 0;
  return reply;
}

bool update(State& state, const Reply& reply) {
  if (reply.kind != Reply::Kind::Values) return false;
  const bool pair = reply.count >= 2;
  if (reply.name == "C" || reply.name == "S") {
    state.one_channel = !pair;
    if (!pair) return false;
  }
  if (reply.name == "C") {
    state.counts = std::array{reply.values[0], reply.values[1]};
  } else if (reply.name == "S") {
    state.rpm = pair_of(reply, 1);
  } else if (reply.name == "A" && pair) {
    state.motor_amperes = pair_of(reply, 0.1);
  } else if (reply.name == "V" && (reply.count == 1 || reply.count == 3)) {
    state.battery_volts = reply.values[reply.count == 1 ? 0 : 1] * 0.1;
  } else if (reply.name == "FF") {
    state.faults = static_cast<std::uint16_t>(reply.values[0]);
  } else if (reply.name == "FM" && pair) {
    state.motor_flags = {static_cast<std::uint16_t>(reply.values[0]),
                         static_cast<std::uint16_t>(reply.values[1])};
  } else {
    return reply.name == "FS";
  }
  return true;
}

bool says_stalled(const Reply& reply) {
  constexpr unsigned kMotorStalled = 2;
  constexpr unsigned kLoopError = 4;
  constexpr unsigned kStatusStalled = 16;
  const unsigned bits = reply.name == "FM"   ? kMotorStalled | kLoopError
                        : reply.name == "FS" ? kStatusStalled
                                             : 0;
  return std::any_of(
      reply.values.begin(),
      reply.values.begin() + static_cast<std::ptrdiff_t>(reply.count),
      [bits](std::int32_t value) { return (static_cast<std::uint32_t>(value) & bits) != 0; });
}

std::string fault_text(std::uint16_t faults) {
  constexpr std::array<const char*, 8> kWords{"overheated",
                                              "voltage too high",
                                              "voltage too low",
                                              "short circuit",
                                              "emergency stop",
                                              "motor sensor or set-up fault",
                                              "power transistor failed",
                                              "default configuration loaded"};
  return words_of(faults, kWords);
}

bool must_stop(std::uint16_t faults) {
  return faults != 0;  // a default configuration too: its watchdog and wheel data are wrong
}

double Wheel::rpm(double speed) const {
  return speed * 60.0 * gear / (2 * std::numbers::pi * radius);
}

double Wheel::speed(double motor_rpm) const {
  return motor_rpm * 2 * std::numbers::pi * radius / (60.0 * gear);
}

double Wheel::metres(std::int64_t counts) const {
  return static_cast<double>(counts) / (4 * encoder_lines * gear) * 2 * std::numbers::pi * radius;
}

int Wheel::command_for(double speed, double limit) const {
  return rounded(rpm(std::clamp(speed, -limit, limit)) / full_speed_rpm * kFull, kFull);
}

}  // namespace drivers::roboteq
