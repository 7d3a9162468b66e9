// drivers/analog_card.hpp: a data acquisition card that drives two motor amplifiers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drivers {

/// The card is lost, or lacks a channel that the robot's file asks for; what() is a sentence.
struct CardError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Left and right.
using Volts = std::array<double, 2>;  // [V]

/// One reading of the card. A line that is not wired reads as if there were no fault.
struct CardInputs {
  std::array<std::uint32_t, 2> counts{};  // of the encoders, left and right, modulo 2^32
  std::optional<bool> relay_closed{};     // empty: no line is wired to it
  bool stop_button = false;
  bool fault = false;  // of an amplifier
  bool bumper_front = false;
  bool bumper_rear = false;
};

/// Two outputs, two counters and some digital lines, wired as on the Silvermate and on Park's
/// robot. Calls do not wait; each throws CardError when the card has gone.
class AnalogCard {
 public:
  AnalogCard() = default;
  virtual ~AnalogCard() = default;
  AnalogCard(const AnalogCard&) = delete;
  AnalogCard& operator=(const AnalogCard&) = delete;

  /// Sets the voltages of the amplifiers. The card keeps them after the program dies, so the relay
  /// must open by itself.
  virtual void write(const Volts& volts) = 0;
  virtual CardInputs read() = 0;
  /// Sets the line of the relay that powers the amplifiers. The relay stays closed only while the
  /// line keeps changing.
  virtual void set_relay_line(bool high) = 0;
  /// The amplifiers' own enable input, where it is wired: faster than the relay.
  virtual void set_enabled(bool enabled) = 0;
  /// Names and values for doctor and the page: board, driver, outputs, counters, lines.
  virtual std::vector<std::pair<std::string, std::string>> facts() const = 0;
};

}  // namespace drivers
