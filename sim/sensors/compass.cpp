// sim/sensors/compass.cpp: the heading relative to magnetic north, with noise.
#include <array>
#include <numbers>

#include "algo/types.hpp"
#include "sim/random.hpp"
#include "sim/sensor.hpp"

namespace sim::sensors {
namespace {

constexpr std::uint64_t kPurpose = 0x434f4d50;  // of its noise: unlike any other sensor's

class Compass final : public ChannelSensor {
 public:
  Compass(const SensorConfig& config, std::uint64_t seed)
      : north_(config.number("north", 0)),
        noise_(config.number("noise", 0.02)),
        every_(config.number("period", 0.1)),
        random_(seed, kPurpose) {}

  bool read(const Surroundings& around, std::vector<double>& values) override {
    if (!every_.due(around.stamp)) return false;
    std::array<double, 1> draw{};
    random_.fill_normal(draw);
    const double heading = around.vehicle.pose_W.heading - north_ + noise_ * draw[0];
    values.assign(1, algo::wrap_angle(heading));
    return true;
  }

 private:
  double north_ = 0;  // [rad] bearing of magnetic north in W
  double noise_ = 0;  // [rad] standard deviation
  Every every_;
  Random random_;
};

}  // namespace

SensorKind compass() {
  return {.help = "the robot's heading against magnetic north",
          .kind = "heading",
          .unit = "rad",
          .settings = {{.name = "north",
                        .help = "[rad] bearing of magnetic north in W",
                        .min = -std::numbers::pi,
                        .max = std::numbers::pi},
                       {.name = "noise", .help = "[rad] standard deviation", .max = 1},
                       {.name = "period", .help = "[s] between readings", .max = 3600}},
          .make = [](const SensorConfig& config, std::uint64_t seed) {
            return std::make_unique<Compass>(config, seed);
          }};
}

}  // namespace sim::sensors
