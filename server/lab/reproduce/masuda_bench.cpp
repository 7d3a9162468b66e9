// server/lab/reproduce/masuda_bench.cpp: worlds of one edge, and what the sensors make of them.
#include "server/lab/reproduce/masuda_bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "algo/terrain/ground_reader.hpp"
#include "algo/terrain/ground_trials.hpp"
#include "algo/terrain/ground_value.hpp"
#include "sim/floor_beams.hpp"
#include "sim/floor_sensors.hpp"
#include "sim/random.hpp"

namespace server::reproduce {
namespace {

using algo::GroundClass;

constexpr double kReach = 2.0;        // [m] of the ground beyond and beside the edge
constexpr double kSampleWay = 0.002;  // [m] the paper's robot, from one reading to the next
constexpr double kRunUp = 0.10;       // [m] of flat floor before the near beam meets the edge
constexpr double kFlatWay = 1.0;      // [m] of a drive over flat floor
constexpr std::uint64_t kPhasePurpose = 0x4d415355;
constexpr int kAtRest = 200;  // readings of a slope down

/// [m] x in R where the near beams meet a level floor.
double foot_of(const sim::FloorSensorConfig& c) {
  return c.x + c.height / std::tan(c.angle);
}

/// The sensors on a robot that is carried along the x axis.
class Bench {
 public:
  Bench(const MasudaGround& ground, std::uint64_t seed)
      : config_(masuda_sensors(true)), sensors_(config_, seed), floor_(ground.floor()) {
    for (const algo::Obstacle& each : ground.obstacles()) sensors_.add(each);
  }
  /// Readings with R at `x` [m].
  algo::FloorRanges at(double x) { return sensors_.read(0, {x, 0, 0}, {.z = floor_}); }
  const sim::FloorSensorConfig& config() const { return config_; }

 private:
  sim::FloorSensorConfig config_;
  sim::FloorSensorModel sensors_;
  double floor_ = 0;
};

double value_of(const MasudaGround& ground,
                const algo::FloorSensors& sensors,
                double far,
                double near) {
  const bool slope = ground.kind == GroundClass::SlopeUp || ground.kind == GroundClass::SlopeDown;
  return slope ? algo::ground_slope(far, near, sensors.separation, sensors.angle)
               : algo::ground_height(near, algo::flat_ranges(sensors).near, sensors.angle);
}

/// The winner of printed rules: each rule that holds counts.
GroundClass literal_winner(const std::vector<unsigned>& trials) {
  algo::ClassVote vote;
  for (const unsigned found : trials) {
    for (std::size_t k = 0; k < algo::kGroundClasses; ++k) {
      if ((found >> k & 1U) != 0) vote.add(static_cast<GroundClass>(k));
    }
    if (found == 0) vote.add(GroundClass::Unknown);
  }
  return vote.winner();
}

/// Eq. 12 from the means of 200 readings at rest.
double slope_at_rest(Bench& bench, double x) {
  double far = 0;
  double near = 0;
  int fars = 0;
  int nears = 0;
  for (int k = 0; k < kAtRest; ++k) {
    const algo::FloorRanges now = bench.at(x);
    for (const double each : {now.far_left, now.far_right}) {
      if (!std::isfinite(each)) continue;
      far += each;
      ++fars;
    }
    for (const double each : {now.near_left, now.near_right}) {
      if (!std::isfinite(each)) continue;
      near += each;
      ++nears;
    }
  }
  return algo::ground_slope(
      far / fars, near / nears, bench.config().separation, bench.config().angle);
}

}  // namespace

sim::FloorSensorConfig masuda_sensors(bool grazing) {
  return {.grazing = grazing};
}

std::vector<algo::Obstacle> MasudaGround::obstacles() const {
  // Everything turns about the edge's middle.
  const auto placed = [this](double x, double heading) {
    return algo::compose({0, 0, skew}, {x, 0, heading});
  };
  const auto ramp = [](std::uint32_t id, const algo::Pose2& pose, double low, double high) {
    return algo::Obstacle{
        .id = id, .pose_W = pose, .shape = algo::Ramp{kReach, 2 * kReach, low}, .height = high};
  };
  switch (kind) {
    case GroundClass::StepUp:
      return {ramp(1, placed(kReach / 2, 0), size, size)};
    case GroundClass::StepDown:
      return {ramp(1, placed(-kReach / 2, 0), -size, -size)};
    case GroundClass::SlopeUp:
      return {ramp(1, placed(kReach / 2, 0), 0, kReach * std::tan(size))};
    case GroundClass::SlopeDown: {
      const double top = kReach * std::tan(-size);
      return {ramp(1, placed(-kReach / 2, 0), top, top),
              ramp(2, placed(kReach / 2, std::numbers::pi), 0, top)};
    }
    case GroundClass::Trench:
      return {
          {.id = 1, .pose_W = placed(size / 2, 0), .shape = algo::Trench{size, 2 * kReach, size}}};
    default:
      return {};
  }
}

double MasudaGround::floor() const {
  if (kind == GroundClass::StepDown) return -size;
  if (kind == GroundClass::SlopeDown) return kReach * std::tan(-size);
  return 0;
}

MasudaSpread spread_of(const std::vector<double>& values) {
  MasudaSpread out{.count = values.size()};
  if (values.empty()) return out;
  const auto [least, most] = std::ranges::minmax(values);
  out.min = least;
  out.max = most;
  for (const double each : values) out.mean += each;
  out.mean /= static_cast<double>(values.size());
  for (const double each : values) out.variance += (each - out.mean) * (each - out.mean);
  out.variance /= static_cast<double>(values.size());
  return out;
}

std::vector<double> static_trials(const MasudaGround& ground,
                                  double d1,
                                  const MasudaReading& reading,
                                  std::size_t trials,
                                  std::uint64_t seed) {
  Bench bench(ground, seed);
  const algo::FloorSensors sensors = sim::geometry_of(bench.config());
  const double x = -d1 - sensors.x;  // the sensors are at the front edge
  std::vector<double> values;
  for (std::size_t k = 0; k < trials; ++k) {
    algo::GroundReader reader(sensors, reading.window, reading.rank());
    for (std::size_t n = 0; n < reading.window; ++n) reader.take(bench.at(x));
    values.push_back(value_of(ground, sensors, reader.left().far, reader.left().near));
  }
  return values;
}

MasudaDrive drive_over(const MasudaGround& ground,
                       const MasudaReading& reading,
                       std::uint64_t seed) {
  Bench bench(ground, seed);
  const algo::FloorSensors sensors = sim::geometry_of(bench.config());
  const double foot = foot_of(bench.config());
  algo::GroundReader reader(sensors, reading.window, reading.rank());
  algo::GroundTrials trials(sensors, reader.flat());
  MasudaDrive out;
  std::vector<unsigned> printed;
  std::vector<double> values;
  std::size_t taken = 0;
  const double far_enough = ground.kind == GroundClass::Flat ? kFlatWay : 2 * kRunUp;
  // The edge lies anywhere between two readings.
  double way = -kRunUp - kSampleWay * sim::Random(seed, kPhasePurpose).uniform();
  for (; way < far_enough && trials.count() < algo::kGroundTrials; way += kSampleWay) {
    reader.take(bench.at(way - foot));
    algo::GroundLook look = reader.left();
    const algo::FlatRanges flat = reader.flat();
    if (++taken < reading.window) continue;  // the first reading fills the median alone
    look.kind = algo::classify_ranges(look.far, look.near, flat, reading.limits);
    const bool level = look.kind == GroundClass::Flat || look.kind == GroundClass::Pending;
    if (!level) out.alarm = true;
    if (!out.alarm) continue;
    trials.add(look, way, kRunUp);
    printed.push_back(
        algo::classify_literal(look.far - flat.far, look.near - flat.near, reading.limits));
    values.push_back(value_of(ground, sensors, look.far, look.near));
  }
  if (!out.alarm) return out;
  const algo::GroundFinding finding = trials.finding();
  out.found = reading.literal ? literal_winner(printed) : finding.kind;
  const bool slope = ground.kind == GroundClass::SlopeUp || ground.kind == GroundClass::SlopeDown;
  out.value = slope ? finding.slope : finding.height;
  if (reading.literal) out.value = spread_of(values).mean;
  if (out.found == GroundClass::SlopeDown) out.value = slope_at_rest(bench, way - foot);
  return out;
}

MasudaTrace trace_over(const MasudaGround& ground, double from, double to, std::uint64_t seed) {
  Bench bench(ground, seed);
  const algo::FloorSensors sensors = sim::geometry_of(bench.config());
  algo::GroundReader reader(sensors);
  MasudaTrace out;
  for (double way = from; way < to; way += kSampleWay) {
    const algo::FloorRanges now = bench.at(way - foot_of(bench.config()));
    reader.take(now);
    out.way.push_back(way);
    const std::array<double, 4> raw{now.far_left, now.far_right, now.near_left, now.near_right};
    const std::array<double, 4> smooth{
        reader.left().far, reader.right().far, reader.left().near, reader.right().near};
    for (std::size_t k = 0; k < raw.size(); ++k) {
      out.raw[k].push_back(raw[k]);
      out.smooth[k].push_back(smooth[k]);
    }
  }
  return out;
}

}  // namespace server::reproduce
