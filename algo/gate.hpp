// algo/gate.hpp: the last word before the motors: zero command, and why.
#pragma once

#include "algo/parameters.hpp"
#include "algo/telemetry.hpp"

namespace algo {

inline constexpr ParameterInfo kScanTimeout{
    .name = "gate.scan_timeout",
    .label = "Scan timeout",
    .unit = "s",
    .min = 0.05,
    .max = 2.0,
    .step = 0.05,
    .initial = 0.2,
    .help = "The robot is held when its newest scan is older than this.",
    .alias = "scan_timeout"};

struct GateInput {
  bool stopped = false;                // Stop is latched
  double scan_timeout = 0;             // [s]
  std::optional<double> scan_stamp{};  // [s] of the newest scan; none yet
  bool blinded = false;                // most of the newest scan tells nothing: it does not count
  bool hidden = false;                 // the command leads where a dazzled scanner saw nothing
  bool by_hand = false;                // a person drives, and may back away from what was hit
};

namespace holds {

inline constexpr Hold kStopped{
    "stopped", "Stopped", "Stop is engaged. The robot stays here until it is released."};
inline constexpr Hold kBumper{
    "bumper", "Touching something", "The bumper is pressed. Back away by hand, or reset."};
inline constexpr Hold kStaleScan{
    "stale_scan", "Waiting for the laser", "The newest scan is too old. The robot waits."};
inline constexpr Hold kDazzled{
    "dazzled", "Waiting for the laser", "It is blinded or dazzled: beams ahead tell nothing."};
inline constexpr Hold kNotFinite{
    "not_finite", "Holding still", "A sensor or the controller gave a value that is not a number."};
/// By the robot itself: observation.halt says why.
inline constexpr Hold kHalted{"halted", "Holding still", "The robot holds its wheels still."};

}  // namespace holds

/// Why `command` must not be carried out; no hold when it may.
Hold gate(const GateInput& in, const Observation& observation, const Command& command);

}  // namespace algo
