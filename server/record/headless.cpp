// server/record/headless.cpp: the run loop without rings.
#include "server/record/headless.hpp"

#include <chrono>
#include <span>

#include "server/record/record_sink.hpp"
#include "server/record/run_json.hpp"

namespace server {
namespace {

std::uint64_t fnv1a(std::span<const std::byte> bytes, std::uint64_t hash) {
  for (const std::byte b : bytes) {
    hash ^= static_cast<std::uint64_t>(b);
    hash *= 0x100000001b3ULL;
  }
  return hash;
}

}  // namespace

HeadlessResult run_headless(const RunSpec& spec,
                            algo::Robot& robot,
                            const HeadlessOptions& options,
                            const std::stop_token& stop) {
  HeadlessResult result;
  result.telemetry_hash = 0xcbf29ce484222325ULL;
  const bool encodes = options.record != nullptr || options.hash_frames;
  constexpr std::size_t kNowAndNext = 2;  // frames in use where nobody keeps one
  const std::shared_ptr<FramePool> pool =
      encodes ? FramePool::growing<EncodedFrame>(
                    kPoolFrames, kPoolFrames, std::make_shared<FrameRoom>(0))
              : FramePool::make(kNowAndNext);
  std::unique_ptr<RecordSink> sink;
  if (options.record) sink = std::make_unique<RecordSink>(options.record);
  algo::PipelineConfig config = pipeline_config(spec);
  config.by_hand = false;  // nobody is there
  algo::Pipeline pipeline(config, robot.spec());
  Pacer pacer({.speed = options.pace});
  std::stop_source over;
  const std::stop_callback wake(stop, [&] { over.request_stop(); });

  auto next_progress = std::chrono::steady_clock::now();
  std::optional<Ending> ending;
  RunLinks links;
  links.pool = pool.get();
  links.record = sink.get();
  links.pacer = &pacer;
  links.listeners.push_back([&](const Frame& frame) {
    if (options.hash_frames) {
      result.telemetry_hash = fnv1a(encoded(frame).bytes(), result.telemetry_hash);
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
