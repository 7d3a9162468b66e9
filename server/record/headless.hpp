// server/record/headless.hpp: one run from start to outcome without viewers, for the command line
// and REST.
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

/// The end of a run, as judged by the watch function.
struct Ending {
  algo::Outcome outcome = algo::Outcome::Running;
  std::string reason{};  // a sentence if the outcome needs a reason
};

struct HeadlessOptions {
  double pace = 0;                       // times real time; 0 = as fast as possible
  bool hash_frames = false;              // needs every frame encoded, which the record does anyway
  std::shared_ptr<RunChannel> record{};  // null: not recorded
  std::function<bool()> cancelled{};     // asked once at the end; true marks the run `cancelled`
  std::function<void(double stamp, std::uint64_t ticks)> progress{};  // about ten times a second
  /// Sees each tick on the run's thread. If it returns an ending, the run ends.
  std::function<std::optional<Ending>(const algo::Telemetry& t)> watch{};
  bool until_watch = false;  // neither the loop's own outcome nor the time limit ends the run
};

struct HeadlessResult {
  RunResult run{};
  std::uint64_t telemetry_hash = 0;  // over the bytes of all frames, in order
};

/// Runs `robot`, made by make_robot(spec), until it has reached its goal, is stuck, has collided or
/// is out of time, the log ends, the watch returns an ending, or `stop` interrupts it. Closes the
/// record channel with the result. Throws nothing of its own: the result says why a run broke.
HeadlessResult run_headless(const RunSpec& spec,
                            algo::Robot& robot,
                            const HeadlessOptions& options,
                            const std::stop_token& stop);

}  // namespace server
