// db/turned_scan.hpp: a scan predicted from an earlier one of a robot that has turned since, as in
// blocks of format 2, which are read but no longer written.
//
// Turning moves what is seen along the beams. A scanner with two interlaced mirror turns fires its
// even and odd beams half a sweep apart, so the two move by different amounts. Where an amount is
// no whole beam, the expected range lies on the line between two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace db::detail {

/// By how many quarters of a beam even and odd samples have moved, plus kNotTurned.
using Turn = std::array<std::uint8_t, 2>;
constexpr int kQuarters = 4;
constexpr int kFarthest = 8;  // [beams]
constexpr std::uint8_t kNotTurned = kFarthest * kQuarters;
constexpr std::uint8_t kMostTurned = 2 * kNotTurned;

/// Predicts scans from references. Keeps its buffers.
class TurnedScan {
 public:
  /// The scan that later ones are predicted from: little-endian samples.
  void set_reference(std::span<const std::byte> samples);
  /// What is expected after `turn`, valid until the next call; beyond the reference's ends its last
  /// samples count. Both parts of `turn` are at most kMostTurned.
  std::span<const std::uint16_t> expect(const Turn& turn);

 private:
  void move_reference(std::uint8_t turn, std::vector<std::uint16_t>& out) const;

  std::size_t count_ = 0;
  std::vector<std::uint16_t> reference_{};  // with margins of kFarthest + 1
  std::vector<std::uint16_t> expected_{};
  std::vector<std::uint16_t> moved_{};
};

}  // namespace db::detail
