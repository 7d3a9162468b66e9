// drivers/lms200_scan.hpp: measured values of an LMS2xx, whole or in partial scans, as LaserScans.
//
// The low bits of a value word are a distance and its high bits are flags about the target. The
// measuring mode read back from the device says which bits are which. The highest nine distance
// values are codes, never distances.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "algo/laser_scan.hpp"
#include "drivers/bytes.hpp"
#include "drivers/lms200_protocol.hpp"
#include "drivers/lms200_telegram.hpp"

namespace drivers::lms200 {

constexpr double kTurnPeriod = 13.32e-3;  // [s] of the mirror

/// Bytes of the telegram of a whole scan of `variant`.
std::size_t scan_bytes(const Variant& variant);
/// Whether a line of `baud` [bit/s] can carry whole scans of `variant`. 180 degrees in steps of
/// 0.25 come as one partial scan per mirror turn, four in all: too fast for a slow line.
bool carries(const Variant& variant, unsigned baud);
/// [s] between two streamed scans at `baud`. A slow line loses the scans in between, and one more
/// while the device gets ready. Source: the manual.
double scan_period(const Variant& variant, unsigned baud);

/// Counters of the device, modulo 256, sent when the configuration asks for them.
struct Indices {
  std::uint8_t turn = 0;  // of the mirror
  std::uint8_t telegram = 0;
  bool operator==(const Indices&) const = default;
};

/// Values of a telegram; valid as long as the telegram.
struct MeasuredValues {
  bool in_millimetres = false;  // else centimetres
  bool partial = false;
  std::uint8_t part = 0;      // partial scans start at part * 0.25 degrees
  bool range = false;         // only part of a scan, from `first` on
  std::uint16_t first = 1;    // number of the first value, counted from 1
  std::uint8_t averaged = 1;  // scans in each mean value
  ByteView words{};           // two bytes a value
  std::optional<Indices> indices{};
  Health health{};

  std::size_t size() const { return words.size() / 2; }
  std::uint16_t word(std::size_t i) const { return word_at(words, 2 * i); }
};

/// The values of an answer of any kind; nullopt when `telegram` has none, or when its length does
/// not match its count of values.
std::optional<MeasuredValues> measured_values(const Telegram& telegram);

/// The bit layout of a measuring mode's words.
struct WordFormat {
  std::uint16_t mask = 0x1FFF;  // bits of the distance
  std::uint16_t top = 0x1FFF;   // the code for no echo; values from top - 8 on are codes

  bool operator==(const WordFormat&) const = default;
};

/// nullopt for unknown modes and for modes without distances (3F: energy).
std::optional<WordFormat> word_format(std::uint8_t measuring_mode);

/// Converts measured values to scans. `variant` and `format` are as the device reports them.
class ScanDecoder {
 public:
  ScanDecoder(const Variant& variant, const WordFormat& format)
      : variant_(variant), format_(format) {}

  /// Converts a whole scan or a range of one, not a partial scan. Fills all of `scan` except mount
  /// and stamp, which the caller sets. False, without a change, when the values do not fit the
  /// variant. Allocates only when `scan` has never had so many beams.
  bool decode(const MeasuredValues& values, algo::LaserScan& scan) const;

  /// Sets the fields of `scan` other than its beams. `first` counts from 0.
  void prepare(bool in_millimetres,
               std::size_t first,
               std::size_t beams,
               algo::LaserScan& scan) const;
  /// Stores `word` as beam `i` of `scan`, after prepare().
  void decode_word(std::uint16_t word,
                   bool in_millimetres,
                   std::size_t i,
                   algo::LaserScan& scan) const;
  const Variant& variant() const { return variant_; }

 private:
  Variant variant_{};
  WordFormat format_{};
};

/// Joins the partial scans of one sweep: parts 0 and 2 for a step of 0.5 degrees, parts 0, 1, 2 and
/// 3 for 0.25, in this order. A sweep that lacks a part is dropped whole: joining beams of
/// different sweeps would assume that the robot stood still in between.
class PartialScans {
 public:
  /// `variant` may also be 180 degrees with a step of 0.25, which exists only interlaced.
  PartialScans(const Variant& variant, const WordFormat& format) : decoder_(variant, format) {}

  /// Adds the next partial scan. True once `scan` is whole; until then `scan` holds the parts so
  /// far, so pass the same object each time. The caller sets the stamp, that of the last part.
  bool add(const MeasuredValues& values, algo::LaserScan& scan);

  std::uint64_t dropped_sweeps() const { return dropped_; }

 private:
  bool follows(const MeasuredValues& values) const;

  ScanDecoder decoder_;
  std::uint32_t turn_ = 0;  // next part of the sweep; 0: no sweep begun
  bool in_millimetres_ = false;
  std::optional<Indices> last_{};
  std::uint64_t dropped_ = 0;
};

}  // namespace drivers::lms200
