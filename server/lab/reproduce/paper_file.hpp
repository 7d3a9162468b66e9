// server/lab/reproduce/paper_file.hpp: the file of layouts, conditions and limits, read with care.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/metrics.hpp"
#include "algo/obstacle.hpp"
#include "algo/types.hpp"

namespace server {
/// server/lab/reproduce/paper.json, compiled in.
std::string_view embedded_paper();
}  // namespace server

namespace server::reproduce {

/// [m] of the one robot the papers have, and this program with it.
constexpr double kHullRadius = 0.35;

/// `common`: the conditions of every run, in SI. What a simulated robot here cannot have otherwise
/// (radius, beams, the used beams, the stuck rule) is checked or described there, not kept.
struct PaperConditions {
  algo::Pose2 start{};
  bool start_faces_goal = true;
  double safety_distance = 0;  // [m] d_safe
  double strip_step = 0;       // [m] S
  double arrival_radius = 0;   // [m]
  double max_turn_rate = 0;    // [rad/s]
  double heading_gain = 0;     // [1/s]
  double period = 0;           // [s] dt
  struct SlowPeriod {
    double v_max = 0;   // [m/s]
    double period = 0;  // [s] dt at that v_max
  };
  std::optional<SlowPeriod> slow{};
  double range_max = 0;  // [m]
  double noise = 0;      // [m] half width of the uniform noise
  std::string filter = "pseudomedian";
  int filter_half_width = 1;
  double time_limit_factor = 5;  // times straight line / v_max
};

/// `"path_mm_at_most": 7651`: a metric of figures.hpp and its limit, in the metric's own unit.
struct Limit {
  std::string metric{};
  bool at_least = false;
  double value = 0;
};

/// `accept`: what must hold for one reading.
struct Acceptance {
  std::string reading{};
  std::optional<algo::Outcome> outcome{};  // of every run
  std::optional<std::uint64_t> collisions{};
  std::vector<Limit> limits{};
};

/// `accept_compare`: the figure of `lower` is below that of `higher`.
struct Comparison {
  std::string metric{};
  std::string lower{};
  std::string higher{};
};

struct Layout {
  std::string name{};
  std::string source{};
  std::string expect{};  // in words
  algo::Vec2 goal_W{0, 0};
  double contraction_gain = 0;  // K_c
  double repulsion_gain = 0;    // K_r
  double v_max = 0;             // [m/s]
  std::vector<algo::Obstacle> obstacles{};
  std::vector<Acceptance> accept{};
  std::vector<Comparison> accept_compare{};
  std::vector<Acceptance> accept_noise_free{};  // the same over one run without noise
};

struct PaperFile {
  std::string about{};
  PaperConditions common{};
  std::vector<Layout> layouts{};
};

/// The readings of the strip in the order of the tables: those of `common.modes`, then our others.
std::span<const std::string_view> readings();

/// Throws DocumentError (json_reader.hpp) saying which field is unknown or malformed and how.
PaperFile paper_file_from_json(const nlohmann::json& document);
/// From a file. Throws std::runtime_error with the path and the complaint.
PaperFile read_paper_file(const std::string& path);
/// The copy within the program.
PaperFile embedded_paper_file();

}  // namespace server::reproduce
