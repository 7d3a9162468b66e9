// sim/laser_model.cpp: when a sweep is over, where its beams come from, and what is reported.
#include "sim/laser_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sim {
namespace {

using std::numbers::pi;

/// Streams of one scanner's randomness.
enum class Purpose : std::uint64_t { Bias = 1, Phase, Noise, Dropout, Salt, Pepper };

Random stream(std::uint64_t seed, std::uint32_t index, Purpose purpose) {
  return Random(seed, (std::uint64_t{index} << 8) + static_cast<std::uint64_t>(purpose));
}

const LaserConfig& checked(const LaserConfig& config, std::uint32_t index) {
  if (const auto problem = defect(config)) {
    throw std::invalid_argument("Laser " + std::to_string(index + 1) + ": " + *problem + ".");
  }
  return config;
}

/// `value` to the nearest multiple of 1 / per_metre, halves to even. Adding this number leaves no
/// room for a fraction; unlike nearbyint() it is vectorised on every x86-64.
double rounded(double value, double per_metre) {
  constexpr double kNoFraction = 0x1.8p52;
  return ((value * per_metre + kNoFraction) - kNoFraction) / per_metre;
}

}  // namespace

LaserModel::LaserModel(const LaserConfig& config, std::uint64_t seed, std::uint32_t index)
    : config_(checked(config, index)),
      caster_(config.height),
      noise_(stream(seed, index, Purpose::Noise)),
      dropout_(stream(seed, index, Purpose::Dropout), config.dropout),
      salt_(stream(seed, index, Purpose::Salt), config.salt),
      pepper_(stream(seed, index, Purpose::Pepper), config.pepper) {
  const double steps = std::nearbyint(config_.field_of_view / config_.angle_increment);
  pattern_ = {
      -config_.field_of_view / 2, config_.angle_increment, static_cast<std::size_t>(steps) + 1};
  bias_ = stream(seed, index, Purpose::Bias).uniform(-config_.bias, config_.bias);
  // Several scanners are not synchronised: each further one has a phase of its own.
  if (index > 0) phase_ = stream(seed, index, Purpose::Phase).uniform(0, config_.mirror_period);

  const std::size_t beams = pattern_.beams;
  fired_.resize(beams);
  ux_.resize(beams);
  uy_.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const double angle = pattern_.angle_min + static_cast<double>(i) * pattern_.angle_increment;
    const auto turn = static_cast<double>(i % config_.turns);
    fired_[i] = (turn + (angle + pi / 2) / (2 * pi)) * config_.mirror_period;
    ux_[i] = std::cos(angle);
    uy_[i] = std::sin(angle);
  }
  rays_.resize(beams);
  ranges_.resize(beams);
  hits_.resize(beams);
  draws_.resize(beams);
  first_.resize(beams + 1);
  edges_.reserve(beams);
}

double LaserModel::memory() const {
  return config_.rolling ? 2 * config_.turns * config_.mirror_period : 0;
}

void LaserModel::add(const algo::Obstacle& obstacle) {
  caster_.add(obstacle);
  note_surfaces();
}

void LaserModel::move(std::uint32_t id, const algo::Pose2& pose_W) {
  caster_.move(id, pose_W);
}

void LaserModel::remove(std::uint32_t id) {
  caster_.remove(id);
  note_surfaces();
}

bool LaserModel::sense(double now, const PoseTrail& trail, algo::LaserScan& scan) {
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

  if (config_.rolling) {
    aim(end, trail);
  } else {
    reference_W_ = algo::compose(trail.at(end), config_.mount_R);
    if (config_.mixed_pixels) aim_still();
  }
  const bool surfaces = config_.reflectivity && !plain_;
  const bool with_hits = config_.mixed_pixels || surfaces;
  const std::span<std::uint32_t> hits = with_hits ? std::span(hits_) : std::span<std::uint32_t>();
  if (config_.rolling || config_.mixed_pixels) {
    caster_.cast_rolling(reference_W_, pattern_, rays_, spread_, config_.range_max, ranges_, hits);
  } else {
    caster_.cast(reference_W_, pattern_, config_.range_max, ranges_, hits);
  }
  if (config_.mixed_pixels) mark_edges();
  if (surfaces) apply_surfaces(rays_, ranges_, hits);
  if (config_.mixed_pixels) mix_pixels();
  report(scan);
  spoil(scan);
  algo::quantise(scan);
  return true;
}

/// The rays of a sweep that ends at `end`: each from the scanner's pose at its own instant, in the
/// frame of the scanner's pose at half the sweep.
void LaserModel::aim(double end, const PoseTrail& trail) {
  const double sweep = config_.turns * config_.mirror_period;
  const double step = trail.step();
  reference_W_ = algo::compose(trail.at(end - sweep / 2), config_.mount_R);
  const double c = std::cos(reference_W_.heading);
  const double s = std::sin(reference_W_.heading);
  // The scanner at the physics steps around the sweep, oldest first, as seen from the reference.
  const double begin = end - sweep;
  const auto oldest = static_cast<std::size_t>(std::max(0.0, (trail.newest() - begin) / step)) + 1;
  const auto youngest = static_cast<std::size_t>(std::max(0.0, (trail.newest() - end) / step));
  motion_.clear();
  RaySpread spread;
  for (std::size_t age = oldest; age + 1 > youngest; --age) {
    const algo::Pose2 pose_W = algo::compose(trail.back(age), config_.mount_R);
    const double dx = pose_W.x - reference_W_.x;
    const double dy = pose_W.y - reference_W_.y;
    motion_.push_back({c * dx + s * dy,
                       c * dy - s * dx,
                       algo::wrap_angle(pose_W.heading - reference_W_.heading)});
    spread.shift = std::max(spread.shift, std::sqrt(dx * dx + dy * dy));
    spread.turn = std::max(spread.turn, std::abs(motion_.back().heading));
    if (age == 0) break;
  }
  motion_.push_back(motion_.back());  // the last instant has a successor to interpolate to
  spread_ = spread;
  allow_for_spot();

  const double per_step = 1 / step;
  const double offset = (begin - trail.newest()) * per_step + static_cast<double>(oldest);
  for (std::size_t i = 0; i < pattern_.beams; ++i) {
    const double at = offset + fired_[i] * per_step;
    const auto k = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(k);
    const algo::Pose2& a = motion_[k];
    const algo::Pose2& b = motion_[k + 1];
    rays_.x[i] = a.x + part * (b.x - a.x);
    rays_.y[i] = a.y + part * (b.y - a.y);
    // The small turn t since the reference by its series; the first terms left out are t^9 / 9!
    // and t^8 / 8!, under 1e-9 at 0.3 rad, which no robot turns within half a sweep.
    const double t = a.heading + part * (b.heading - a.heading);
    const double t2 = t * t;
    const double sine = t * (1 - t2 / 6 * (1 - t2 / 20 * (1 - t2 / 42)));
    const double cosine = 1 - t2 / 2 * (1 - t2 / 12 * (1 - t2 / 30));
    rays_.ux[i] = cosine * ux_[i] - sine * uy_[i];
    rays_.uy[i] = sine * ux_[i] + cosine * uy_[i];
  }
}

/// The rays of a scan without motion.
void LaserModel::aim_still() {
  std::fill(rays_.x.begin(), rays_.x.end(), 0.0);
  std::fill(rays_.y.begin(), rays_.y.end(), 0.0);
  std::copy(ux_.begin(), ux_.end(), rays_.ux.begin());
  std::copy(uy_.begin(), uy_.end(), rays_.uy.begin());
  spread_ = {};
  allow_for_spot();
}

/// Bias, noise and rounding to the device's unit.
void LaserModel::report(algo::LaserScan& scan) {
  const std::size_t beams = pattern_.beams;
  const double range_max = config_.range_max;
  if (config_.noise > 0 && config_.noise_shape == NoiseShape::Gaussian) {
    noise_.fill_normal(draws_);
  } else if (config_.noise > 0) {
    noise_.fill_uniform(draws_);
  }
  const double per_metre = config_.unit == LaserUnit::Centimetre ? 100 : 1000;
  const double* range = ranges_.data();
  double* measured = draws_.data();
  for (std::size_t i = 0; i < beams; ++i) {
    const double noisy = range[i] + bias_ + config_.noise * measured[i];
    const double value = rounded(noisy > 0 ? noisy : 0, per_metre);
    measured[i] = range[i] < range_max ? value : range_max;
  }
  const bool echoes = config_.reflectivity && !plain_;
  for (std::size_t i = 0; i < beams; ++i) {
    if (measured[i] < range_max) {
      scan.set_ok(i, measured[i]);
    } else if (echoes && hits_[i] == kNoEcho) {
      scan.set_invalid(i, algo::BeamCode::NoEcho);
    } else {
      scan.set_free(i);
    }
  }
}

/// Beams lost or false, independent of what they met.
void LaserModel::spoil(algo::LaserScan& scan) {
  pepper_.draw(scan.size(),
               [&](std::size_t i) { scan.set_ok(i, pepper_.random().uniform(0, ranges_[i])); });
  salt_.draw(scan.size(), [&](std::size_t i) { scan.set_free(i); });
  dropout_.draw(scan.size(), [&](std::size_t i) { scan.set_invalid(i, algo::BeamCode::NoEcho); });
}

}  // namespace sim
