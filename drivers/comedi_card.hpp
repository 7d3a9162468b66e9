// drivers/comedi_card.hpp: an acquisition card that Linux drives by COMEDI. libcomedi is loaded
// only when such a card is opened.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/analog_card.hpp"

namespace drivers {

/// How a robot is wired to its card, left before right. The stop and fault lines are high while all
/// is well, so that a broken wire counts as a fault.
struct ComediSetup {
  std::string library = "libcomedi.so.0";
  double max_volts = 10;                       // [V] the output range must include both signs
  std::optional<unsigned> output_subdevice{};  // empty: the first with analog outputs
  std::array<unsigned, 2> outputs{0, 1};       // channels
  std::array<bool, 2> reversed_outputs{};
  std::vector<unsigned> counter_subdevices{};         // one for both, or one each; empty: the first
  std::optional<std::array<unsigned, 2>> counters{};  // channels
  std::array<bool, 2> reversed_counters{};
  std::optional<unsigned> counter_mode{};     // the card driver's number for quadrature counting
  std::optional<unsigned> line_subdevice{};   // of the relay; empty: the first with outputs
  std::optional<unsigned> input_subdevice{};  // empty: the relay's, or the first with inputs
  unsigned relay_line = 0;
  std::optional<unsigned> enable_line{};  // high while the motors may turn; the relay's subdevice
  std::optional<unsigned> relay_closed_line{};  // high: the relay is closed
  std::optional<unsigned> stop_line{};          // low: the stop button is pressed
  std::optional<unsigned> fault_line{};         // low: an amplifier has a fault
  std::vector<unsigned> bumper_lines{};         // high: hit
  std::vector<unsigned> rear_bumper_lines{};
};

/// Opens `port`, such as "/dev/comedi0", with zero volts and an open relay.
/// Throws CardError when the library or the card cannot be opened, lacks what `setup` asks for, or
/// is in use by another program, whose voltages and lines then stay as they are.
std::unique_ptr<AnalogCard> open_comedi_card(const std::string& port, const ComediSetup& setup);

}  // namespace drivers
