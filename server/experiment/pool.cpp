// server/experiment/pool.cpp: one loop for every worker.
#include "server/experiment/pool.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace server::experiment {
namespace {

unsigned one_a_core(unsigned threads) {
  return threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
}

}  // namespace

Pool::Pool(unsigned threads, Source source, const std::stop_token& stop)
    : source_(std::move(source)), cut_(stop, [this] { request_stop(); }) {
  threads = one_a_core(threads);
  for (unsigned i = 0; i < threads; ++i) workers_.emplace_back([this] { work(); });
}

void Pool::work() {
  const std::stop_token stop = stop_.get_token();
  try {
    while (!stop.stop_requested()) {
      const Job job = source_(stop);
      if (!job) return;
      job();
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!problem_) problem_ = std::current_exception();
    request_stop();
  }
}

void Pool::join() {
  workers_.clear();
  if (problem_) std::rethrow_exception(std::exchange(problem_, nullptr));
}

Shard shard_from_text(std::string_view text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  const bool parted = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
  const auto count = parted ? std::from_chars(index.ptr + 1, end, shard.count) : index;
  if (!parted || count.ec != std::errc() || count.ptr != end || shard.index >= shard.count) {
    throw std::invalid_argument(fmt::format(
        "'{}' is no shard; it must be as 0/3, the first number below the second", text));
  }
  return shard;
}

PoolOptions part_of(std::string name, unsigned threads, const NamedProgress& progress) {
  PoolOptions options{.threads = threads};
  if (!progress) return options;
  options.progress = [name = std::move(name), progress](std::size_t done, std::size_t all) {
    progress(name, done, all);
  };
  return options;
}

void for_each(std::size_t count,
              const PoolOptions& options,
              const std::function<void(std::size_t, const std::stop_token&)>& job) {
  const std::size_t own = options.shard.share(count);
  if (own == 0) return;
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // guards `done` and options.progress
  std::size_t done = 0;
  const std::size_t threads = std::min<std::size_t>(one_a_core(options.threads), own);
  const auto source = [&](const std::stop_token& stop) -> Pool::Job {
    const std::size_t k = next++;
    if (k >= own) return {};
    return [&, k, stop] {
      job(options.shard.job(k), stop);
      const std::lock_guard lock(mutex);
      if (options.progress) options.progress(++done, own);
    };
  };
  Pool(static_cast<unsigned>(threads), source, options.stop).join();
}

}  // namespace server::experiment
