// server/lab/reproduce/study_file.hpp: the document of a study: conditions, scenarios, limits and
// sweeps, in SI units.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/metrics.hpp"
#include "algo/parameters.hpp"
#include "sim/scenario.hpp"

namespace server {
/// server/lab/reproduce/study.json, compiled in.
std::string_view embedded_study();
}  // namespace server

namespace server::reproduce {

/// [m] hull radius of the papers' robot, and of this program's.
constexpr double kHullRadius = 0.35;
/// Millimetres in a metre: the papers' tables use millimetres, and so do ours.
constexpr double kMillimetres = 1000;

/// `conditions` of every run; they replace the scenarios' own.
struct PaperConditions {
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

/// One entry of `limits`: one requirement on one scenario and controller.
struct Limit {
  std::string scenario{};
  std::string controller{};
  bool noise_free = false;                    // applies to one run without noise
  std::optional<algo::Outcome> outcome{};     // of every run
  std::optional<std::uint64_t> collisions{};  // in all runs
  std::string figure{};                       // a column of a judge, and its bound:
  std::optional<double> at_least{};           // in the figure's unit
  std::optional<double> at_most{};
  std::string below{};  // a controller whose figure must be higher
};

/// One entry of `sweeps`: one parameter over all scenarios.
struct SweepPlan {
  const algo::ParameterInfo* parameter = nullptr;
  std::vector<std::string> controllers{};
  std::vector<double> values{};  // SI
};

struct StudyFile {
  PaperConditions conditions{};
  std::vector<sim::Scenario> scenarios{};
  std::vector<Limit> limits{};
  std::vector<SweepPlan> sweeps{};
};

/// The readings of the strip in the order of the tables: the papers' own, then ours.
std::span<const std::string_view> readings();

/// Throws DocumentError (json_reader.hpp) saying which field is unknown or malformed, and why.
StudyFile study_file_from_json(const nlohmann::json& document);
/// Reads a file. Throws std::runtime_error with the path and the fault.
StudyFile read_study_file(const std::string& path);
/// The copy compiled into the program.
StudyFile embedded_study_file();

}  // namespace server::reproduce
