// db/turned_scan.hpp: a scan predicted from an earlier one of a robot that has turned since.
//
// Turning moves what is seen along the beams. A scanner with two interlaced mirror turns fires its
// even and odd beams half a sweep apart, so the two move by different amounts. Where an amount is
// no whole beam, the expected range lies on the line between two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
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
  /// The turn after which the reference is most like `samples`, which are as many; near enough.
  /// Nothing where every sample is more like its left neighbour.
  std::optional<Turn> find(std::span<const std::byte> samples);

 private:
  void move_reference(std::uint8_t turn, std::vector<std::uint16_t>& out) const;
  void try_turn(int turn);
  void refine(int off);

  std::size_t count_ = 0;
  std::vector<std::uint16_t> reference_{};  // with margins of kFarthest + 1
  std::vector<std::uint16_t> expected_{};
  std::vector<std::uint16_t> moved_{};
  std::vector<std::uint16_t> scan_{};
  std::vector<std::uint8_t> differences_{};
  std::array<std::uint32_t, 2> least_{};  // differences, of even and odd samples
  Turn best_{};
};

}  // namespace db::detail
