// server/record/headless.hpp: one run from start to outcome with nobody watching: command line,
// REST.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "algo/robot.hpp"
#include "server/record/recorder.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"

namespace server {

/// The end of a run in the terms of the one who watches it.
struct Ending {
  algo::Outcome outcome = algo::Outcome::Running;
  std::string reason{};  // one sentence where the outcome does not speak for itself
};

struct HeadlessOptions {
  double pace = 0;                       // times real time; 0 = as fast as it goes
  bool hash_frames = false;              // needs every frame encoded: the record does that anyway
  std::shared_ptr<RunChannel> record{};  // null: not kept
  std::function<bool()> cancelled{};     // asked once at the end: the run is then `cancelled`
  std::function<void(double stamp, std::uint64_t ticks)> progress{};  // about ten times a second
  /// Sees each tick, on the thread of the run. The ending that it gives ends the run.
  std::function<std::optional<Ending>(const algo::Telemetry& t)> watch{};
  bool until_watch = false;  // neither the loop's own outcome nor the time limit ends the run
};

struct HeadlessResult {
  RunResult run{};
  std::uint64_t telemetry_hash = 0;  // over the bytes of all frames, in order
};

/// Runs `robot`, which make_robot(spec) made, until reached, stuck, collided, out of time, the end
/// of the log, an ending that the watch gives, or `stop`, which interrupts it. The record channel
/// is closed with the result. Throws nothing of its own: what breaks a run is in the result.
HeadlessResult run_headless(const RunSpec& spec,
                            algo::Robot& robot,
                            const HeadlessOptions& options,
                            const std::stop_token& stop);

}  // namespace server
