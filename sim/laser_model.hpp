// sim/laser_model.hpp: what an LMS200 reports of a world: when its beams are fired and what goes
// wrong with them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/random.hpp"
#include "sim/sensor.hpp"

namespace sim {

/// Numbers of one sweep, one entry a beam unless said otherwise. Nothing in it outlives the sweep:
/// all scanners of a thread take turns with one, which so stays in the processor's cache.
struct LaserWorkspace {
  Rays way{};  // x and y, one mirror turn after another
  std::vector<double> way_turns{};
  Rays rays{};
  std::vector<double> ranges{};
  std::vector<std::uint32_t> hits{};
  std::vector<double> draws{};
  std::vector<double> turns{};             // [rad] of the scanner off the reference at a beam
  std::vector<std::uint8_t> edge_flags{};  // between a beam and the next; the last stays 0
  std::vector<std::uint32_t> edges{};      // beams whose spot may lie on an edge, in front
  Rays more{};                             // further rays for each of them
  std::vector<std::uint32_t> first{};      // of those rays, for each beam
  std::vector<double> more_ranges{};
  std::vector<std::uint32_t> more_hits{};
  std::vector<double> spot_ranges{};  // rows as judge_spots() has them
  std::vector<std::uint32_t> spot_hits{};

  void resize(std::size_t beams);
};

/// What is wrong with the configuration as a sentence part, or nothing.
std::optional<std::string> defect(const LaserConfig& config);

/// One simulated scanner and its own slice of the world.
///
/// The mirror turns without pause from the start of the run. A beam leaves at its own time and from
/// where the robot is then; a scan is delivered when its last turn is over, so that a tick without
/// a new one is normal. With `rolling` off, every call brings a scan of that instant.
///
/// Order of effects: ray, surface (reflectivity), spot (mixed pixels), bias and noise, rounding;
/// then pepper, salt and dropout, each from a generator of its own.
class LaserModel final : public CastingSensor {
 public:
  /// Scanner `index` of a run with `seed`. Throws std::invalid_argument with the defect.
  LaserModel(const LaserConfig& config, std::uint64_t seed, std::uint32_t index);

  /// [s] How far back in time a scan reaches at most: the newest sweep may have ended almost one
  /// sweep ago.
  double memory() const override;

  void add(const algo::Obstacle& obstacle) override;
  void remove(std::uint32_t id) override;
  void sense(const Surroundings& around, algo::Observation& observation) override;

  /// Fills `scan` with the newest sweep completed by `now` [s, run clock]. False when that one was
  /// delivered before; `scan` is then meaningless.
  bool sense(double now, const PoseTrail& trail, algo::LaserScan& scan);

 private:
  /// Marks in `hits` a surface that sent too little light back.
  static constexpr std::uint32_t kNoEcho = RangeCaster::kNothing - 1;

  void note_surfaces();
  void aim(double end, const PoseTrail& trail);
  std::size_t follow_motion(const StepClock& clock, std::size_t first);
  void aim_still();
  void allow_for_spot();
  void apply_surfaces(const Rays& rays,
                      std::span<double> ranges,
                      std::span<std::uint32_t> hits) const;
  void mix_pixels();
  void mark_edges();
  void judge();
  void report(algo::LaserScan& scan);
  void spoil(algo::LaserScan& scan);

  LaserConfig config_{};
  BeamPattern pattern_{};
  bool plain_ = true;  // no surface in the world is too dark within range, none is specular

  Random noise_;
  RareEvents dropout_;
  RareEvents salt_;
  RareEvents pepper_;
  Reading reading_{};            // with the bias of this run
  double phase_ = 0;             // [s] run-clock time at which the first turn begins
  std::uint64_t delivered_ = 0;  // sweeps

  std::size_t spots_ = 0;

  // Tables, one entry a beam.
  std::vector<double> fired_{};      // [s] after the sweep's start, one mirror turn after another
  std::vector<double> ux_{}, uy_{};  // directions in the scanner's frame

  // Of the sweep at hand.
  std::vector<algo::Pose2> motion_{};  // the scanner at the physics steps
  algo::Pose2 reference_W_{};
  RaySpread spread_{};
  LaserWorkspace* work_ = nullptr;  // the thread's
};

}  // namespace sim
