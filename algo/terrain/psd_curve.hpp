// algo/terrain/psd_curve.hpp: the voltage of a Sharp GP2D12 distance sensor, and its converter.
//
// Source: sensors.md 7; Masuda et al. 2008, section 2.
#pragma once

#include <cstdint>

namespace algo {

constexpr double kPsdNearest = 0.10;            // [m] nearer surfaces read as farther ones
constexpr double kPsdFarthest = 0.80;           // [m]
constexpr double kPsdTooFar = 0.35;             // [V] less: nothing is within range
constexpr double kPsdTooNear = 2.45;            // [V] more: the converter is near its end
constexpr double kPsdReference = 2.5;           // [V] of the full converter
constexpr std::uint16_t kPsdMostCounts = 4095;  // of its 12 bits

/// [V] for a surface at `distance` [m]: 0.09 + 23.9 / (L + 0.42) with L in cm. Below 8 cm the
/// voltage falls again: a surface at 4 cm reads like one at 20 cm.
double psd_voltage(double distance);

/// [m] The inverse of the falling branch. NaN for a voltage outside kPsdTooFar .. kPsdTooNear, and
/// for NaN. A surface nearer than 8 cm gives a wrong distance; mount the sensor so that none is.
double psd_distance(double voltage);

/// The converter's counts for `voltage` [V], rounded, and within its 12 bits.
std::uint16_t psd_counts(double voltage);

/// [V] of `counts`.
double psd_voltage_of(std::uint16_t counts);

}  // namespace algo
