// drivers/roboteq_protocol.hpp: the text protocol of Roboteq motor controllers.
//
// Lines end with CR. The controller echoes its input until the echo is switched off, answers
// commands with + or -, and queries with NAME=value:value. It can repeat queries by itself, so
// answers are matched by name, not by order.
// Source: public drivers; the maker's manual was not at hand. No I/O and no clock. The controller
// stops by itself when no motor command comes for its watchdog's time, which queries do not feed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/bytes.hpp"

namespace drivers::roboteq {

using Line = FixedBytes<96>;

// ---- commands: answered by + or - ------------------------------------------------------------

/// A command with or without a channel: ("!C", 1, 0) gives "!C 1 0". Ends with CR.
Line command(std::string_view name);
Line command(std::string_view name, int value);
Line command(std::string_view name, int channel, int value);

/// Both motors, -1000..1000 of the full speed (closed loop) or power.
Line drive(int left, int right);
/// Motors off until release_stop(); the earlier command is discarded.
inline Line emergency_stop() {
  return command("!EX");
}
inline Line release_stop() {
  return command("!MG");
}
inline Line set_counter(int channel, int count) {
  return command("!C", channel, count);
}
/// [0.1 rpm/s]
inline Line deceleration(int channel, int value) {
  return command("!DC", channel, value);
}
/// Send it first: lines before its answer may be echoes.
inline Line echo_off() {
  return command("^ECHOF", 1);
}

// ---- queries: answered by NAME=values --------------------------------------------------------

/// "?C", or a parameter as "~RWD".
Line query(std::string_view name);
Line read_parameter(std::string_view name);
/// Makes the controller repeat the queries `names` in turn, one every `milliseconds`. Empty when
/// they do not fit a line.
Line repeat_queries(std::span<const std::string_view> names, int milliseconds);
Line end_repetition();

// ---- replies ---------------------------------------------------------------------------------

/// A parsed line. Names and texts are valid as long as the line.
struct Reply {
  enum class Kind : std::uint8_t {
    Nothing,   // an echo, a cut line, noise
    Accepted,  // the oldest command that is still unanswered
    Refused,   // likewise
    Values,    // NAME=1:-2:3
    Text,      // NAME=anything else, such as the firmware's name
  };
  static constexpr std::size_t kValues = 8;

  Kind kind = Kind::Nothing;
  std::string_view name{};
  std::string_view text{};  // after the equals sign
  std::array<std::int32_t, kValues> values{};
  std::size_t count = 0;
};

/// `line` without its end.
Reply parse_reply(std::string_view line);

/// Cuts a stream into lines. Allocates nothing; skips a line that is too long to be valid.
class LineReader {
 public:
  /// Calls `on_line(std::string_view)` for each line that is not empty, without its end; valid
  /// during the call.
  template <class OnLine>
  void feed(ByteView bytes, OnLine&& on_line) {
    for (const std::uint8_t byte : bytes) {
      if (byte != '\r' && byte != '\n') {
        take(byte);
        continue;
      }
      if (line_.size() > 0 && !too_long_) on_line(line_.text());
      line_.clear();
      too_long_ = false;
    }
  }

  /// Drops the unfinished line.
  void clear() {
    line_.clear();
    too_long_ = false;
  }

 private:
  static constexpr std::size_t kLongest = 160;

  void take(std::uint8_t byte) {
    too_long_ = too_long_ || line_.size() == kLongest;
    line_.push_back(byte);
  }

  FixedBytes<kLongest> line_{};
  bool too_long_ = false;
};

// ---- reports of the controller ---------------------------------------------------------------

/// The newest answer to each query; the caller keeps the times.
struct State {
  std::optional<std::array<std::int32_t, 2>> counts{};  // of the encoders
  std::optional<std::array<double, 2>> rpm{};
  std::optional<double> battery_volts{};
  std::optional<std::array<double, 2>> motor_amperes{};
  std::optional<std::uint16_t> faults{};
  std::optional<std::array<std::uint16_t, 2>> motor_flags{};
  bool one_channel = false;  // it reports only one motor: it cannot drive a base
};

/// Updates the state by `reply`; false when `reply` holds no field of State. The answer to ?FS is
/// only for says_stalled(), and gives true.
bool update(State& state, const Reply& reply);

/// Each fault in words, separated by commas; empty when there is none.
std::string fault_text(std::uint16_t faults);
/// From an answer to ?FM or ?FS: a motor is stalled or has a loop error.
bool says_stalled(const Reply& reply);
/// Faults that stop the power stage or make the motion unreliable: the run must end.
bool must_stop(std::uint16_t faults);

/// Converts between metres of the wheel and turns of the motor.
struct Wheel {
  double radius = 0.1;        // [m]
  double gear = 1;            // turns of the motor per turn of the wheel
  double encoder_lines = 1;   // per turn of the motor; four counts each
  double full_speed_rpm = 1;  // of the motor, at a command of 1000

  /// [rpm] of the motor at `speed` [m/s] of the wheel.
  double rpm(double speed) const;
  /// [m/s], the inverse.
  double speed(double motor_rpm) const;
  /// [m] The travel of the wheel for a difference of counts.
  double metres(std::int64_t counts) const;
  /// The argument of drive(), -1000..1000; `speed` [m/s] is clamped to +-`limit` first.
  int command_for(double speed, double limit) const;
};

}  // namespace drivers::roboteq
