// server/record/run_json.hpp: runs as rows for the database and as documents for people.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <nlohmann/json.hpp>

#include "algo/filter/filter.hpp"
#include "algo/metrics.hpp"
#include "db/records.hpp"
#include "db/run_reader.hpp"
#include "server/record/recorder.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"

namespace server {

/// The clearance is null without any obstacle: JSON has no infinity.
nlohmann::json to_json(const algo::Metrics& metrics);

/// The row that begins a run, with enough to run it again.
db::NewRun new_run(const RunSpec& spec, const algo::RobotSpec& robot);
/// As new_run(), for a headless run. The document also has the `pace`, to run it again from its
/// start.
db::NewRun headless_run(const RunSpec& spec, const algo::RobotSpec& robot, double pace);
/// The first outcome of a live run, which may drive on to further goals.
struct FirstOutcome {
  algo::Outcome outcome = algo::Outcome::Running;
  std::string reason{};
  algo::Metrics metrics{};  // at that time
};
/// The end of the row. A run that a person ended is finished, with the outcome `stopped`. A run
/// `cut` by the program's end before it had an outcome is interrupted. With a `verdict`, the row
/// keeps that, and the result is how the run went on.
db::RunEnd run_end(const RunResult& result,
                   bool cut = false,
                   const std::optional<FirstOutcome>& verdict = {});
/// The row of a live run that has the `verdict` and now the outcome `now`.
db::RunVerdict run_verdict(const std::optional<FirstOutcome>& verdict, algo::Outcome now);

/// The run's initial parameters, unchanged, even values that this program would refuse today.
/// Throws std::runtime_error for a parameter, or a filter, that this program does not have.
algo::Parameters stored_parameters(const db::RunRow& row);
algo::FilterKind stored_filter(const db::RunRow& row);

/// Options that all recorders of this program share. Their reports go to the log.
RecorderOptions recorder_options();

/// A run as GET /api/v1/runs lists it; with its document if the row holds one.
nlohmann::json to_json(const db::RunRow& row);
/// A single-valued column of a tick.
struct TickColumn {
  std::string_view name{};
  std::string_view unit{};
  std::variant<std::uint64_t, double, std::string_view> (*value)(const algo::Telemetry& t) =
      nullptr;
};
/// All columns. The clearance is the frame's, rounded to the micrometre.
std::span<const TickColumn> tick_columns();
nlohmann::json tick_json(const algo::Telemetry& t);

/// [UTC] now as ISO 8601 with milliseconds.
std::string wall_time();

}  // namespace server
