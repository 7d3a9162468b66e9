// tests/server/map_room.hpp: a room, its map, and a robot with poor wheels in it.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>

#include "tests/temporary_folder.hpp"
#include <nlohmann/json.hpp>

#include "server/run/map_file.hpp"
#include "server/run/map_robot.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/scenario_json.hpp"

namespace map_room {

/// A room of 16 x 9 m with things in it, one corner of it filled. The wheels report 5 % too much
/// and slip.
inline sim::Scenario poor_wheels_in_a_room() {
  const auto document = nlohmann::json::parse(R"({
    "name": "room", "physics": "kinematic", "controller": "strip", "time_limit": 90,
    "lasers": [{"field_of_view_deg": 360, "beams": 720}],
    "start": {"x": 1.5, "y": 1.5, "heading": 0}, "goal": {"x": 14, "y": 7.5},
    "drive": {"odometry_scale": 0.05, "yaw_slip": 0.05, "odometry_noise": 0.02,
              "odometry_slip": 0.05},
    "obstacles": [
      {"type": "wall", "x": 8, "y": 0, "length": 16, "thickness": 0.1},
      {"type": "wall", "x": 8, "y": 9, "length": 16, "thickness": 0.1},
      {"type": "wall", "x": 0, "y": 4.5, "length": 9, "thickness": 0.1, "heading": 1.5707963},
      {"type": "wall", "x": 16, "y": 4.5, "length": 9, "thickness": 0.1, "heading": 1.5707963},
      {"type": "box", "x": 5, "y": 4, "length": 2, "width": 1},
      {"type": "box", "x": 10, "y": 6, "length": 0.8, "width": 1.6},
      {"type": "cylinder", "x": 12, "y": 2, "radius": 0.5},
      {"type": "box", "x": 2.5, "y": 7.5, "length": 5, "width": 3}]})");
  return server::scenario_from_json(document);
}

/// Free cells and walls of the room as a map file would show them: walls are filled. Writes it to
/// `folder` too.
inline std::shared_ptr<const server::KnownMap> map_of(const sim::Scenario& scenario,
                                                      const std::filesystem::path& folder) {
  algo::OccupancyMap cells(0.05);
  for (int i = -20; i < 340; ++i) {
    for (int j = -20; j < 200; ++j) {
      const algo::Vec2 p = cells.centre({i, j});
      const auto filled = [&p](const algo::Obstacle& o) { return algo::signed_distance(o, p) < 0; };
      if (std::ranges::any_of(scenario.obstacles, filled)) {
        cells.mark_wall(p);
      } else if (p.x() > 0 && p.x() < 16 && p.y() > 0 && p.y() < 9) {
        cells.mark_free(p);
      }
    }
  }
  server::write_map(cells, folder / "room.yaml");
  return server::known_map(folder / "room.yaml");
}
inline std::shared_ptr<const server::KnownMap> map_of(const sim::Scenario& scenario) {
  const tests::TemporaryFolder folder;
  return map_of(scenario, folder.path());
}

inline server::RunSpec spec_of(const sim::Scenario& scenario, bool with_map, bool lost = false) {
  server::RunOverrides overrides;
  if (with_map) overrides.map = map_of(scenario);
  overrides.lost = lost;
  return server::make_spec(scenario, overrides);
}

}  // namespace map_room
