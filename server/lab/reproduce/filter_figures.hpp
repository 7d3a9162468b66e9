// server/lab/reproduce/filter_figures.hpp: what a filter did to a scan, as numbers.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/lab/reproduce/filter_references.hpp"
#include "server/lab/reproduce/filter_scenes.hpp"

namespace server {

// What counts as what, in the tables and in the verdicts alike.
constexpr double kImpulse_mm = 50;        // a value farther off the truth than that is wrong
constexpr double kEdge_mm = 300;          // a jump of the truth between two beams is an edge
constexpr double kEdgeTolerance = 0.1;    // of the jump: a value farther off blurs the edge
constexpr double kLogImpulse_mm = 300;    // off the mean of both neighbours ...
constexpr double kLogAgree_mm = 150;      // ... when those are within this of each other
constexpr double kLogEdge_mm = 500;       // a jump in a recording
constexpr double kLogFlat_mm = 100;       // between neighbours that lie on one surface
constexpr double kWholeTolerance = 1e-6;  // [steps]

/// One filter on one scene or recording. A figure that does not exist there is nothing.
struct FilterFigures {
  std::string filter{};
  /// Scene: values off the truth by more than kImpulse_mm, edges and corners left out. Recording:
  /// values off both neighbours, per scan.
  double impulses = 0;
  std::optional<double> height_left{};  // largest share of a spike's height left in its own beam
  std::optional<double> edge_shift{};   // [beams] of the half-height crossing, mean over the edges
  std::optional<double> edge_blur{};    // [beams] off by more than kEdgeTolerance, mean per edge
  /// RMS of the second difference on quiet stretches, after / before: the beam-to-beam oscillation.
  std::optional<double> oscillation{};
  double not_in_window = 0;        // share of the values that no sample of their window has
  double not_whole = 0;            // share that is no whole number of the device's steps
  std::optional<double> rms_mm{};  // against the truth, all values
};

FilterFigures judge_scene(const FilterScene& scene,
                          std::string_view filter,
                          std::span<const double> after_mm,
                          int half_width);

FilterFigures judge_recording(const Recording& recording,
                              const StudyFilter& filter,
                              int half_width);

/// Number of single-beam outliers: neighbours within kLogAgree_mm of each other, the beam off their
/// mean by more than kLogImpulse_mm.
std::size_t outliers(const ScanValues& scan);

}  // namespace server
