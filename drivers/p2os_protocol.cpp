// drivers/p2os_protocol.cpp: packets of Pioneer bases.
#include "drivers/p2os_protocol.hpp"

#include <algorithm>
#include <cmath>

#include "algo/units.hpp"

namespace drivers::p2os {
namespace {

using algo::units::kRadiansPerDegree;

constexpr std::uint8_t kFirstMark = 0xFA;
constexpr std::uint8_t kSecondMark = 0xFB;
constexpr std::size_t kHeaderBytes = 3;
constexpr std::size_t kSumBytes = 2;

constexpr std::uint8_t kPositiveArgument = 0x3B;
constexpr std::uint8_t kNegativeArgument = 0x1B;

constexpr std::uint8_t kStopped = 0x32;
constexpr std::uint8_t kMoving = 0x33;
constexpr std::uint8_t kConfigurationPacket = 0x20;

Packet packed(ByteView body) {
  Packet packet;
  packet.push_back(kFirstMark);
  packet.push_back(kSecondMark);
  packet.push_back(static_cast<std::uint8_t>(body.size() + kSumBytes));
  packet.append(body);
  const std::uint16_t sum = checksum(body);  // the one word with its high byte first
  packet.push_back(static_cast<std::uint8_t>(sum >> 8U));
  packet.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
  return packet;
}

/// Removes the next zero-terminated text from `bytes` and returns it.
std::string take_text(ByteView& bytes) {
  const auto end = std::ranges::find(bytes, std::uint8_t{0});
  std::string text(bytes.begin(), end);
  const auto taken = static_cast<std::size_t>(end - bytes.begin());
  bytes = bytes.subspan(std::min(taken + 1, bytes.size()));
  return text;
}

/// Reads the fields after the sonar readings, as far as the packet has them.
void decode_tail(ByteView rest, State& state) {
  constexpr std::size_t kWithBattery = 7;
  constexpr std::size_t kWhole = 12;
  // The older byte field holds up to 25.5 V, too little for a 24 V base being charged.
  if (rest.size() >= kWithBattery && word_at(rest, 5) != 0) state.volts = word_at(rest, 5) * 0.1;
  if (rest.size() >= kWhole) state.faults = word_at(rest, 10);
}

}  // namespace

std::uint16_t checksum(ByteView body) {
  unsigned sum = 0;
  for (std::size_t i = 0; i + 1 < body.size(); i += 2) {
    sum = (sum + ((static_cast<unsigned>(body[i]) << 8U) | body[i + 1])) & 0xFFFFU;
  }
  if (body.size() % 2 != 0) sum ^= body.back();
  return static_cast<std::uint16_t>(sum);
}

FrameStart Framing::start(ByteView bytes) const {
  using Kind = FrameStart::Kind;
  if (bytes[0] != kFirstMark || (bytes.size() > 1 && bytes[1] != kSecondMark)) return {};
  if (bytes.size() < kHeaderBytes) return {.kind = Kind::TooShortToTell};
  const std::size_t count = bytes[2];
  if (count < 1 + kSumBytes || count > kLongestBody + kSumBytes) return {};
  return {.kind = Kind::Frame, .size = kHeaderBytes + count};
}

bool Framing::intact(ByteView frame) const {
  const std::size_t sum = frame.size() - kSumBytes;
  return checksum(body_of(frame)) == ((frame[sum] << 8U) | frame[sum + 1]);
}

ByteView body_of(ByteView packet) {
  return packet.subspan(kHeaderBytes, packet.size() - kHeaderBytes - kSumBytes);
}

Packet command(Code code) {
  const std::array<std::uint8_t, 1> body{static_cast<std::uint8_t>(code)};
  return packed(body);
}

Packet command(Code code, int argument) {
  constexpr int kMost = 0xFFFF;
  const int size = std::abs(std::clamp(argument, -kMost, kMost));
  const std::array<std::uint8_t, 4> body{static_cast<std::uint8_t>(code),
                                         argument < 0 ? kNegativeArgument : kPositiveArgument,
                                         static_cast<std::uint8_t>(size & 0xFF),
                                         static_cast<std::uint8_t>(size >> 8)};
  return packed(body);
}

VelocityPackets velocity(const algo::Twist2& twist, const algo::Twist2& limit) {
  constexpr int kMost = 0x7FFF;
  const double v = std::clamp(twist.v, -limit.v, limit.v);
  const double omega = std::clamp(twist.omega, -limit.omega, limit.omega);
  return {.velocity = command(Code::Velocity, rounded(v * 1000.0, kMost)),
          .turn_rate = command(Code::TurnRate, rounded(omega / kRadiansPerDegree, kMost))};
}

Packet Handshake::request() const {
  return command(static_cast<Code>(step_));
}

Handshake::Progress Handshake::receive(ByteView body) {
  constexpr std::uint8_t kLast = 2;
  if (is_state(body)) return Progress::SessionOpen;
  if (body.empty() || body[0] != step_) return Progress::Ignored;
  if (step_ < kLast) {
    ++step_;
    return Progress::Advanced;
  }
  ByteView rest = body.subspan(1);
  identity_.name = take_text(rest);
  identity_.type = take_text(rest);
  identity_.subtype = take_text(rest);
  return Progress::Done;
}

bool is_state(ByteView body) {
  return !body.empty() && (body[0] == kStopped || body[0] == kMoving);
}

bool decode_state(ByteView body, State& state, const Units& units) {
  constexpr std::size_t kSonarsAt = 20;
  constexpr std::size_t kSonarBytes = 3;
  if (!is_state(body) || body.size() < kSonarsAt) return false;
  const std::size_t sonars = body[kSonarsAt - 1];
  if (sonars > State::kSonars || body.size() < kSonarsAt + sonars * kSonarBytes) return false;

  const unsigned position_mask = (1U << units.position_bits) - 1U;
  const unsigned bumpers = word_at(body, 12);
  state.x_count = static_cast<std::uint16_t>(word_at(body, 1) & position_mask);
  state.y_count = static_cast<std::uint16_t>(word_at(body, 3) & position_mask);
  state.heading = algo::wrap_angle(signed_word_at(body, 5) * units.radians_per_count);
  state.left_speed = signed_word_at(body, 7) * units.metres_per_second;
  state.right_speed = signed_word_at(body, 9) * units.metres_per_second;
  state.volts = body[11] * 0.1;
  state.left_stalled = (bumpers & 1U) != 0;
  state.right_stalled = (bumpers & 0x100U) != 0;
  state.rear_bumpers = static_cast<std::uint8_t>((bumpers >> 1U) & 0x7FU);
  state.front_bumpers = static_cast<std::uint8_t>((bumpers >> 9U) & 0x7FU);
  state.flags = word_at(body, 16);
  for (std::size_t i = 0; i < sonars; ++i) {
    const std::size_t at = kSonarsAt + i * kSonarBytes;
    state.sonars[i] = {.index = body[at], .range = word_at(body, at + 1) / 1000.0};
  }
  state.sonar_count = sonars;
  state.faults.reset();
  decode_tail(body.subspan(kSonarsAt + sonars * kSonarBytes), state);
  return true;
}

/// Kind, type, subtype, serial number, four motors, five limits, name; then cycle and rates
/// (bytes), gripper and front sonar (words), rear sonar (byte), low battery, counts a turn,
/// watchdog [ms].
std::optional<double> configured_watchdog(ByteView body) {
  if (body.empty() || body[0] != kConfigurationPacket) return std::nullopt;
  constexpr std::size_t kLimits = 1 + 5 * 2;
  constexpr std::size_t kUpToWatchdog = 3 + 2 * 2 + 1 + 2 * 2;
  ByteView rest = body.subspan(1);
  for (int text = 0; text < 3; ++text) take_text(rest);
  if (rest.size() < kLimits) return std::nullopt;
  rest = rest.subspan(kLimits);
  take_text(rest);
  if (rest.size() < kUpToWatchdog + 2) return std::nullopt;
  return word_at(rest, kUpToWatchdog) / 1000.0;
}

double Odometer::difference(std::uint16_t now, std::uint16_t before) const {
  const int turn = 1 << units_.position_bits;
  const int raw = (now - before) & (turn - 1);
  return (raw < turn / 2 ? raw : raw - turn) * units_.metres_per_count;
}

bool Odometer::update(const State& state) {
  constexpr double kFurthest = 0.25;  // [m] at 2.2 m/s, the fastest, in 0.1 s
  const double x = difference(state.x_count, x_count_);
  const double y = difference(state.y_count, y_count_);
  const bool believable = begun_ && std::hypot(x, y) <= kFurthest;
  if (believable) {
    pose_.x += x;
    pose_.y += y;
  }
  pose_.heading = state.heading;
  x_count_ = state.x_count;
  y_count_ = state.y_count;
  const bool first = !begun_;
  begun_ = true;
  return believable || first;
}

}  // namespace drivers::p2os
