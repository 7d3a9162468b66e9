// server/lab/reproduce/study_file.cpp: reads every field of the document and refuses bad values.
#include "server/lab/reproduce/study_file.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "algo/filter/filter.hpp"
#include "algo/pipeline/parameter_table.hpp"
#include "server/experiment/series.hpp"
#include "server/run/json_fields.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/text_file.hpp"

namespace server::reproduce {
namespace {

using nlohmann::json;
constexpr std::size_t kMaxScenarios = 200;
constexpr std::size_t kMaxLimits = 10'000;
constexpr std::size_t kMaxValues = 100;
constexpr NumberRange kPeriod{0.002, 0.2};  // [s] no longer than the scan timeout of the robot

constexpr auto kReadingNames = std::to_array<std::string_view>({"original",
                                                                "modified_published",
                                                                "modified_linear",
                                                                "modified_c1",
                                                                "modified",
                                                                "via_kept",
                                                                "original_side"});

using Paper = PaperConditions;
constexpr Field<Paper> kConditions[] = {
    required("safety_distance", &Paper::safety_distance, {0.1, 3}),
    required("strip_step", &Paper::strip_step, {0.05, 0.6}),
    required("arrival_radius", &Paper::arrival_radius, {0.02, 1}),
    required("max_turn_rate", &Paper::max_turn_rate, {0.1, 1}),
    required("heading_gain", &Paper::heading_gain, {0.5, 5}),
    required("period", &Paper::period, kPeriod),
    {"slow"},
    required("range_max", &Paper::range_max, {0.1, 8.191}),
    required("noise", &Paper::noise, {0, 1}),
    {"filter"},
    {"filter_half_width"},
    required("time_limit_factor", &Paper::time_limit_factor, {1, 100}),
};

PaperConditions read_conditions(const JsonReader& in) {
  PaperConditions out;
  read_only_fields(in, kConditions, out);
  if (in.has("slow")) {
    const JsonReader slow = in.object("slow");
    slow.only({"v_max", "period"});
    out.slow = {slow.number("v_max", {0.01, 0.5}), slow.number("period", kPeriod)};
  }
  out.filter = in.text("filter", 64);
  if (!algo::find_filter(out.filter)) {
    in.fail("filter", fmt::format("'{}' is unknown", out.filter));
  }
  out.filter_half_width = static_cast<int>(in.whole("filter_half_width", 99));
  return out;
}

std::string known_reading(const std::string& path, std::string name) {
  if (std::ranges::find(kReadingNames, name) != kReadingNames.end()) return name;
  throw DocumentError(
      path, fmt::format("'{}' is no reading; there are {}", name, fmt::join(kReadingNames, ", ")));
}

std::string reading_name(const JsonReader& in, std::string_view key) {
  return known_reading(in.at(key), in.text(key, 64));
}

algo::Outcome read_outcome(const JsonReader& in) {
  const std::string text = in.text("outcome", 64);
  for (const auto outcome : {algo::Outcome::Reached,
                             algo::Outcome::Stuck,
                             algo::Outcome::OutOfTime,
                             algo::Outcome::Collided}) {
    if (text == algo::name(outcome)) return outcome;
  }
  in.fail("outcome",
          fmt::format("'{}' is unknown; known are reached, stuck, out_of_time, collided", text));
}

void read_figure(const JsonReader& in, Limit& limit) {
  limit.figure = in.text("figure", 64);
  if (!experiment::is_figure(limit.figure)) {
    in.fail("figure", fmt::format("'{}' is no column of a judge", limit.figure));
  }
  if (in.has("at_least")) limit.at_least = in.number("at_least");
  if (in.has("at_most")) limit.at_most = in.number("at_most");
  if (in.has("below")) limit.below = reading_name(in, "below");
  const int bounds = (limit.at_least ? 1 : 0) + (limit.at_most ? 1 : 0) + (in.has("below") ? 1 : 0);
  if (bounds != 1) in.fail("figure", "must have one of at_least, at_most and below");
}

Limit read_limit(const JsonReader& in, const std::set<std::string>& scenarios) {
  in.only({"scenario",
           "controller",
           "noise_free",
           "outcome",
           "collisions",
           "figure",
           "at_least",
           "at_most",
           "below"});
  Limit limit;
  limit.scenario = in.text("scenario", 64);
  if (!scenarios.contains(limit.scenario)) {
    in.fail("scenario", fmt::format("no scenario of the file is called '{}'", limit.scenario));
  }
  limit.controller = reading_name(in, "controller");
  limit.noise_free = in.flag_or("noise_free", false);
  const int asked =
      (in.has("outcome") ? 1 : 0) + (in.has("collisions") ? 1 : 0) + (in.has("figure") ? 1 : 0);
  if (asked != 1) in.fail("controller", "must be asked one of outcome, collisions and figure");
  if (in.has("outcome")) limit.outcome = read_outcome(in);
  if (in.has("collisions")) limit.collisions = in.whole("collisions", 1'000'000);
  if (in.has("figure")) read_figure(in, limit);
  return limit;
}

SweepPlan read_sweep(const JsonReader& in) {
  in.only({"parameter", "controllers", "values"});
  SweepPlan plan;
  const std::string name = in.text("parameter", 64);
  plan.parameter = algo::find_parameter(name);
  if (plan.parameter == nullptr) in.fail("parameter", fmt::format("'{}' is unknown", name));
  in.each("controllers", kReadingNames.size(), [&](const json& value, const std::string& at) {
    if (!value.is_string()) throw DocumentError(at, "must be text");
    plan.controllers.push_back(known_reading(at, value));
  });
  in.each("values", kMaxValues, [&](const json& value, const std::string& at) {
    plan.values.push_back(finite_number(value, at));
  });
  if (plan.values.size() < 2) in.fail("values", "must be two or more");
  return plan;
}

StudyFile from_text(std::string_view text) {
  return study_file_from_json(parse_json(text, {.max_depth = 64, .max_bytes = 16u << 20}));
}

}  // namespace

std::span<const std::string_view> readings() {
  return kReadingNames;
}

StudyFile study_file_from_json(const json& document) {
  const JsonReader in(document, "");
  in.only({"about", "conditions", "scenarios", "limits", "sweeps"});
  StudyFile file;
  in.text_or("about", "");
  file.conditions = read_conditions(in.object("conditions"));
  std::set<std::string> names;
  in.each("scenarios", kMaxScenarios, [&](const json& value, const std::string& at) {
    try {
      file.scenarios.push_back(scenario_from_json(value));
    } catch (const DocumentError& e) {
      throw DocumentError(at, e.what());
    }
    const sim::Scenario& scenario = file.scenarios.back();
    if (!scenario.goal) throw DocumentError(at + "/goal", "is missing");
    if (!names.insert(scenario.name).second) {
      throw DocumentError(at + "/name", fmt::format("'{}' is used twice", scenario.name));
    }
  });
  if (names.empty()) in.fail("scenarios", "has no entries");
  if (in.has("limits")) {
    in.each("limits", kMaxLimits, [&](const json& value, const std::string& at) {
      file.limits.push_back(read_limit({value, at}, names));
    });
  }
  if (in.has("sweeps")) {
    in.each("sweeps", kMaxValues, [&](const json& value, const std::string& at) {
      file.sweeps.push_back(read_sweep({value, at}));
    });
  }
  return file;
}

StudyFile read_study_file(const std::string& path) {
  const std::string text = read_text(path);
  try {
    return from_text(text);
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("{}: {}", path, e.what()));
  }
}

StudyFile embedded_study_file() {
  return from_text(embedded_study());
}

}  // namespace server::reproduce
