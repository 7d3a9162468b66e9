// sim/sensors/scripted.cpp: a value that a scenario prescribes over time, such as a battery's.
#include <algorithm>
#include <cmath>

#include "sim/sensor.hpp"

namespace sim::sensors {
namespace {

constexpr double kAny = 1e9;

class Scripted final : public ChannelSensor {
 public:
  explicit Scripted(const SensorConfig& config)
      : times_(*config.find("times")),
        values_(*config.find("values")),
        every_(config.number("period", 1.0)) {}

  bool read(const Surroundings& around, std::vector<double>& values) override {
    if (!every_.due(around.stamp)) return false;
    values.assign(1, at(around.stamp));
    return true;
  }

 private:
  /// Linear between the times; constant before the first and after the last.
  double at(double stamp) const {
    const auto after = std::ranges::upper_bound(times_, stamp);
    if (after == times_.begin()) return values_.front();
    if (after == times_.end()) return values_.back();
    const auto i = static_cast<std::size_t>(after - times_.begin());
    const double share = (stamp - times_[i - 1]) / (times_[i] - times_[i - 1]);
    return std::lerp(values_[i - 1], values_[i], share);
  }

  std::vector<double> times_;  // [s] run clock
  std::vector<double> values_;
  Every every_;
};

std::optional<std::string> mismatch(const SensorConfig& config) {
  const std::vector<double>& times = *config.find("times");
  if (times.size() != config.find("values")->size()) return "values must be as many as times";
  if (std::ranges::adjacent_find(times, std::ranges::greater_equal()) != times.end()) {
    return "times must ascend";
  }
  return std::nullopt;
}

}  // namespace

SensorKind scripted() {
  return {.help = "a value that the scenario gives over time, linear in between",
          .kind = "scripted",
          .settings = {{.name = "times",
                        .help = "[s] of the run clock, ascending",
                        .max = kAny,
                        .most = kMostSettingValues,
                        .required = true},
                       {.name = "values",
                        .help = "the value at each time",
                        .min = -kAny,
                        .max = kAny,
                        .most = kMostSettingValues,
                        .required = true},
                       {.name = "period", .help = "[s] between readings", .max = 3600}},
          .defect = mismatch,
          .make = [](const SensorConfig& config, std::uint64_t /*seed*/) {
            return std::make_unique<Scripted>(config);
          }};
}

}  // namespace sim::sensors
