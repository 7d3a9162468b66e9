// sim/laser_model.hpp: the LMS200 model: when its beams are fired, and the errors of its readings.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/random.hpp"
#include "sim/sensor.hpp"
#include "sim/space_pose.hpp"
#include "sim/spot_kernel.hpp"

namespace sim {

/// A ray in W; `way_W` has length 1.
struct SpaceRay {
  algo::Vec3 from_W{0, 0, 0};
  algo::Vec3 way_W{1, 0, 0};
};

/// Workspace of one sweep, one entry per beam unless noted. Nothing in it outlives the sweep. All
/// scanners of a thread share one, which thus stays in the processor's cache.
struct LaserWorkspace {
  std::vector<SpaceRay> space{};  // on ground that is not level
  std::vector<SpacePose> space_poses{};
  Rays way{};  // x and y, one mirror turn after another
  std::vector<double> way_turns{};
  Rays rays{};
  std::vector<double> ranges{};
  std::vector<std::uint32_t> hits{};
  std::vector<double> draws{};
  std::vector<double> turns{};             // [rad] between scanner and reference at each beam
  std::vector<std::uint8_t> edge_flags{};  // between a beam and the next; the last stays 0
  std::vector<std::uint32_t> edges{};      // beams whose spot may lie on an edge, packed in front
  Rays more{};                             // further rays of these beams
  std::vector<std::uint32_t> first{};      // index of each beam's first such ray
  std::vector<double> more_ranges{};
  std::vector<std::uint32_t> more_hits{};
  std::vector<double> spot_ranges{};  // rows as in judge_spots()
  std::vector<std::uint32_t> spot_hits{};

  void resize(std::size_t beams);
};

/// The defect of the configuration as part of a sentence, or nothing.
std::optional<std::string> defect(const LaserConfig& config);

/// One simulated scanner with its own slice of the world.
///
/// The mirror turns continuously from the start of the run. Each beam is fired at its own time,
/// from the robot's pose at that time. A scan is delivered after its last turn, so a tick without a
/// new scan is normal. With `rolling` off, every call gives a scan of that instant.
///
/// Order of effects: ray, surface (reflectivity), spot (mixed pixels), bias and noise, rounding;
/// then pepper, salt and dropout, each with its own generator.
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

  /// Fills `scan` with the newest sweep completed by `now` [s, run clock]. False if that sweep was
  /// delivered before; `scan` is then meaningless. With `solids`, the ground is not level: the
  /// beams are cast in space, from the trail's tilts.
  bool sense(double now,
             const PoseTrail& trail,
             algo::LaserScan& scan,
             const SolidCaster* solids = nullptr);

 private:
  /// Marks in `hits` a surface that returned too little light.
  static constexpr std::uint32_t kNoEcho = RangeCaster::kNothing - 1;
  /// Marks the floor in `hits`.
  static constexpr std::uint32_t kFloor = RangeCaster::kNothing - 2;

  enum class Echo : std::uint8_t { Returned, Reflected, Dark };
  /// A ray of a spot, beside its middle one.
  struct SpotRay {
    double aside = 0;  // [m] to the left
    algo::Vec2 way{1, 0};
  };
  static std::array<SpotRay, kSpotRays - 1> spot_rays();
  static Echo echo_of(const algo::Obstacle& surface, double range, double cosine);

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
  void cast_in_plane(double end, const PoseTrail& trail, bool surfaces);
  void cast_in_space(double end, const PoseTrail& trail, const SolidCaster& solids);
  void cast_one(const SpaceRay& ray,
                const SolidCaster& solids,
                double& range,
                std::uint32_t& number) const;
  void cast_spots(const SolidCaster& solids);
  void report(algo::LaserScan& scan, bool echoes);
  void spoil(algo::LaserScan& scan);

  LaserConfig config_{};
  BeamPattern pattern_{};
  bool plain_ = true;  // no surface is specular, or too dark within range

  Random noise_;
  RareEvents dropout_;
  RareEvents salt_;
  RareEvents pepper_;
  Reading reading_{};            // with the bias of this run
  double phase_ = 0;             // [s] run-clock time at which the first turn begins
  std::uint64_t delivered_ = 0;  // sweeps

  std::size_t spots_ = 0;

  // Tables, one entry per beam.
  std::vector<double> fired_{};      // [s] after the sweep's start, one mirror turn after another
  std::vector<double> ux_{}, uy_{};  // directions in the scanner's frame

  // Of the present sweep.
  std::vector<algo::Pose2> motion_{};  // the scanner's poses at the physics steps
  algo::Pose2 reference_W_{};
  algo::Vec3 up_W_{0, 0, 1};  // across the scan plane, where the ground is not level
  RaySpread spread_{};
  LaserWorkspace* work_ = nullptr;  // the thread's
};

}  // namespace sim
