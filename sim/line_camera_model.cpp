// sim/line_camera_model.cpp: two rays a column.
#include "sim/line_camera_model.hpp"

#include <cmath>
#include <numbers>

namespace sim {
namespace {

constexpr std::uint64_t kPixelPurpose = 0x4c494e45;  // of its noise: unlike any other sensor's
constexpr std::uint64_t kDarkPurpose = 0x4441524b;
constexpr double kReach = 10;  // [m] the laser's light is too weak beyond it
constexpr double kHidden =
    0.002;  // [m] an obstacle before the line by less than this hides nothing

/// `p` turned by `angle` [rad] about y.
algo::Vec3 pitched(double angle, const algo::Vec3& p) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * p.x() + s * p.z(), p.y(), -s * p.x() + c * p.z()};
}

}  // namespace

std::optional<std::string> defect(const LineCameraConfig& config) {
  constexpr double kRight = std::numbers::pi / 2;
  if (!within(config.x, -10, 10)) return "x must be -10 to 10 m";
  if (!within(config.height, 0.01, 5)) return "height must be 0.01 to 5 m";
  if (!within(config.pitch, 0, kRight)) return "pitch_deg must be 0 to 90";
  if (!within(config.baseline, 0.001, 5)) return "baseline must be 0.001 to 5 m";
  if (!(config.angle > 0 && config.angle < kRight)) return "angle_deg must be between 0 and 90";
  if (!within(config.focal, 1, 1e5)) return "focal must be 1 to 100000 pixels";
  if (config.columns < 64 || config.columns > 10000) return "columns must be 64 to 10000";
  if (config.rows < 2 || config.rows > 10000) return "rows must be 2 to 10000";
  if (!within(config.noise, 0, 100)) return "noise must be 0 to 100 pixels";
  if (!within(config.dropout, 0, 1)) return "dropout must be 0 to 1";
  if (!within(config.period, 0, 10)) return "period must be 0 to 10 s";
  return std::nullopt;
}

LineCameraModel::LineCameraModel(const LineCameraConfig& config, std::uint64_t seed)
    : config_(checked(config, "Line camera")),
      every_(config.period),
      noise_(seed, kPixelPurpose),
      dark_(Random(seed, kDarkPurpose), config.dropout) {}

void LineCameraModel::sense(const Surroundings& around, algo::Observation& observation) {
  if (!every_.due(around.stamp)) return;
  // All are drawn for every image, so that the numbers do not depend on what is seen.
  noise_.fill_normal(errors_);
  missing_.fill(false);
  dark_.draw(kColumns, [this](std::size_t k) { missing_.at(k) = true; });
  observation.line.fresh = true;
  observation.line.stamp = around.stamp;
  const VehicleState& vehicle = around.vehicle;
  const SpacePose robot = space_pose(vehicle.pose_W, vehicle.tilt());
  const double half_rows = config_.rows / 2.0;
  for (std::size_t k = 0; k < kColumns; ++k) {
    // Whole pixels, the leftmost first.
    const double share = 0.5 - (static_cast<double>(k) + 0.5) / static_cast<double>(kColumns);
    const double u = std::round(share * config_.columns);
    if (missing_.at(k)) continue;
    const auto row = row_of(u, robot);
    if (!row) continue;
    const double v = std::round(*row + config_.noise * errors_.at(k));
    if (std::abs(v) > half_rows) continue;
    observation.line.pixels.push_back({static_cast<float>(u), static_cast<float>(v)});
  }
}

/// v of the line in the column `u`, exactly; nothing if the camera does not see it there.
std::optional<double> LineCameraModel::row_of(double u, const SpacePose& robot) const {
  const algo::Vec3 camera_R(config_.x, 0, config_.height);
  const auto to_world = [&](const algo::Vec3& p_C) {
    return algo::Vec3(robot.origin_W + robot.axes_W * (camera_R + pitched(config_.pitch, p_C)));
  };
  const algo::Vec3 camera_W = to_world({0, 0, 0});
  const algo::Vec3 laser_W = to_world({0, 0, config_.baseline});
  // Where the column's plane, y = x u / f, cuts the laser's: all on one ray from the laser.
  const algo::Vec3 along_C =
      algo::Vec3(1, u / config_.focal, -1 / std::tan(config_.angle)).normalized();
  const algo::Vec3 along_W = robot.axes_W * pitched(config_.pitch, along_C);
  const auto lit = caster_.cast(laser_W, along_W, kReach);
  if (!lit) return std::nullopt;
  const algo::Vec3 p_C = algo::Vec3(0, 0, config_.baseline) + lit->range * along_C;
  const algo::Vec3 to_line_W = laser_W + lit->range * along_W - camera_W;
  const double distance = to_line_W.norm();
  if (p_C.x() <= 0 || distance <= kHidden) return std::nullopt;
  if (caster_.cast(camera_W, to_line_W / distance, distance - kHidden)) return std::nullopt;
  return config_.focal * p_C.z() / p_C.x();
}

}  // namespace sim
