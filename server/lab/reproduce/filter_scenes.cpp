// server/lab/reproduce/filter_scenes.cpp: casts the scenes and reads the recordings.
#include "server/lab/reproduce/filter_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "algo/units.hpp"
#include "sim/laser_model.hpp"
#include "sim/replay.hpp"
#include "sim/vehicle.hpp"

namespace server {
namespace {

using namespace algo::units;

constexpr std::size_t kBeams = 360;  // the thesis filters 360 of the scanner's 361 values
constexpr double kTick = 0.026;      // [s]
constexpr double kFar_mm = 8000;
constexpr double kNear_mm = 200;

algo::Obstacle cylinder(std::uint32_t id, double x, double y, double radius) {
  return {.id = id, .pose_W = {x, y, 0}, .shape = algo::Cylinder{radius}};
}

/// A wall across the way ahead and one on either side.
std::vector<algo::Obstacle> room(double ahead, double aside) {
  const double up = std::numbers::pi / 2;
  return {{.id = 100, .pose_W = {ahead + 0.05, 0, up}, .shape = algo::Wall{20, 0.1}},
          {.id = 101, .pose_W = {0, aside + 0.05, 0}, .shape = algo::Wall{20, 0.1}},
          {.id = 102, .pose_W = {0, -aside - 0.05, 0}, .shape = algo::Wall{20, 0.1}}};
}

FilterScene scene(const std::string& name,
                  const std::string& title,
                  int half_width,
                  const std::vector<algo::Obstacle>& obstacles,
                  std::vector<Spike> spikes,
                  std::uint64_t seed) {
  sim::LaserConfig config = sim::LaserConfig::ideal(0.5);
  config.noise = 5_mm;
  sim::LaserModel laser(config, seed, 0);
  sim::RangeCaster caster(config.height);
  for (const algo::Obstacle& obstacle : obstacles) {
    laser.add(obstacle);
    caster.add(obstacle);
  }
  sim::PoseTrail trail(sim::Substeps(kTick).length, laser.memory());
  trail.reset({}, 0);
  algo::LaserScan scan;
  if (!laser.sense(0, trail, scan)) throw std::logic_error("the scanner gave no scan");
  std::vector<double> exact(scan.size());
  caster.cast(
      {},
      {.angle_min = scan.angle_min, .angle_increment = scan.angle_increment, .beams = scan.size()},
      config.range_max,
      exact);

  FilterScene out{
      .name = name, .title = title, .half_width = half_width, .spikes = std::move(spikes)};
  for (std::size_t i = 0; i < kBeams; ++i) {
    out.truth_mm.push_back(exact[i] * 1000);
    out.before_mm.push_back(std::nearbyint(scan.ranges[i] * 1000));
  }
  for (const Spike& spike : out.spikes) out.before_mm.at(spike.beam) = spike.mm;
  return out;
}

std::vector<Spike> first_spikes() {
  return {{186, kNear_mm}, {264, kFar_mm}, {266, kFar_mm}, {272, kFar_mm}, {292, kFar_mm}};
}

ScanValues values_of(const algo::LaserScan& scan) {
  ScanValues out;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    // A beam without a return counts as range_max, as in ScanFilter.
    const double range = scan.status[i] == algo::Beam::Ok ? scan.ranges[i] : scan.range_max;
    out.mm.push_back(std::nearbyint(range * 1000));
    out.valid.push_back(scan.status[i] == algo::Beam::Invalid ? 0 : 1);
  }
  return out;
}

Recording read_recording(const std::filesystem::path& file) {
  sim::Replay replay(file);
  Recording out{.name = file.stem().string(),
                .step_mm = replay.unit() == sim::CarmenUnit::Centimetre ? 10.0 : 1.0};
  algo::Observation seen;
  replay.reset(seen);
  out.scans.push_back(values_of(seen.scans[0]));
  while (out.scans.size() < replay.size()) {
    replay.step({}, seen);
    out.scans.push_back(values_of(seen.scans[0]));
  }
  return out;
}

}  // namespace

std::vector<FilterScene> chapter_3_scenes() {
  std::vector<algo::Obstacle> one = room(4, 2);
  one.push_back(cylinder(1, 2.0, 0, 0.5));
  std::vector<algo::Obstacle> two = room(4, 2);
  two.push_back(cylinder(1, 1.8, -0.9, 0.3));
  two.push_back(cylinder(2, 1.7, 0.6, 0.35));
  return {scene("one-obstacle", "One obstacle, five spikes", 1, one, first_spikes(), 1),
          scene("two-obstacles", "Two obstacles", 2, two, {}, 2),
          scene("two-obstacles-spike", "Two obstacles, one spike", 2, two, {{220, kFar_mm}}, 3)};
}

FilterScene flat_scene() {
  FilterScene out{
      .name = "flat", .title = "Flat reference", .half_width = 1, .spikes = first_spikes()};
  out.truth_mm.assign(kBeams, 3000);
  std::fill(out.truth_mm.begin() + 150, out.truth_mm.begin() + 211, 1500);
  out.before_mm = out.truth_mm;
  for (const Spike& spike : out.spikes) out.before_mm.at(spike.beam) = spike.mm;
  return out;
}

std::vector<Recording> read_recordings(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".log") files.push_back(entry.path());
  }
  if (error) {
    throw std::runtime_error(fmt::format("The folder {} cannot be read.", folder.string()));
  }
  if (files.empty()) {
    throw std::runtime_error(fmt::format("The folder {} holds no *.log.", folder.string()));
  }
  std::ranges::sort(files);
  std::vector<Recording> out;
  out.reserve(files.size());
  for (const std::filesystem::path& file : files) out.push_back(read_recording(file));
  return out;
}

Recording simulated_recording() {
  sim::LaserConfig config = sim::LaserConfig::with_resolution(0.5);
  config.salt = 0.01;
  config.pepper = 0.01;
  sim::LaserModel laser(config, 1, 0);
  for (const algo::Obstacle& wall : room(8, 2.5)) laser.add(wall);
  laser.add(cylinder(1, 2.0, 0.8, 0.3));
  laser.add(cylinder(2, 3.0, -0.9, 0.25));
  laser.add(cylinder(3, 4.5, 0.9, 0.2));
  laser.add({.id = 4, .pose_W = {5.5, -0.8, 0.4}, .shape = algo::Box{0.6, 0.4}});
  const sim::Substeps substeps(kTick);
  sim::PoseTrail trail(substeps.length, laser.memory());
  trail.reset({}, 0);

  Recording out{.name = "simulated", .step_mm = 1, .scans = {}, .simulated = true};
  algo::LaserScan scan;
  constexpr double kSpeed = 0.5;  // [m/s] straight ahead
  for (int tick = 1; out.scans.size() < 200; ++tick) {
    for (std::size_t k = 0; k < substeps.count; ++k) {
      trail.push({kSpeed * (trail.newest() + trail.step()), 0, 0});
    }
    if (laser.sense(kTick * tick, trail, scan)) out.scans.push_back(values_of(scan));
  }
  return out;
}

}  // namespace server
