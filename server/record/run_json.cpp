// server/record/run_json.cpp: runs as rows and documents.
#include "server/record/run_json.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "algo/pipeline/parameter_table.hpp"
#include "server/record/record_sink.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/paths.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/version.hpp"

namespace server {

using nlohmann::json;

json to_json(const algo::Metrics& m) {
  json out = {{"ticks", m.ticks},
              {"time", m.time},
              {"path_length", m.path_length},
              {"intrusion", m.intrusion},
              {"infringed_time", m.infringed_time},
              {"turning", m.turning},
              {"via_points", m.via_points},
              {"collided", m.collided}};
  out["min_clearance"] = std::isfinite(m.min_clearance) ? json(m.min_clearance) : json(nullptr);
  return out;
}

std::string wall_time() {
  const auto now = std::chrono::system_clock::now();
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch());
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)),
                     ms.count() % 1000);
}

db::NewRun new_run(const RunSpec& spec, const algo::RobotSpec& robot) {
  db::NewRun row;
  row.scenario = spec.scenario.name;
  row.document = dump_json(run_document(spec, robot));
  row.controller = spec.scenario.controller;
  row.filter = spec.scenario.filter;
  row.physics = physics_of(spec);
  row.seed = spec.seed;
  row.parameters = to_json(spec.parameters).dump();
  row.version = kVersion;
  row.started = wall_time();
  return row;
}

db::NewRun headless_run(const RunSpec& spec, const algo::RobotSpec& robot, double pace) {
  db::NewRun row = new_run(spec, robot);
  row.kind = db::RunKind::Background;
  json document = run_document(spec, robot);
  document["pace"] = pace;
  row.document = dump_json(document);
  return row;
}

namespace {
std::string metrics_text(algo::Outcome outcome, const algo::Metrics& metrics) {
  json out = to_json(metrics);
  out["outcome"] = algo::name(outcome);
  return out.dump();
}
}  // namespace

db::RunEnd run_end(const RunResult& result, bool cut, const std::optional<FirstOutcome>& verdict) {
  const bool interrupted = cut && result.outcome == algo::Outcome::Stopped;
  const bool failed = result.outcome == algo::Outcome::Failed;
  db::RunEnd end;
  end.status = interrupted ? db::RunStatus::Interrupted
               : failed    ? db::RunStatus::Failed
                           : db::RunStatus::Finished;
  const std::string reason =
      interrupted ? "The program was stopped in the middle of this run." : result.reason;
  const db::RunVerdict row = run_verdict(verdict, result.outcome);
  end.outcome = verdict ? row.outcome : std::string(algo::name(result.outcome));
  end.reason = verdict ? row.reason : reason;
  end.metrics = verdict ? row.metrics : metrics_text(result.outcome, result.metrics);
  end.last_outcome = row.last_outcome;
  if (!end.last_outcome.empty()) end.last_reason = reason;
  end.lost_ticks = result.lost_ticks;
  return end;
}

db::RunVerdict run_verdict(const std::optional<FirstOutcome>& verdict, algo::Outcome now) {
  db::RunVerdict row;
  row.outcome = algo::name(verdict ? verdict->outcome : now);
  if (!verdict) return row;
  row.reason = verdict->reason;
  row.metrics = metrics_text(verdict->outcome, verdict->metrics);
  if (now != verdict->outcome) row.last_outcome = algo::name(now);
  return row;
}

RecorderOptions recorder_options() {
  RecorderOptions options;
  options.ring_frames = kRecordRing;
  // Only a server has a limit, and a person who could make room.
  options.retention_bytes = 0;
  options.wait_for_room = false;
  options.report = [](const std::string& sentence) { spdlog::warn(sentence); };
  return options;
}

namespace {
/// How a live run went on after its verdict; null if it did not.
json later_of(const db::RunRow& row) {
  constexpr double kOn = 1;  // [s] in which a run comes to its end
  if (row.metrics.empty() || row.what.kind != db::RunKind::Session) return nullptr;
  if (row.last_outcome.empty() && row.time - row.verdict_time < kOn) return nullptr;
  return {{"outcome", row.last_outcome.empty() ? row.outcome : row.last_outcome},
          {"reason", without_folders(row.last_reason)},
          {"time", row.time}};
}
}  // namespace

json to_json(const db::RunRow& row) {
  const auto parsed = [](const std::string& text) {
    return text.empty() ? json(nullptr) : json::parse(text, nullptr, false);
  };
  json out = {{"id", row.id},
              {"status", db::to_string(row.status)},
              {"outcome", row.outcome},
              {"reason", without_folders(row.reason)},
              {"scenario", row.what.scenario},
              {"controller", row.what.controller},
              {"filter", row.what.filter},
              {"physics", row.what.physics},
              {"vehicle", row.what.physics},  // its old name
              {"seed", row.what.seed},
              {"parameters", parsed(row.what.parameters)},
              {"version", row.what.version},
              {"started", row.what.started},
              {"kind", db::to_string(row.what.kind)},
              {"batch", row.what.batch > 0 ? json(row.what.batch) : json(nullptr)},
              {"label", row.label},
              {"note", row.note},
              {"tags", row.tags},
              {"result", row.result},
              {"ticks", row.ticks},
              {"time", row.verdict_time},
              {"end_time", row.time},
              {"later", later_of(row)},
              {"lost_ticks", row.lost_ticks},
              {"bytes", row.bytes},
              {"metrics", parsed(row.metrics)}};
  if (row.group) {
    out["group"] = {{"runs", row.group->runs},
                    {"first", row.group->first},
                    {"last", row.group->last},
                    {"results", row.group->counts}};
  }
  if (!row.gaps.empty()) out["gaps"] = json::array();
  for (const db::Gap& gap : row.gaps) {
    out["gaps"].push_back({{"first_tick", gap.first_tick},
                           {"last_tick", gap.last_tick},
                           {"cause", db::to_string(gap.cause)},
                           {"sentence", gap.sentence}});
  }
  if (!row.what.document.empty()) {
    out["document"] = parsed(row.what.document);
    if (out["document"].is_object()) out["document"].erase("map");  // long, and of use to verify
  }
  return out;
}

algo::Parameters stored_parameters(const db::RunRow& row) {
  algo::Parameters out;
  const nlohmann::json values = parse_json(row.what.parameters, kOwnDocument);
  for (const auto& [name, value] : values.items()) {
    const algo::ParameterInfo* const parameter = algo::find_parameter(name);
    if (parameter == nullptr) {
      throw std::runtime_error(
          fmt::format("Run {} used a parameter '{}', which this program has not.", row.id, name));
    }
    out.set(*parameter, value.get<double>());
  }
  return out;
}

algo::FilterKind stored_filter(const db::RunRow& row) {
  const auto filter = algo::find_filter(row.what.filter);
  if (!filter) throw std::runtime_error(fmt::format("Run {} used an unknown filter.", row.id));
  return *filter;
}

std::span<const TickColumn> tick_columns() {
  using T = algo::Telemetry;
  using Value = decltype(TickColumn{}.value(T{}));
  static constexpr auto kColumns = std::to_array<TickColumn>({
      {"tick", "", [](const T& t) -> Value { return t.tick; }},
      {"t", "s", [](const T& t) -> Value { return t.observation.stamp; }},
      {"x", "m", [](const T& t) -> Value { return t.observation.odometry.pose.x; }},
      {"y", "m", [](const T& t) -> Value { return t.observation.odometry.pose.y; }},
      {"heading", "rad", [](const T& t) -> Value { return t.observation.odometry.pose.heading; }},
      {"v", "m/s", [](const T& t) -> Value { return t.command.base.v; }},
      {"omega", "rad/s", [](const T& t) -> Value { return t.command.base.omega; }},
      // The frame's clearance is a float.
      {"clearance", "m", [](const T& t) -> Value { return std::round(t.clearance * 1e6) / 1e6; }},
      {"hold", "", [](const T& t) -> Value { return algo::name(t.hold); }},
      {"behaviour", "", [](const T& t) -> Value { return t.behaviour.view(); }},
  });
  return kColumns;
}

json tick_json(const algo::Telemetry& t) {
  json out;
  for (const TickColumn& column : tick_columns()) {
    std::visit([&](const auto& value) { out[std::string(column.name)] = value; }, column.value(t));
  }
  return out;
}

}  // namespace server
