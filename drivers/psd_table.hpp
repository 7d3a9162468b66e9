// drivers/psd_table.hpp: the calibration of one Sharp GP2D12: from a voltage to a distance.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace drivers::psd {

struct TablePoint {
  double volts = 0;   // [V] of the sensor's output
  double metres = 0;  // [m] from the sensor to the surface
  bool operator==(const TablePoint&) const = default;
};

/// The mistake in `table`, as the end of a sentence; nothing if it can be used.
std::optional<std::string> defect(const std::vector<TablePoint>& table);

/// Measured points, linear in 1 / distance between them, and beyond them along the last two.
/// Without any, the curve of a usual sensor (algo/terrain/psd_curve.hpp); single sensors differ
/// from it by some centimetres.
class Table {
 public:
  Table() = default;
  /// From near to far. Throws std::invalid_argument for a table with a defect.
  explicit Table(std::vector<TablePoint> points);

  /// [m] for an output of `volts`; NaN outside of the sensor's range, and where it is so high that
  /// the curve folds back.
  double distance(double volts) const;
  const std::vector<TablePoint>& points() const { return points_; }

 private:
  double interpolated(double volts) const;

  std::vector<TablePoint> points_{};
};

}  // namespace drivers::psd
