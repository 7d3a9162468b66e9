// server/record/headless.hpp: one run from start to outcome with nobody watching: command line,
// REST.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>

#include "algo/robot.hpp"
#include "server/record/recorder.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"

namespace server {

struct HeadlessOptions {
  double pace = 0;                       // times real time; 0 = as fast as it goes
  bool hash_frames = false;              // needs every frame encoded: the record does that anyway
  std::shared_ptr<RunChannel> record{};  // null: not kept
  std::function<bool()> cancelled{};     // asked once at the end: the run is then `cancelled`
  std::function<void(double stamp, std::uint64_t ticks)> progress{};  // about ten times a second
};

struct HeadlessResult {
  RunResult run{};
  std::uint64_t telemetry_hash = 0;  // FNV-1a over the bytes of all frames, in order
};

/// Runs `robot`, which make_robot(spec) made, until reached, stuck, collided, out of time, the end
/// of the log, or `stop`, which interrupts it. The record channel is closed with the result. Throws
/// nothing of its own: what breaks a run is in the result.
HeadlessResult run_headless(const RunSpec& spec,
                            algo::Robot& robot,
                            const HeadlessOptions& options,
                            const std::stop_token& stop);

}  // namespace server
