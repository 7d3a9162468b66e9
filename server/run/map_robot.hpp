// server/run/map_robot.hpp: a robot that drives by its pose on a known map.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "algo/drawn_space.hpp"
#include "algo/full_strip/scan_points.hpp"
#include "algo/mapping/map_localizer.hpp"
#include "algo/mapping/occupancy_map.hpp"
#include "algo/robot.hpp"
#include "server/run/forwarding_robot.hpp"

namespace server {

/// A map that a robot knows before it drives.
struct KnownMap {
  std::string path{};      // of its file
  std::string name{};      // without the folder, for people
  algo::Submap walls;      // for the robot
  std::string document{};  // for the page: JSON, as in docs/interfaces.md
  /// For planners; null: they plan without it.
  std::shared_ptr<const algo::DrawnSpace> space{};
};
/// Throws std::runtime_error with a sentence.
std::shared_ptr<const KnownMap> known_map(const std::filesystem::path& yaml);

/// Stands between a run and any robot with a scanner: simulated, replayed or real. Puts the pose by
/// matched scans into the odometry of each observation, and tells how sure it is. Pipeline and
/// record see nothing but this observation, so a replay needs neither map nor localizer.
///
/// While the robot is not located, its pose goes on by the wheels alone, and the gate holds it.
class MapRobot final : public ForwardingRobot, public algo::Locating {
 public:
  enum class Waits { Yes, No };
  /// `start_W`: the robot begins there, if that is known. `waits`: it stands while its place is
  /// searched for, unlike the robot of a log.
  MapRobot(std::shared_ptr<algo::Robot> robot,
           const KnownMap& map,
           const std::optional<algo::Pose2>& start_W,
           Waits waits = Waits::Yes);

  void reset(algo::Observation& observation) override;
  bool step(const algo::Command& command, algo::Observation& observation) override;
  algo::Locating* locating() override { return this; }

  void place(const algo::SetInitialPose& at) override;

 private:
  void locate(algo::Observation& observation);
  void correct(algo::Observation& observation);

  algo::MapLocalizer localizer_;
  std::optional<algo::Pose2> start_W_{};
  Waits waits_;
  algo::ScanPoints trail_{};
  algo::Pose2 pose_W_{};                  // the newest one
  algo::Pose2 wheels_{};                  // the odometry then
  std::optional<algo::Pose2> scanned_{};  // the odometry at the newest scan
  bool located_ = false;
  std::uint32_t epoch_ = 0;
};

}  // namespace server
