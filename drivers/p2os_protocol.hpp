// drivers/p2os_protocol.hpp: packets of Pioneer bases (P2OS, AROS, ARCOS), both ways.
//
//   FA FB  COUNT  BODY...  SUM_HI SUM_LO      COUNT = bytes of BODY + 2; words low byte first
//
// Sources: the manuals of the Pioneer 2 and 3, checked against two public clients. No I/O and no
// clock. The base stops by itself after its watchdog time without a packet, so a program without
// a fresh command must send nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include "algo/types.hpp"
#include "drivers/bytes.hpp"
#include "drivers/frame_reader.hpp"

namespace drivers::p2os {

constexpr std::size_t kLongestBody = 200;
constexpr double kStatePeriod = 0.1;    // [s] between state packets
constexpr double kCommandPeriod = 0.1;  // [s] at which an unchanged command is repeated

/// Check value over a body.
std::uint16_t checksum(ByteView body);

/// The framing for FrameReader. There are no acknowledgements and no stray bytes.
struct Framing {
  static constexpr std::size_t kLongest = kLongestBody + 5;

  FrameStart start(ByteView bytes) const;
  bool intact(ByteView frame) const;
};
using PacketReader = FrameReader<Framing>;

/// The body of an intact packet; never empty.
ByteView body_of(ByteView packet);

// ---- commands --------------------------------------------------------------------------------

enum class Code : std::uint8_t {
  Open = 1,
  Close = 2,
  Enable = 4,        // 0 or 1: the motors
  Acceleration = 5,  // [mm/s2], negative sets the deceleration
  SpeedLimit = 6,    // [mm/s]
  ZeroOdometry = 7,
  Rotate = 9,      // [deg/s] left
  TurnLimit = 10,  // [deg/s]
  Velocity = 11,   // [mm/s]
  Configuration = 18,
  Encoders = 19,          // packets: 0 off, 1 once, 2 each period
  TurnRate = 21,          // [deg/s] left
  TurnAcceleration = 23,  // [deg/s2], negative sets the deceleration
  Sonar = 28,             // 0 or 1
  Stop = 29,              // decelerates; the motors stay on
  WheelVelocities = 32,
  BumpStall = 44,      // bit 0 front, bit 1 rear bumpers stop the base
  HostBaud = 50,       // 0..4: 9600, 19200, 38400, 57600, 115200
  EmergencyStop = 55,  // full deceleration; the motors stay on
  Reset = 253,
};

using Packet = FixedBytes<Framing::kLongest>;

Packet command(Code code);
/// `argument` is clamped to 16 bits and a sign.
Packet command(Code code, int argument);

/// The units of a type of base.
struct Units {
  double metres_per_count = 1e-3;                          // of position (DistConvFactor)
  double radians_per_count = 2 * std::numbers::pi / 4096;  // of heading (AngleConvFactor)
  double metres_per_second = 1e-3;  // per unit of wheel speed (VelConvFactor)
  unsigned position_bits = 15;      // 12 on old bases
};

/// A motion at a resolution of 1 mm/s and 1 deg/s, in two packets.
struct VelocityPackets {
  Packet velocity{};
  Packet turn_rate{};
};
/// `limit` has the largest v [m/s] and omega [rad/s] allowed.
VelocityPackets velocity(const algo::Twist2& twist, const algo::Twist2& limit);

// ---- connecting ------------------------------------------------------------------------------

/// The names that the base reports; they select its parameters.
struct Identity {
  std::string name{};
  std::string type{};
  std::string subtype{};
  bool operator==(const Identity&) const = default;
};

/// Sends SYNC0, SYNC1, SYNC2, each after the echo of the previous one; the last echo names the
/// base. Then the caller sends Code::Open, and Code::Enable before any motion.
class Handshake {
 public:
  enum class Progress : std::uint8_t {
    Ignored,      // not part of the handshake
    Advanced,     // send request() now
    Done,         // identity() is known
    SessionOpen,  // of an earlier client: send Code::Close, wait 0.4 s, begin again
  };

  /// The packet to send now, and again after 0.2 to 1 s of silence, three times in all.
  Packet request() const;
  Progress receive(ByteView body);
  const Identity& identity() const { return identity_; }

 private:
  std::uint8_t step_ = 0;
  Identity identity_{};
};

// ---- reports of the base ---------------------------------------------------------------------

struct SonarReading {
  std::uint8_t index = 0;
  double range = 0;  // [m]; 5 m without an echo
  bool operator==(const SonarReading&) const = default;
};

/// A state packet (SIP). Counts are as sent; Odometer converts them to a pose.
struct State {
  static constexpr std::size_t kSonars = 64;  // more than fit into a packet

  std::uint16_t x_count = 0;
  std::uint16_t y_count = 0;
  double heading = 0;      // [rad] in (-pi, pi]
  double left_speed = 0;   // [m/s]
  double right_speed = 0;  // [m/s]
  double volts = 0;        // of the battery
  bool left_stalled = false;
  bool right_stalled = false;
  std::uint8_t front_bumpers = 0;  // bit i: segment i is pressed
  std::uint8_t rear_bumpers = 0;
  std::uint16_t flags = 0;
  std::array<SonarReading, kSonars> sonars{};  // the first `sonar_count` are new readings
  std::size_t sonar_count = 0;
  std::optional<std::uint16_t> faults{};  // only from newer firmware

  bool motors_on() const { return (flags & 1U) != 0; }
  /// While pressed, the motors are off and Code::Enable does nothing.
  bool stop_button() const { return (flags & 0x60U) != 0; }
  bool stalled() const { return left_stalled || right_stalled; }
};

/// Whether `body` is that of a state packet.
bool is_state(ByteView body);
/// Fills `state`. False, without a change, when `body` is no state packet or ends too early.
bool decode_state(ByteView body, State& state, const Units& units = {});

/// [s] The base's watchdog, from the answer to Code::Configuration; 0: off. nullopt when `body` is
/// no such answer or ends too early.
std::optional<double> configured_watchdog(ByteView body);

/// Adds up the differences of the wrapping position counts.
class Odometer {
 public:
  explicit Odometer(const Units& units = {}) : units_(units) {}

  /// False when the position jumped further than any base can drive in a period; the jump is left
  /// out. The first state is the origin; headings are the base's own.
  bool update(const State& state);
  const algo::Pose2& pose() const { return pose_; }

 private:
  double difference(std::uint16_t now, std::uint16_t before) const;

  Units units_;
  algo::Pose2 pose_{};
  bool begun_ = false;
  std::uint16_t x_count_ = 0;
  std::uint16_t y_count_ = 0;
};

}  // namespace drivers::p2os
