// server/lab/reproduce/filter_figures.hpp: figures of a filter's effect on a scan.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/lab/reproduce/filter_references.hpp"
#include "server/lab/reproduce/filter_scenes.hpp"

namespace server {

// Thresholds of the tables and the verdicts.
constexpr double kImpulse_mm = 50;        // a value farther than this from the truth is wrong
constexpr double kEdge_mm = 300;          // a jump of the truth between two beams is an edge
constexpr double kEdgeTolerance = 0.1;    // of the jump: a value farther off blurs the edge
constexpr double kLogImpulse_mm = 300;    // an outlier is farther off its neighbours' mean ...
constexpr double kLogAgree_mm = 150;      // ... while they differ by less than this
constexpr double kLogEdge_mm = 500;       // a jump this large in a recording is an edge
constexpr double kLogFlat_mm = 100;       // neighbours that differ by less lie on one surface
constexpr double kWholeTolerance = 1e-6;  // [steps]

/// One filter on one scene or recording. A figure that does not apply is empty.
struct FilterFigures {
  std::string filter{};
  /// Scene: values that differ from the truth by more than kImpulse_mm, without edges and corners.
  /// Recording: outliers() per scan.
  double impulses = 0;
  std::optional<double> height_left{};  // largest share of a spike left in its beam
  std::optional<double> edge_shift{};   // [beams] of the half-height crossing, mean per edge
  std::optional<double> edge_blur{};    // [beams] off by > kEdgeTolerance, mean per edge
  /// RMS of the second difference on quiet stretches, after / before: the beam-to-beam oscillation.
  std::optional<double> oscillation{};
  double not_in_window = 0;        // share of values that equal no sample of their window
  double not_whole = 0;            // share that is no multiple of the device's step
  std::optional<double> rms_mm{};  // against the truth, all values
};

FilterFigures judge_scene(const FilterScene& scene,
                          std::string_view filter,
                          std::span<const double> after_mm,
                          int half_width);

FilterFigures judge_recording(const Recording& recording,
                              const StudyFilter& filter,
                              int half_width);

/// Number of single-beam outliers: the beam's neighbours differ by less than kLogAgree_mm, and the
/// beam differs from their mean by more than kLogImpulse_mm.
std::size_t outliers(const ScanValues& scan);

}  // namespace server
