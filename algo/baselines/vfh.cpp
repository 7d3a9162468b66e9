// algo/baselines/vfh.cpp: densities, valleys, speed, and one tick.
#include "algo/baselines/vfh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "algo/driving.hpp"

namespace algo {
namespace {

constexpr int kSmoothing = 5;  // l
constexpr int kWide = 18;      // s_max [sectors]
constexpr ParameterInfo kThreshold{.name = "vfh.threshold",
                                   .label = "Threshold",
                                   .min = 10,
                                   .max = 5000,
                                   .step = 10,
                                   .initial = 300,
                                   .help = "A sector below this density is free."};
constexpr ParameterInfo kStandstill{.name = "vfh.standstill",
                                    .label = "Standstill h_m",
                                    .min = 100,
                                    .max = 20000,
                                    .step = 100,
                                    .initial = 3000,
                                    .help = "At this density straight ahead the robot stands."};
constexpr auto kVfhParameters = std::to_array<const ParameterInfo*>(
    {&kThreshold, &kStandstill, &kMaxSpeed, &kMaxTurnRate, &kHeadingGain, &kGoalReach});

constexpr LayerInfo kHistogram{.name = "histogram",
                               .label = "Polar histogram",
                               .kind = LayerKind::Polar,
                               .tone = Tone::External};
constexpr std::uint8_t kThroughValley = 1;
constexpr std::uint8_t kWalled = 2;

int cyclic(int k) {
  return (k % kSectors + kSectors) % kSectors;
}

/// Number of sectors from `a` to `b`, the shorter way round.
int apart(int a, int b) {
  const int d = cyclic(a - b);
  return std::min(d, kSectors - d);
}

/// A run of free sectors from `first` on, cyclic.
struct Valley {
  int first = 0;
  int width = 0;
  int last() const { return cyclic(first + width - 1); }
  bool holds(int k) const { return cyclic(k - first) < width; }
  int distance(int k) const { return holds(k) ? 0 : std::min(apart(k, first), apart(k, last())); }
};

int steer_through(const Valley& valley, int target) {
  if (valley.width <= kWide) return cyclic(valley.first + (valley.width - 1) / 2);
  const int from_first = apart(target, valley.first);
  const int from_last = apart(target, valley.last());
  const int in = kWide / 2;
  if (valley.holds(target) && from_first >= in && from_last >= in) return target;
  return from_first <= from_last ? cyclic(valley.first + in) : cyclic(valley.last() - in);
}

}  // namespace

ParameterList Vfh::parameters() {
  return kVfhParameters;
}

int sector_of(double bearing) {
  const double turned = bearing < 0 ? bearing + 2 * std::numbers::pi : bearing;
  return cyclic(whole_below(turned / kSectorWidth));
}

double sector_centre(int k) {
  return (k + 0.5) * kSectorWidth;
}

PolarDensity polar_density(const HistogramGrid& grid, const Vec2& robot_W) {
  constexpr double kFarthest = std::numbers::sqrt2 * (HistogramGrid::kWindow - 1) / 2;
  PolarDensity density{};
  grid.for_each_in_window(robot_W, [&](const Vec2& offset, double c) {
    const double m = c * c * (kFarthest - offset.norm() / HistogramGrid::kCell);
    density[static_cast<std::size_t>(sector_of(std::atan2(offset.y(), offset.x())))] +=
        std::max(0.0, m);
  });
  return density;
}

PolarDensity smooth(const PolarDensity& density) {
  PolarDensity smoothed{};
  for (int k = 0; k < kSectors; ++k) {
    double sum = 0;
    for (int q = -kSmoothing; q <= kSmoothing; ++q) {
      sum += (kSmoothing + 1 - std::abs(q)) * density[static_cast<std::size_t>(cyclic(k + q))];
    }
    smoothed[static_cast<std::size_t>(k)] = sum / (2 * kSmoothing + 1);
  }
  return smoothed;
}

std::optional<int> steering_sector(const PolarDensity& smoothed, double threshold, int target) {
  const auto free = [&](int k) {
    return smoothed[static_cast<std::size_t>(cyclic(k))] < threshold;
  };
  if (std::ranges::all_of(smoothed, [&](double h) { return h < threshold; })) return target;
  std::optional<Valley> best;
  for (int first = 0; first < kSectors; ++first) {
    if (!free(first) || free(first - 1)) continue;  // no valley begins here
    Valley valley{first, 1};
    while (free(first + valley.width)) ++valley.width;
    if (!best || valley.distance(target) < best->distance(target)) best = valley;
  }
  if (!best) return std::nullopt;
  return steer_through(*best, target);
}

double vfh_speed(double density_ahead, double h_m, double v_max) {
  return v_max * (1 - std::min(density_ahead, h_m) / h_m);
}

void Vfh::steer(const ControlInput& in, const Parameters& parameters, ControlOutput& out) {
  grid_.sense(in);
  grid_.show(in, out);
  const Pose2& pose = in.odometry.pose;
  const PolarDensity density = smooth(polar_density(grid_, pose.position()));
  const double threshold = parameters[kThreshold];
  Layer& histogram = add_layer(out.layers, kHistogram);
  histogram.level = static_cast<float>(threshold);
  histogram.values.assign(density.begin(), density.end());
  const auto free = std::ranges::count_if(density, [=](double h) { return h < threshold; });
  out.measures.push_back({"histogram.free", "", static_cast<double>(free)});

  const double to_goal = bearing_W(pose.position(), goal_W(in));
  const int target = sector_of(to_goal);
  const auto sector = steering_sector(density, threshold, target);
  if (!sector) {  // stops and turns until a valley opens
    out.state = kWalled;
    out.waits = true;
    out.twist = {0, parameters[algo::kMaxTurnRate]};
    return;
  }
  out.state = kThroughValley;
  const double ahead = density[static_cast<std::size_t>(sector_of(pose.heading))];
  const double speed = vfh_speed(ahead, parameters[kStandstill], parameters[kMaxSpeed]);
  // In a free sector, heads for the goal itself, not for the middle of its sector.
  const double bearing = *sector == target ? to_goal : sector_centre(*sector);
  steer_along(in, bearing, speed, parameters, out);
}

void Vfh::tell(const Telemetry& t, Explanation& words) const {
  if (t.output.state == kWalled) {
    words.what = "Turning on the spot";
    words.why = "No sector of the histogram is free.";
    return;
  }
  words.what = "Steering through a free valley";
  say(words.why,
      "%.0f of %d sectors are free; the way is %.0f degrees off the goal.",
      t.output.measure("histogram.free").value_or(0),
      kSectors,
      off_goal(t));
}

}  // namespace algo
