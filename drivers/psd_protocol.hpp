// drivers/psd_protocol.hpp: the line of the adapter that reads the four distance sensors which look
// at the floor (docs/hardware.md, "Floor sensors").
//
//   $PSD,0000012345,1180,1182,1523,1519*A28E CR LF
//
// The adapter's clock [ms] in ten digits, four counts of its 12-bit converter in four digits each
// (far left, far right, near left, near right), and a CRC of the characters between $ and * in four
// capital hexadecimal digits. Every line has the same length. No I/O and no clock.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "algo/terrain/psd_curve.hpp"
#include "drivers/bytes.hpp"
#include "drivers/frame_reader.hpp"

namespace drivers::psd {

constexpr std::size_t kSensors = 4;
constexpr std::size_t kLineBytes = 42;  // with CR and LF
constexpr double kPeriod = 0.0383;      // [s] between two values of a GP2D12, and so of the lines

struct Reading {
  std::uint32_t clock_ms = 0;                    // of the adapter; it wraps
  std::array<std::uint16_t, kSensors> counts{};  // in the line's order
  bool operator==(const Reading&) const = default;
};

/// CRC-16 with polynomial 0x1021 from 0xFFFF, high bit first: 0x29B1 for "123456789".
std::uint16_t crc(ByteView bytes);

/// The line, with CR and LF. Counts beyond the converter are its last.
FixedBytes<kLineBytes> line_of(const Reading& reading);

/// `frame` is a line without CR and LF; nothing if it is no line, or damaged.
std::optional<Reading> parse(ByteView frame);

/// The lines in a stream, without CR and LF.
struct Framing {
  static constexpr std::size_t kLongest = kLineBytes - 2;
  FrameStart start(ByteView bytes) const;
  bool intact(ByteView frame) const { return parse(frame).has_value(); }
};
using Reader = FrameReader<Framing>;

}  // namespace drivers::psd
