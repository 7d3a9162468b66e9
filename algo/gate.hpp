// algo/gate.hpp: the last check before the motors: may hold the robot at zero, and says why.
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

inline constexpr ParameterInfo kTiltTimeout{
    .name = "gate.tilt_timeout",
    .label = "Inclinometer timeout",
    .unit = "s",
    .min = 0.05,
    .max = 2.0,
    .step = 0.05,
    .initial = 0.2,
    .help = "A robot that drives by its inclinometer is held when its newest reading is older."};

struct GateInput {
  bool stopped = false;                // Stop is latched
  double scan_timeout = 0;             // [s]
  std::optional<double> scan_stamp{};  // [s] of the newest scan; empty before the first
  bool blinded = false;     // most beams of the newest scan measured nothing: it is ignored
  bool hidden = false;      // the command leads into a dazzled scanner's blind cone
  bool by_hand = false;     // a person drives, and may back away from a contact
  bool needs_tilt = false;  // the robot drives by its inclinometer
  double tilt_timeout = 0;  // [s]
  std::optional<double> tilt_stamp{};  // [s] of its newest reading; empty before the first
  bool needs_joints = false;           // the robot has an arm
};

namespace holds {

inline constexpr Hold kStopped{
    "stopped", "Stopped", "Stop is engaged. The robot stays here until it is released."};
inline constexpr Hold kBumper{
    "bumper", "Touching something", "The bumper is pressed. Back away by hand, or reset."};
inline constexpr Hold kOverturned{
    "overturned",
    "Lying on its side",
    "The inclinometer says that the robot has turned over. Reset sets a simulated one upright."};
inline constexpr Hold kStaleScan{
    "stale_scan", "Waiting for the laser", "The newest scan is too old. The robot waits."};
inline constexpr Hold kDazzled{
    "dazzled", "Waiting for the laser", "It is blinded or dazzled: beams ahead tell nothing."};
inline constexpr Hold kStaleTilt{
    "stale_tilt",
    "Waiting for the inclinometer",
    "Its newest reading is too old. Without it the robot does not know how it leans."};
inline constexpr Hold kNoTilt{
    "no_tilt",
    "Waiting for the inclinometer",
    "No reading has come yet. Without it the robot does not know how it leans."};
inline constexpr Hold kNoJoints{
    "no_joints",
    "Waiting for the arm",
    "It does not say how its joints stand. Without that nobody knows what it may touch."};
/// algo::sentence() of the fix replaces the reason.
inline constexpr Hold kNotLocated{
    "not_located", "Not located", "Where the robot is on its map is not known."};
inline constexpr Hold kNotFinite{
    "not_finite", "Holding still", "A sensor or the controller gave a value that is not a number."};
/// The robot holds itself; observation.halt says why.
inline constexpr Hold kHalted{"halted", "Holding still", "The robot holds its wheels still."};

}  // namespace holds

/// The reason why `command` must not be carried out; no hold when it may be.
Hold gate(const GateInput& in, const Observation& observation, const Command& command);

}  // namespace algo
