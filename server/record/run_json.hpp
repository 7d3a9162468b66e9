// server/record/run_json.hpp: runs as rows for the database and as documents for people.
#pragma once

#include <cstdint>
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

/// A clearance without any obstacle is null: JSON knows no infinity.
nlohmann::json to_json(const algo::Metrics& metrics);

/// The row that begins a run: enough to run it again.
db::NewRun new_run(const RunSpec& spec, const algo::RobotSpec& robot);
/// The same of a run with nobody at it: its document has the `pace` too, with which it can be run
/// again from its start.
db::NewRun headless_run(const RunSpec& spec, const algo::RobotSpec& robot, double pace);
/// The row's end. A run ended by a person is finished all the same; its outcome says `stopped`.
/// One that was `cut` by the end of the program before it came to an outcome is interrupted.
db::RunEnd run_end(const RunResult& result, bool cut = false);

/// What the run began with, as it was: what today's program would refuse was accepted once. Throws
/// std::runtime_error for what this program has not.
algo::Parameters stored_parameters(const db::RunRow& row);
algo::FilterKind stored_filter(const db::RunRow& row);

/// Options every recorder of this program shares; what it reports goes to the log.
RecorderOptions recorder_options();

/// A run as GET /api/v1/runs lists it; with its document when the row holds one.
nlohmann::json to_json(const db::RunRow& row);
/// A plain column of a tick.
struct TickColumn {
  std::string_view name{};
  std::variant<std::uint64_t, double, std::string_view> (*value)(const algo::Telemetry& t) =
      nullptr;
};
/// All of them. The clearance is that of the frame, to the micrometre.
std::span<const TickColumn> tick_columns();
nlohmann::json tick_json(const algo::Telemetry& t);

/// [UTC] now as ISO 8601 with milliseconds.
std::string wall_time();

}  // namespace server
