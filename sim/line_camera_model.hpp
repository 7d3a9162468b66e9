// sim/line_camera_model.hpp: a laser that draws a line across the ground, and the camera that sees
// it (sensors.md 5).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "sim/random.hpp"
#include "sim/sensor.hpp"
#include "sim/solid_caster.hpp"
#include "sim/space_pose.hpp"

namespace sim {

/// The defect of the configuration as part of a sentence, or nothing.
std::optional<std::string> defect(const LineCameraConfig& config);

/// The physics, not the picture. In each of 64 columns of the image the laser's light meets the
/// first surface on its way; the camera sees it there unless something is before it. Pixels have
/// noise and are whole; some are missing, as on a dark surface.
class LineCameraModel final : public Sensor {
 public:
  static constexpr std::size_t kColumns = 64;  // of the image, evenly spaced

  /// Throws std::invalid_argument with the defect.
  LineCameraModel(const LineCameraConfig& config, std::uint64_t seed);

  void add(const algo::Obstacle& obstacle) override { caster_.add(obstacle); }
  void move(std::uint32_t id, const algo::Pose2& pose_W) override { caster_.move(id, pose_W); }
  void remove(std::uint32_t id) override { caster_.remove(id); }
  void sense(const Surroundings& around, algo::Observation& observation) override;

 private:
  std::optional<double> row_of(double u, const SpacePose& robot) const;

  LineCameraConfig config_{};
  SolidCaster caster_{};
  Every every_;
  Random noise_;
  RareEvents dark_;
  std::array<double, kColumns> errors_{};
  std::array<bool, kColumns> missing_{};
};

}  // namespace sim
