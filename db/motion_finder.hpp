// db/motion_finder.hpp: where in the map of earlier scans the next one lies.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "db/range_map.hpp"

namespace db::detail {

/// Only packing needs it: what it finds is stored, so its own arithmetic may be anybody's.
/// Keeps its buffers.
class MotionFinder {
 public:
  /// What takes part in a step of fitting.
  struct Fit {
    double most_error = 0;  // [mm] by which a sample may be off
    std::size_t step = 2;   // to the next sample, even: of the same mirror turn
  };
  /// The motion after which the map predicts `samples` best, near enough; they are of its shape.
  /// Nothing where every sample is more like its left neighbour.
  std::optional<Motion> find(const RangeMap& map, std::span<const std::byte> samples);

 private:
  static constexpr std::size_t kUnknowns = 2 * kKnots + 2;
  using Vector = std::array<double, kUnknowns>;

  /// What a cell tells of the motion.
  struct Cell {
    double range = 0;               // [mm]
    double step = 0;                // [mm] to the next cell
    double slope = 0;               // [mm] a beam, over more cells
    std::array<double, 2> shift{};  // [mm] by which a shift of 1 mm ahead, or left, changes it
    bool usable = false;
  };
  /// Every second sample of [begin, end): those between two knots of their broken line.
  struct Stretch {
    std::size_t knot = 0;  // the first of the two, of all unknowns
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  /// The normal equations of a stretch: of the turns at its knots and of the shift.
  struct Sums {
    std::array<std::array<double, 4>, 4> normal{};  // the upper triangle
    std::array<double, 4> right{};
    double left_over = 0;  // [mm]
  };

  void lay_lines(std::size_t count);
  void take_samples(std::span<const std::byte> samples);
  void take_cells(const RangeMap& map);
  std::size_t index(std::int32_t cell) const;
  void turn_whole_beams(std::size_t parity);
  Sums sum_up(const Stretch& stretch, const Fit& fit) const;
  void refine(const Fit& fit);
  Motion rounded() const;

  std::int32_t first_cell_ = 0;
  std::vector<Cell> cells_{};
  std::vector<std::int32_t> ranges_{};   // [mm] of the cells
  std::vector<std::int32_t> samples_{};  // [mm]
  std::vector<double> parts_{};          // of the way from a sample's knot to the next, of each
  std::array<Stretch, 2 * (kKnots - 1)> stretches_{};
  Vector found_{};        // the turns [beams] of even and odd samples, then the shift [mm]
  double left_over_ = 0;  // [mm] by which the samples differed at the last fit
};

}  // namespace db::detail
