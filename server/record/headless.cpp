// server/record/headless.cpp: the run loop without rings.
#include "server/record/headless.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <span>

#include "server/record/record_sink.hpp"
#include "server/record/run_json.hpp"

namespace server {
namespace {

/// Continues the hash over `bytes`, eight at a time: one at a time took 15 % of a kinematic run.
std::uint64_t hash_on(std::uint64_t hash, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t count = std::min(bytes.size(), sizeof word);
    std::memcpy(&word, bytes.data(), count);
    hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 29U;
    bytes = bytes.subspan(count);
  }
  return hash;
}

}  // namespace

HeadlessResult run_headless(const RunSpec& spec,
                            algo::Robot& robot,
                            const HeadlessOptions& options,
                            const std::stop_token& stop) {
  HeadlessResult result;
  const bool encodes = options.record != nullptr || options.hash_frames;
  constexpr std::size_t kNowAndNext = 2;  // frames in use when none is kept
  const std::shared_ptr<FramePool> pool =
      encodes ? FramePool::growing<EncodedFrame>(
                    kPoolFrames, kPoolFrames, std::make_shared<FrameRoom>(0))
              : FramePool::make(kNowAndNext);
  std::unique_ptr<RecordSink> sink;
  if (options.record) sink = std::make_unique<RecordSink>(options.record);
  std::stop_source over;
  algo::PipelineConfig config = pipeline_config(spec);
  config.by_hand = false;  // no operator
  config.run.stop = over.get_token();
  algo::Pipeline pipeline(config, robot.spec(), controllers_of(spec));
  Pacer pacer({.speed = options.pace});
  const std::stop_callback wake(stop, [&] { over.request_stop(); });

  auto next_progress = std::chrono::steady_clock::now();
  std::optional<Ending> ending;
  RunLinks links;
  links.pool = pool.get();
  links.record = sink.get();
  links.pacer = &pacer;
  links.listeners.push_back([&](const Frame& frame) {
    if (options.hash_frames) {
      result.telemetry_hash = hash_on(result.telemetry_hash, encoded(frame).bytes());
    }
    if (options.watch) ending = options.watch(frame.telemetry);
    if (ending) over.request_stop();
    if (!options.progress || std::chrono::steady_clock::now() < next_progress) return;
    next_progress = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
    options.progress(frame.telemetry.observation.stamp, frame.telemetry.tick + 1);
  });
  const RunPolicy policy{.until_outcome = !options.until_watch,
                         .time_limit = options.until_watch ? 0 : time_limit(spec)};
  result.run = run(robot, pipeline, first_requests(spec), policy, links, over.get_token());
  if (ending) {
    result.run.outcome = ending->outcome;
    result.run.reason = std::move(ending->reason);
  } else if (result.run.outcome == algo::Outcome::Running ||
             (options.until_watch && stop.stop_requested())) {
    result.run.outcome = algo::Outcome::Stopped;
  }
  if (options.record) {
    const bool cancelled = options.cancelled && options.cancelled();
    db::RunEnd end = run_end(result.run, stop.stop_requested() && !cancelled);
    if (cancelled) end.status = db::RunStatus::Cancelled;
    options.record->close(std::move(end), result.run.metrics.ticks);
  }
  return result;
}

}  // namespace server
