// algo/terrain/ground_trials.hpp: twenty looks at one piece of ground, and what they say together.
//
// Source: Masuda et al. 2008, sections 5.3 and 5.4; equations.md H.
#pragma once

#include <array>
#include <cstddef>

#include "algo/terrain/class_vote.hpp"
#include "algo/terrain/ground_reader.hpp"

namespace algo {

/// What lies ahead of one side, or of both.
struct GroundFinding {
  GroundClass kind = GroundClass::Flat;
  double height = 0;      // [m] of a step, up positive; of a trench, Eq. 13's depth, negative
  double width = 0;       // [m] of a trench
  double slope = 0;       // [rad] of a slope, up positive, against the ground under the robot
  double confidence = 1;  // share of the trials that voted for it
};

/// Trials of one side while the robot moves slowly. Values are means over the trials that voted for
/// the winner; for steps the median of them, since trials on the riser pull the mean down (ours).
class GroundTrials {
 public:
  GroundTrials() = default;
  GroundTrials(const FloorSensors& sensors, const FlatRanges& flat)
      : sensors_(sensors), flat_(flat) {}

  void restart();
  /// A look taken `way` [m] ahead of some fixed place; ignored once twenty are taken. A trench that
  /// the last of them still sees is followed to its end, for `widest` [m] at most.
  void add(const GroundLook& look, double way, double widest);
  std::size_t count() const { return count_; }
  bool done() const { return count_ == kGroundTrials && !in_trench_; }
  GroundFinding finding() const;

 private:
  struct Trial {
    GroundClass kind = GroundClass::Flat;
    double far = 0, near = 0;  // [m]
    double way = 0;            // [m]
  };
  double mean_or_median_height(GroundClass kind) const;
  double width() const;
  bool up_a_riser() const;
  GroundFinding riser(double confidence) const;

  FloorSensors sensors_{};
  FlatRanges flat_{};
  std::array<Trial, kGroundTrials> trials_{};
  std::size_t count_ = 0;
  bool in_trench_ = false;
  bool open_end_ = false;  // the trench did not end within `widest`
  bool trench_seen_ = false;
  double trench_from_ = 0;  // [m] of the way
  double trench_to_ = 0;
  int trench_looks_ = 0;
};

}  // namespace algo
