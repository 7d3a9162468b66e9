// sim/laser_model.cpp: when a sweep ends, the origins of its beams, and its readings.
#include "sim/laser_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {
namespace {

using std::numbers::pi;

/// The random streams of one scanner.
enum class Purpose : std::uint64_t { Bias = 1, Phase, Noise, Dropout, Salt, Pepper };

Random stream(std::uint64_t seed, std::uint32_t index, Purpose purpose) {
  return Random(seed, (std::uint64_t{index} << 8) + static_cast<std::uint64_t>(purpose));
}

/// The scanner's pose when the robot is at `robot_W`. A scanner right over the centre needs no
/// sine.
algo::Pose2 scanner_W(const algo::Pose2& robot_W, const algo::Pose2& mount_R) {
  if (mount_R.x != 0 || mount_R.y != 0) return algo::compose(robot_W, mount_R);
  return {robot_W.x, robot_W.y, algo::wrap_angle(robot_W.heading + mount_R.heading)};
}

}  // namespace

LaserModel::LaserModel(const LaserConfig& config, std::uint64_t seed, std::uint32_t index)
    : CastingSensor(config.height),
      config_(checked(config, "Laser " + std::to_string(index + 1))),
      noise_(stream(seed, index, Purpose::Noise)),
      dropout_(stream(seed, index, Purpose::Dropout), config.dropout),
      salt_(stream(seed, index, Purpose::Salt), config.salt),
      pepper_(stream(seed, index, Purpose::Pepper), config.pepper) {
  const double steps = std::nearbyint(config_.field_of_view / config_.angle_increment);
  pattern_ = {
      -config_.field_of_view / 2, config_.angle_increment, static_cast<std::size_t>(steps) + 1};
  reading_ = {.bias = stream(seed, index, Purpose::Bias).uniform(-config_.bias, config_.bias),
              .noise = config_.noise,
              .per_metre = config_.unit == LaserUnit::Centimetre ? 100.0 : 1000.0,
              .range_max = config_.range_max,
              .most = algo::kPackedMaxRange / 1000.0};
  // Several scanners are not synchronised: each further one has its own phase.
  if (index > 0) phase_ = stream(seed, index, Purpose::Phase).uniform(0, config_.mirror_period);

  const std::size_t beams = pattern_.beams;
  fired_.reserve(beams);
  pattern_.aim(ux_, uy_);
  for (std::size_t turn = 0; turn < config_.turns; ++turn) {
    for (std::size_t i = turn; i < beams; i += config_.turns) {
      const double turned = static_cast<double>(turn) + (pattern_.angle(i) + pi / 2) / (2 * pi);
      fired_.push_back(turned * config_.mirror_period);
    }
  }
}

void LaserWorkspace::resize(std::size_t beams) {
  if (ranges.size() == beams) return;
  way.resize(beams);
  way_turns.resize(beams);
  rays.resize(beams);
  ranges.resize(beams);
  hits.resize(beams);
  draws.resize(beams);
  turns.resize(beams);
  edge_flags.assign(beams, 0);
  edges.resize(beams);
  first.resize(beams + 1);
}

double LaserModel::memory() const {
  return config_.rolling ? 2 * config_.turns * config_.mirror_period : 0;
}

void LaserModel::add(const algo::Obstacle& obstacle) {
  CastingSensor::add(obstacle);
  note_surfaces();
}

void LaserModel::remove(std::uint32_t id) {
  CastingSensor::remove(id);
  note_surfaces();
}

void LaserModel::sense(const Surroundings& around, algo::Observation& observation) {
  algo::LaserScan& scan = observation.scans.append();
  if (!sense(around.stamp, around.trail, scan, around.solids)) observation.scans.pop_back();
}

bool LaserModel::sense(double now,
                       const PoseTrail& trail,
                       algo::LaserScan& scan,
                       const SolidCaster* solids) {
  static thread_local LaserWorkspace workspace;
  work_ = &workspace;
  double end = now;
  double sweep = 0;
  if (config_.rolling) {
    sweep = config_.turns * config_.mirror_period;
    constexpr double kRounding = 1e-9;  // a sweep that ends with the tick belongs to it
    const double completed = std::floor((now - phase_) / sweep + kRounding);
    if (completed < 1 || static_cast<std::uint64_t>(completed) <= delivered_) return false;
    delivered_ = static_cast<std::uint64_t>(completed);
    end = phase_ + completed * sweep;
  }
  scan.mount_R = config_.mount_R;
  scan.stamp = end;
  scan.angle_min = pattern_.angle_min;
  scan.angle_increment = pattern_.angle_increment;
  scan.range_max = config_.range_max;
  scan.turn_period = config_.rolling ? config_.mirror_period : 0;
  scan.turns = config_.rolling ? config_.turns : 1;
  scan.resize(pattern_.beams);
  work_->resize(pattern_.beams);

  if (solids != nullptr) {
    cast_in_space(end, trail, *solids);
    report(scan, config_.reflectivity);
  } else {
    const bool surfaces = config_.reflectivity && !plain_;
    cast_in_plane(end, trail, surfaces);
    report(scan, surfaces);
  }
  spoil(scan);
  return true;
}

/// Casts the beams at the slice of the world in the scan plane.
void LaserModel::cast_in_plane(double end, const PoseTrail& trail, bool surfaces) {
  if (config_.rolling) {
    aim(end, trail);
  } else {
    reference_W_ = algo::compose(trail.at(end), config_.mount_R);
    if (config_.mixed_pixels) aim_still();
  }
  const bool with_hits = config_.mixed_pixels || surfaces;
  const std::span<std::uint32_t> hits =
      with_hits ? std::span(work_->hits) : std::span<std::uint32_t>();
  if (config_.rolling || config_.mixed_pixels) {
    caster().cast_rolling(
        reference_W_, pattern_, work_->rays, spread_, config_.range_max, work_->ranges, hits);
  } else {
    caster().cast(reference_W_, pattern_, config_.range_max, work_->ranges, hits);
  }
  if (config_.mixed_pixels) mark_edges();
  if (surfaces) apply_surfaces(work_->rays, work_->ranges, hits);
  if (config_.mixed_pixels) mix_pixels();
}

/// The rays of a sweep that ends at `end`: each from the scanner's pose at its own instant, in the
/// frame of the scanner's pose at half of the sweep.
void LaserModel::aim(double end, const PoseTrail& trail) {
  const double sweep = config_.turns * config_.mirror_period;
  const double step = trail.step();
  reference_W_ = algo::compose(trail.at(end - sweep / 2), config_.mount_R);
  const double c = std::cos(reference_W_.heading);
  const double s = std::sin(reference_W_.heading);
  // The scanner's poses at the physics steps around the sweep, oldest first, in the reference
  // frame.
  const double begin = end - sweep;
  const auto oldest = static_cast<std::size_t>(std::max(0.0, (trail.newest() - begin) / step)) + 1;
  const auto youngest = static_cast<std::size_t>(std::max(0.0, (trail.newest() - end) / step));
  motion_.clear();
  RaySpread spread;
  double farthest = 0;  // [m^2] squared distance from the reference
  for (std::size_t age = oldest; age + 1 > youngest; --age) {
    const algo::Pose2 pose_W = scanner_W(trail.back(age), config_.mount_R);
    const double dx = pose_W.x - reference_W_.x;
    const double dy = pose_W.y - reference_W_.y;
    motion_.push_back({c * dx + s * dy,
                       c * dy - s * dx,
                       algo::wrap_angle(pose_W.heading - reference_W_.heading)});
    farthest = std::max(farthest, dx * dx + dy * dy);
    spread.turn = std::max(spread.turn, std::abs(motion_.back().heading));
    if (age == 0) break;
  }
  spread.shift = std::sqrt(farthest);
  motion_.push_back(motion_.back());  // so that the last instant has a successor for interpolation
  spread_ = spread;
  allow_for_spot();

  const std::size_t beams = fired_.size();
  const double per_step = 1 / step;
  const StepClock clock{(begin - trail.newest()) * per_step + static_cast<double>(oldest),
                        per_step};
  for (std::size_t i = 0; i < beams;) i = follow_motion(clock, i);
  interlace(work_->way.x.data(), beams, config_.turns, work_->rays.x.data());
  interlace(work_->way.y.data(), beams, config_.turns, work_->rays.y.data());
  interlace(work_->way_turns.data(), beams, config_.turns, work_->turns.data());
  turn_directions(ux_.data(),
                  uy_.data(),
                  work_->turns.data(),
                  work_->turns.size(),
                  work_->rays.ux.data(),
                  work_->rays.uy.data());
}

/// The scanner's poses for the beams from fired_[first] on, as many as are fired within one physics
/// step; fired_ ascends. @return the first beam after them
std::size_t LaserModel::follow_motion(const StepClock& clock, std::size_t first) {
  const auto k = static_cast<std::size_t>(clock.at(fired_[first]));
  const auto number = static_cast<double>(k);
  const algo::Pose2& a = motion_[k];
  const algo::Pose2& b = motion_[k + 1];
  const auto from = fired_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto next = std::partition_point(
      from + 1, fired_.end(), [&](double fired) { return clock.at(fired) < number + 1; });
  const auto end = static_cast<std::size_t>(next - fired_.begin());
  follow({number, a.x, a.y, a.heading, b.x - a.x, b.y - a.y, b.heading - a.heading},
         clock,
         fired_.data(),
         {first, end},
         work_->way.x.data(),
         work_->way.y.data(),
         work_->way_turns.data());
  return end;
}

/// The rays of a scan without motion.
void LaserModel::aim_still() {
  std::fill(work_->rays.x.begin(), work_->rays.x.end(), 0.0);
  std::fill(work_->rays.y.begin(), work_->rays.y.end(), 0.0);
  std::copy(ux_.begin(), ux_.end(), work_->rays.ux.begin());
  std::copy(uy_.begin(), uy_.end(), work_->rays.uy.begin());
  spread_ = {};
  allow_for_spot();
}

/// Applies bias, noise and rounding to the device's unit. A packed beam can hold every result
/// (algo::quantise() would change nothing).
void LaserModel::report(algo::LaserScan& scan, bool echoes) {
  if (config_.noise > 0 && config_.noise_shape == NoiseShape::Gaussian) {
    noise_.fill_normal(work_->draws);
  } else if (config_.noise > 0) {
    noise_.fill_uniform(work_->draws);
  }
  read_ranges(work_->ranges.data(), work_->draws.data(), work_->draws.size(), reading_);
  const double range_max = config_.range_max;
  static_assert(static_cast<int>(algo::Beam::Ok) == 0 && static_cast<int>(algo::Beam::Free) == 1 &&
                static_cast<int>(algo::BeamCode::None) == 0);
  split_readings(work_->draws.data(),
                 work_->draws.size(),
                 range_max,
                 static_cast<std::uint8_t>(algo::BeamCode::BeyondRange),
                 {scan.ranges.data(),
                  reinterpret_cast<std::uint8_t*>(scan.status.data()),
                  reinterpret_cast<std::uint8_t*>(scan.codes.data())});
  if (!echoes) return;
  for (std::size_t i = 0; i < pattern_.beams; ++i) {
    if (scan.status[i] == algo::Beam::Free && work_->hits[i] == kNoEcho) {
      scan.set_invalid(i, algo::BeamCode::NoEcho);
    }
  }
}

/// Loses or falsifies beams, whatever they hit.
void LaserModel::spoil(algo::LaserScan& scan) {
  pepper_.draw(scan.size(), [&](std::size_t i) {
    double near = pepper_.random().uniform(0, work_->ranges[i]);
    double truth = 0;  // replaces the range: only the rounding is needed
    read_ranges(&truth, &near, 1, {0, 1, reading_.per_metre, config_.range_max, reading_.most});
    scan.set_ok(i, near);
  });
  salt_.draw(scan.size(), [&](std::size_t i) { scan.set_free(i); });
  dropout_.draw(scan.size(), [&](std::size_t i) { scan.set_invalid(i, algo::BeamCode::NoEcho); });
}

}  // namespace sim
