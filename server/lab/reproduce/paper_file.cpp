// server/lab/reproduce/paper_file.cpp: every field of the file, its unit and its complaint.
#include "server/lab/reproduce/paper_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "algo/filter/filter.hpp"
#include "server/experiment/figures.hpp"
#include "server/lab/reproduce/triangulate.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/obstacle_json.hpp"
#include "server/run/scenario_json.hpp"

namespace server::reproduce {
namespace {

using nlohmann::json;
constexpr double kPerMillimetre = 1e-3;  // [m]
constexpr std::size_t kMaxLayouts = 200;
constexpr NumberRange kCoordinate_mm{-1e6, 1e6};

constexpr auto kReadings = std::to_array<std::string_view>({"original",
                                                            "modified_published",
                                                            "modified_linear",
                                                            "modified_c1",
                                                            "modified",
                                                            "via_kept",
                                                            "original_side"});

double millimetres(const JsonReader& in, std::string_view key, NumberRange range_mm) {
  return in.number(key, range_mm) * kPerMillimetre;
}

/// Where a robot of this program has the one value, the file must say the same.
void require(const JsonReader& in, std::string_view key, double only) {
  if (in.number(key) != only) {
    in.fail(key, fmt::format("is {:g}; this program has {:g} only", in.number(key), only));
  }
}

/// The numbers that `pattern` catches in the text of `key`; what it does not catch is 0.
std::vector<double> numbers_in(const JsonReader& in,
                               std::string_view key,
                               const char* pattern,
                               std::string_view form) {
  const std::string text = in.text(key);
  std::smatch match;
  if (!std::regex_search(text, match, std::regex(pattern))) {
    in.fail(key, fmt::format("'{}' must begin as in {}", text.substr(0, 60), form));
  }
  std::vector<double> found;
  for (std::size_t i = 1; i < match.size(); ++i) {
    found.push_back(match[i].matched ? std::strtod(match[i].str().c_str(), nullptr) : 0);
  }
  return found;
}

#define NUMBER R"((\d+(?:\.\d+)?))"

void read_period(const JsonReader& in, PaperConditions& out) {
  const auto n = numbers_in(in,
                            "dt",
                            "^" NUMBER " s(?: \\(" NUMBER " s where v_max = " NUMBER "\\))?(?:$|;)",
                            "'0.05 s' or '0.05 s (0.1 s where v_max = 40)'");
  // No longer than the scan timeout of the robot, 0.2 s.
  const auto check = [&](double period) {
    if (!(period >= 0.002 && period <= 0.2)) {
      in.fail("dt", fmt::format("has {:g} s, must lie in 0.002 to 0.2 s", period));
    }
  };
  check(out.period = n[0]);
  if (n[2] == 0) return;
  check(n[1]);
  out.slow = PaperConditions::SlowPeriod{n[2] * kPerMillimetre, n[1]};
}

void read_filter(const JsonReader& in, PaperConditions& out) {
  const std::string text = in.text("filter");
  std::smatch match;
  if (!std::regex_search(text, match, std::regex(R"(^([a-z]+)(?: N = (\d{1,2}))?(?:$|,))"))) {
    in.fail("filter", fmt::format("'{}' must begin as in 'pseudomedian N = 1'", text));
  }
  out.filter = match[1].str();
  if (!algo::find_filter(out.filter)) {
    in.fail("filter", fmt::format("'{}' is unknown", out.filter));
  }
  if (match[2].matched) out.filter_half_width = std::stoi(match[2].str());
}

void read_lidar(const JsonReader& in, PaperConditions& out) {
  in.only({"beams", "resolution_deg", "max_range", "noise", "used_beams", "filter"});
  require(in, "beams", 361);
  require(in, "resolution_deg", 0.5);
  out.range_max = millimetres(in, "max_range", {100, 8191});
  out.noise = numbers_in(in,
                         "noise",
                         "^(?:uniform \\+-" NUMBER " mm|none)(?:$|,)",
                         "'uniform +-15 mm' or 'none'")[0] *
              kPerMillimetre;
  const json& used = in.array("used_beams", 2);
  if (used != json({31, 329})) {
    in.fail("used_beams", fmt::format("is {}; this program has [31,329] only", used.dump()));
  }
  read_filter(in, out);
}

void read_start(const JsonReader& in, PaperConditions& out) {
  in.only({"x", "y", "heading"});
  out.start.x = millimetres(in, "x", kCoordinate_mm);
  out.start.y = millimetres(in, "y", kCoordinate_mm);
  if (!in.has("heading") || in.raw().at("heading").is_string()) {
    if (in.text_or("heading", "towards the goal").rfind("towards the goal", 0) != 0) {
      in.fail("heading", "must be a number [rad] or begin with 'towards the goal'");
    }
    return;
  }
  out.start.heading = algo::wrap_angle(in.number("heading", {-1e3, 1e3}));
  out.start_faces_goal = false;
}

/// The fields of words only (tick, stuck_rule, metrics, ...) say what this program does; they are
/// for people and not read.
PaperConditions read_common(const JsonReader& in) {
  in.only({"units",          "world_frame",     "start",     "robot",
           "d_safe",         "d_robot",         "d_o",       "d_r",
           "strip_step_S",   "barrier_B",       "v_max",     "w_max",
           "arrival_radius", "heading_gain",    "dt",        "lidar",
           "stuck_rule",     "time_limit_s",    "metrics",   "tick",
           "modes",          "obstacle_fields", "statement", "accept_note"});
  PaperConditions out;
  if (in.text_or("units", "mm, s, rad") != "mm, s, rad") in.fail("units", "must be 'mm, s, rad'");
  read_start(in.object("start"), out);
  const JsonReader robot = in.object("robot");
  robot.only({"radius", "drive", "lidar_at"});
  require(robot, "radius", 350);
  out.safety_distance = millimetres(in, "d_safe", {100, 3000});
  if (in.has("d_robot")) require(in, "d_robot", 350);
  for (const char* key : {"d_o", "d_r"}) {
    const double reach = in.number("d_safe") + 350;
    if (in.has(key) && in.number(key) != reach) {
      in.fail(key, fmt::format("is {:g}, must be d_safe + 350 = {:g}", in.number(key), reach));
    }
  }
  out.strip_step = millimetres(in, "strip_step_S", {50, 600});
  if (in.text_or("barrier_B", "S/2") != "S/2") in.fail("barrier_B", "must be 'S/2'");
  out.arrival_radius = millimetres(in, "arrival_radius", {20, 1000});
  out.max_turn_rate = in.number("w_max", {0.1, 1.0});
  out.heading_gain = in.number("heading_gain", {0.5, 5});
  read_period(in, out);
  read_lidar(in.object("lidar"), out);
  out.time_limit_factor = numbers_in(in,
                                     "time_limit_s",
                                     "^" NUMBER " \\* straight-line distance / v_max$",
                                     "'5 * straight-line distance / v_max'")[0];
  if (!(out.time_limit_factor >= 1 && out.time_limit_factor <= 100)) {
    in.fail("time_limit_s", "must have a factor of 1 to 100");
  }
  if (in.has("modes")) {
    for (const auto& [mode, unused] : in.object("modes").raw().items()) {
      if (std::ranges::find(kReadings, mode) == kReadings.end()) {
        in.object("modes").fail(mode, "is no reading this program has");
      }
    }
  }
  return out;
}

#undef NUMBER

double metres(const JsonReader& in, const json& value, std::string_view key) {
  return finite_number(value, in.at(key), kCoordinate_mm) * kPerMillimetre;
}

/// Solid, with or without notches: one obstacle for each convex part.
std::vector<algo::Obstacle> read_polygon(const JsonReader& in) {
  in.only({"type", "points"});
  const json& points = in.array("points", 256);
  std::vector<algo::Vec2> outline;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string at = fmt::format("points/{}", i);
    if (!points[i].is_array() || points[i].size() != 2) in.fail(at, "must be a point [x, y]");
    outline.emplace_back(metres(in, points[i][0], at), metres(in, points[i][1], at));
  }
  // "Closed": the first vertex may be said again.
  if (outline.size() > 3 && outline.front() == outline.back()) outline.pop_back();
  const auto parts = convex_parts(outline);
  if (!parts)
    in.fail("points", "must be the outline of a solid: 3 or more, no crossing, some area");
  std::vector<algo::Obstacle> obstacles;
  for (const std::vector<algo::Vec2>& part : *parts) {
    json si{{"type", "polygon"}, {"points", json::array()}};
    for (const algo::Vec2& p : part) si["points"].push_back({p.x(), p.y()});
    obstacles.push_back(obstacle_from_json(si, in.at("points")));
  }
  return obstacles;
}

/// As in scenario files, but in millimetres.
std::vector<algo::Obstacle> read_obstacle(const json& value, const std::string& path) {
  const JsonReader in(value, path);
  const std::string type = in.text("type");
  if (type == "polygon") return read_polygon(in);
  if (type != "cylinder") {
    in.fail("type", fmt::format("'{}' is unknown; known are cylinder, polygon", type));
  }
  in.only({"type", "x", "y", "radius"});
  json si{{"type", type}};
  for (const char* key : {"x", "y", "radius"}) si[key] = millimetres(in, key, kCoordinate_mm);
  return {obstacle_from_json(si, path)};
}

std::string reading_name(const JsonReader& in, std::string_view key) {
  std::string name = in.text(key, 64);
  if (std::ranges::find(kReadings, name) == kReadings.end()) {
    in.fail(key, fmt::format("'{}' is no reading; there are {}", name, fmt::join(kReadings, ", ")));
  }
  return name;
}

algo::Outcome read_outcome(const JsonReader& in) {
  const std::string text = in.text("outcome");
  if (text == "timeout") return algo::Outcome::OutOfTime;
  for (const auto outcome : {algo::Outcome::Reached,
                             algo::Outcome::Stuck,
                             algo::Outcome::OutOfTime,
                             algo::Outcome::Collided}) {
    if (text == algo::name(outcome)) return outcome;
  }
  in.fail("outcome",
          fmt::format("'{}' is unknown; known are reached, stuck, timeout, collided", text));
}

Limit read_limit(const JsonReader& in, const std::string& key) {
  constexpr std::size_t kLeast = std::string_view("_at_least").size();
  constexpr std::size_t kMost = std::string_view("_at_most").size();
  Limit limit;
  limit.at_least = key.ends_with("_at_least");
  if (limit.at_least || key.ends_with("_at_most")) {
    limit.metric = key.substr(0, key.size() - (limit.at_least ? kLeast : kMost));
  }
  if (find_metric(limit.metric) == nullptr) {
    std::string known;
    for (const MetricInfo& metric : metric_table()) known += fmt::format(" {}", metric.name);
    in.fail(
        key,
        "must be outcome, collisions, or a metric and _at_least or _at_most; metrics are" + known);
  }
  limit.value = in.number(key);
  return limit;
}

std::vector<Acceptance> read_accept(const JsonReader& scenario, std::string_view key) {
  std::vector<Acceptance> all;
  if (!scenario.has(key)) return all;
  const JsonReader by_reading = scenario.object(key);
  for (const auto& [name, unused] : by_reading.raw().items()) {
    if (std::ranges::find(kReadings, name) == kReadings.end()) {
      by_reading.fail(name, fmt::format("is no reading; there are {}", fmt::join(kReadings, ", ")));
    }
  }
  for (const std::string_view reading : kReadings) {
    if (!by_reading.has(reading)) continue;
    const JsonReader in = by_reading.object(reading);
    Acceptance accept{.reading = std::string(reading)};
    for (const auto& [field, unused] : in.raw().items()) {
      if (field == "outcome") {
        accept.outcome = read_outcome(in);
      } else if (field == "collisions") {
        accept.collisions = in.whole(field, 1'000'000);
      } else {
        accept.limits.push_back(read_limit(in, field));
      }
    }
    all.push_back(std::move(accept));
  }
  return all;
}

std::vector<Comparison> read_comparisons(const JsonReader& scenario) {
  std::vector<Comparison> all;
  if (!scenario.has("accept_compare")) return all;
  const json& list = scenario.array("accept_compare", 1000);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonReader in(list[i], fmt::format("{}/{}", scenario.at("accept_compare"), i));
    in.only({"metric", "lower", "higher"});
    Comparison comparison{
        in.text("metric", 64), reading_name(in, "lower"), reading_name(in, "higher")};
    if (find_metric(comparison.metric) == nullptr) {
      in.fail("metric", fmt::format("'{}' is no metric", comparison.metric));
    }
    all.push_back(std::move(comparison));
  }
  return all;
}

Layout read_layout(const JsonReader& in) {
  in.only({"name",
           "source",
           "goal",
           "K_c",
           "K_r",
           "v_max",
           "obstacles",
           "expect",
           "prototype_results",  // of another program: for people
           "accept",
           "accept_compare",
           "accept_noise_free"});
  Layout layout;
  layout.name = in.text("name", 64);
  if (!valid_scenario_name(layout.name)) {
    in.fail("name", "must be 1 to 64 of the characters a-z, 0-9, _ and -");
  }
  layout.source = in.text_or("source", "");
  layout.expect = in.text_or("expect", "");
  const json& goal = in.array("goal", 2);
  if (goal.size() != 2) in.fail("goal", "must be a point [x, y]");
  layout.goal_W = {metres(in, goal[0], "goal/0"), metres(in, goal[1], "goal/1")};
  layout.contraction_gain = in.number("K_c", {0, 1});
  layout.repulsion_gain = in.number("K_r", {0.05, 1});
  layout.v_max = millimetres(in, "v_max", {10, 500});
  const json& obstacles = in.array("obstacles", kMaxObstacles);
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const std::string path = fmt::format("{}/{}", in.at("obstacles"), i);
    for (algo::Obstacle& part : read_obstacle(obstacles[i], path)) {
      part.id = static_cast<std::uint32_t>(layout.obstacles.size() + 1);
      layout.obstacles.push_back(std::move(part));
    }
  }
  layout.accept = read_accept(in, "accept");
  layout.accept_compare = read_comparisons(in);
  layout.accept_noise_free = read_accept(in, "accept_noise_free");
  return layout;
}

PaperFile from_text(std::string_view text) {
  return paper_file_from_json(parse_json(text, {.max_depth = 64, .max_bytes = 16u << 20}));
}

}  // namespace

std::span<const std::string_view> readings() {
  return kReadings;
}

PaperFile paper_file_from_json(const json& document) {
  const JsonReader in(document, "");
  in.only({"about", "common", "scenarios"});
  PaperFile file;
  file.about = in.text_or("about", "");
  file.common = read_common(in.object("common"));
  const json& list = in.array("scenarios", kMaxLayouts);
  if (list.empty()) in.fail("scenarios", "has no entries");
  std::set<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonReader scenario(list[i], fmt::format("scenarios/{}", i));
    file.layouts.push_back(read_layout(scenario));
    if (!names.insert(file.layouts.back().name).second) {
      scenario.fail("name", fmt::format("'{}' is used twice", file.layouts.back().name));
    }
  }
  return file;
}

PaperFile read_paper_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw std::runtime_error(path + ": cannot be read");
  try {
    return from_text(text.str());
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("{}: {}", path, e.what()));
  }
}

PaperFile embedded_paper_file() {
  return from_text(embedded_paper());
}

}  // namespace server::reproduce
