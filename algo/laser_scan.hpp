// algo/laser_scan.hpp: one sweep of a scanner. Each beam has a status, so that a device code is
// never mistaken for a distance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algo/types.hpp"

namespace algo {

/// The meaning of a beam's reading. Only Ok carries a distance.
enum class Beam : std::uint8_t {
  Ok = 0,       // ranges[i] is a distance
  Free = 1,     // nothing within range_max
  Invalid = 2,  // the device could not measure; codes[i] says why
};

/// Last hex digit of an LMS2xx code (the upper digits are a mask of the unit).
enum class BeamCode : std::uint8_t {
  None = 0,
  Unknown = 1,
  OtherSensor = 2,  // an Ok beam whose distance another sensor measured: see SensorMerge
  BeyondRange = 7,
  ReadError = 0xA,
  WeakSignal = 0xB,
  Overflow = 0xD,
  Dazzled = 0xE,
  NoEcho = 0xF,
};

/// Beam i points at angle_min + i * angle_increment in the mount frame, right to left.
/// Beams are fired in `turns` interlaced mirror turns: beam i belongs to turn i % turns.
struct LaserScan {
  Pose2 mount_R{};                // of the scanner in R
  double stamp = 0;               // [s] run clock, end of the sweep
  double angle_min = 0;           // [rad]
  double angle_increment = 0;     // [rad]
  double range_max = 0;           // [m] a reading at or beyond it is Free
  double turn_period = 0;         // [s] one mirror turn; 0 when all beams share one instant
  std::uint32_t turns = 1;        // interlaced turns in a sweep
  std::vector<double> ranges{};   // [m] B values; range_max where not Ok
  std::vector<Beam> status{};     // B values
  std::vector<BeamCode> codes{};  // B values; None or OtherSensor where Ok

  std::size_t size() const { return ranges.size(); }
  double angle(std::size_t i) const { return angle_min + static_cast<double>(i) * angle_increment; }
  /// True if the scanner itself measured beam `i`'s distance.
  bool measured(std::size_t i) const {
    return status[i] == Beam::Ok && codes[i] != BeamCode::OtherSensor;
  }
  /// [s] Duration of the whole sweep.
  double sweep_time() const { return turn_period * static_cast<double>(turns); }
  /// [s] Run-clock time at which beam `i` was fired: turn i % turns, (angle + 90 deg) / 360 of it.
  double beam_time(std::size_t i) const {
    const double turn = static_cast<double>(i % turns);
    const double phase = (angle(i) + std::numbers::pi / 2) / (2 * std::numbers::pi);
    return stamp - sweep_time() + (turn + phase) * turn_period;
  }

  void resize(std::size_t beams) {
    ranges.resize(beams);
    status.resize(beams);
    codes.resize(beams);
  }
  void set_ok(std::size_t i, double range) { set(i, Beam::Ok, range, BeamCode::None); }
  void set_from_other_sensor(std::size_t i, double range) {
    set(i, Beam::Ok, range, BeamCode::OtherSensor);
  }
  void set_free(std::size_t i) { set(i, Beam::Free, range_max, BeamCode::BeyondRange); }
  void set_invalid(std::size_t i, BeamCode code) { set(i, Beam::Invalid, range_max, code); }

 private:
  void set(std::size_t i, Beam s, double range, BeamCode code) {
    ranges[i] = range;
    status[i] = s;
    codes[i] = code;
  }
};

/// Unit vectors of a scan's beams, cached while the scanner stays the same.
class BeamDirections {
 public:
  /// B vectors in a frame in which the scanner's heading is `heading` [rad].
  const std::vector<Vec2>& of(const LaserScan& scan, double heading = 0);

 private:
  std::vector<Vec2> directions_{};
  double angle_min_ = 0, angle_increment_ = 0, heading_ = 0;  // [rad] of the cached vectors
};

/// True if no number is infinite or NaN. Fast enough for all ranges of a scan.
bool all_finite(std::span<const double> numbers);

// A beam packed into one uint16, as in the record and its viewers: millimetres, free, or a code.
// Ranges are clipped below the codes.
constexpr std::uint16_t kPackedFree = 65535;
constexpr std::uint16_t kPackedCodeBase = 65519;  // + BeamCode (1..15) = 65520..65534
constexpr std::uint16_t kPackedMaxRange = 65519;  // [mm]

/// Packs beam `i` of `scan`; rounds a range to the nearest millimetre.
inline std::uint16_t pack_beam(const LaserScan& scan, std::size_t i) {
  if (scan.status[i] == Beam::Free) return kPackedFree;
  if (scan.status[i] == Beam::Invalid) {
    const auto code = static_cast<std::uint16_t>(scan.codes[i]);
    return static_cast<std::uint16_t>(kPackedCodeBase + (code == 0 ? 1 : code));
  }
  // Adding this number leaves no bits for a fraction: it rounds as nearbyint(), which is a call
  // without SSE 4.1. This fails beyond 2^51, where the range is clipped anyway.
  constexpr double kNoFraction = 0x1.8p52;
  const double mm = (scan.ranges[i] * 1000.0 + kNoFraction) - kNoFraction;
  if (!(mm > 0)) return 0;
  return mm >= kPackedMaxRange ? kPackedMaxRange : static_cast<std::uint16_t>(mm);
}

/// Packs all beams of `scan`, with the same result as pack_beam(). `out` must have room for them.
void pack_beams(const LaserScan& scan, std::span<std::uint16_t> out);

inline void unpack_beam(LaserScan& scan, std::size_t i, std::uint16_t packed) {
  if (packed == kPackedFree) {
    scan.set_free(i);
  } else if (packed > kPackedMaxRange) {
    scan.set_invalid(i, static_cast<BeamCode>(packed - kPackedCodeBase));
  } else {
    scan.set_ok(i, static_cast<double>(packed) / 1000.0);
  }
}

/// Rounds every range to a value that a packed beam can hold. Every Robot calls it before a scan
/// leaves the port, so that a stored run replays to identical commands.
inline void quantise(LaserScan& scan) {
  for (std::size_t i = 0; i < scan.size(); ++i) unpack_beam(scan, i, pack_beam(scan, i));
}

}  // namespace algo
