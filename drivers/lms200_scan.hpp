// drivers/lms200_scan.hpp: measured values of an LMS2xx, whole or in partial scans, as LaserScans.
//
// A value word is a distance in its low bits, and flags that change with what the scanner sees in
// its upper ones; which is which depends on the measuring mode read back from the device. The
// highest nine distances are codes and never distances.
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

/// Bytes of the telegram that brings a whole scan of `variant`.
std::size_t scan_bytes(const Variant& variant);
/// Whether a line of `baud` [bit/s] carries whole scans of `variant`. 180 degrees in steps of 0.25
/// come as four partial scans, one each mirror turn, which a slow line cannot keep up with.
bool carries(const Variant& variant, unsigned baud);
/// [s] between two scans that are streamed at `baud`. A slow line loses those in between, and one
/// more while the device gets ready: the manual's figures.
double scan_period(const Variant& variant, unsigned baud);

/// Counters of the device, modulo 256, sent when the configuration asks for them.
struct Indices {
  std::uint8_t turn = 0;  // of the mirror
  std::uint8_t telegram = 0;
  bool operator==(const Indices&) const = default;
};

/// Values as they are in a telegram, as long as that is valid.
struct MeasuredValues {
  bool in_millimetres = false;  // else centimetres
  bool partial = false;
  std::uint8_t part = 0;      // partial scans start at part * 0.25 degrees
  bool range = false;         // some values of a scan, from `first` on
  std::uint16_t first = 1;    // number of the first value, counted from 1
  std::uint8_t averaged = 1;  // scans the values are means of
  ByteView words{};           // two bytes a value
  std::optional<Indices> indices{};
  Health health{};

  std::size_t size() const { return words.size() / 2; }
  std::uint16_t word(std::size_t i) const { return word_at(words, 2 * i); }
};

/// The values of an answer of any kind that has them; nothing when `telegram` has none or when its
/// length is not what its count of values says.
std::optional<MeasuredValues> measured_values(const Telegram& telegram);

/// How the words of a measuring mode are read.
struct WordFormat {
  std::uint16_t mask = 0x1FFF;  // bits of the distance
  std::uint16_t top = 0x1FFF;   // the code for no echo; from top - 8 on there is no distance

  bool operator==(const WordFormat&) const = default;
};

/// Nothing for modes whose words are no distances (3F: energy) or that are not known.
std::optional<WordFormat> word_format(std::uint8_t measuring_mode);

/// Turns measured values into scans. `variant` and `format` are those the device said it has.
class ScanDecoder {
 public:
  ScanDecoder(const Variant& variant, const WordFormat& format)
      : variant_(variant), format_(format) {}

  /// Values of a whole scan or of a range, not of a partial scan. Fills all of `scan` but its mount
  /// and its stamp, which the caller knows; false and no change when the values are not such as
  /// this variant has. Allocates only when `scan` has never had so many beams.
  bool decode(const MeasuredValues& values, algo::LaserScan& scan) const;

  /// Sets what `scan` has apart from its beams. `first` counts from 0.
  void prepare(bool in_millimetres,
               std::size_t first,
               std::size_t beams,
               algo::LaserScan& scan) const;
  /// Word `word` as beam `i` of a scan that prepare() has seen.
  void decode_word(std::uint16_t word,
                   bool in_millimetres,
                   std::size_t i,
                   algo::LaserScan& scan) const;
  const Variant& variant() const { return variant_; }

 private:
  Variant variant_{};
  WordFormat format_{};
};

/// Puts the partial scans of one sweep together: of a step of 0.5 degrees the parts 0 and 2, of
/// 0.25 the parts 0, 1, 2 and 3, in this order. A sweep that lacks one is dropped whole: beams of
/// different sweeps would say that the robot stood still in between.
class PartialScans {
 public:
  /// `variant` may have 180 degrees and a step of 0.25, which exists in no other way.
  PartialScans(const Variant& variant, const WordFormat& format) : decoder_(variant, format) {}

  /// Takes in the next partial scan. True when `scan` has become whole by it; until then `scan`
  /// holds what has come, so that the same one has to be given again. The stamp is the caller's,
  /// of the last part.
  bool add(const MeasuredValues& values, algo::LaserScan& scan);

  std::uint64_t dropped_sweeps() const { return dropped_; }

 private:
  bool follows(const MeasuredValues& values) const;

  ScanDecoder decoder_;
  std::uint32_t turn_ = 0;  // next within the sweep; 0 when none has begun
  bool in_millimetres_ = false;
  std::optional<Indices> last_{};
  std::uint64_t dropped_ = 0;
};

}  // namespace drivers::lms200
