// tests/server/record/recorder_fixture.hpp: a recorder with counted frames, and its reports.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/db/store_files.hpp"
#include <gtest/gtest.h>

#include "server/record/recorder.hpp"

namespace test {

/// A frame that counts how many frames are still referenced.
class CountedFrame final : public server::RecordedFrame {
 public:
  CountedFrame(const Frame& frame, std::uint64_t tick, double time, std::atomic<int>& alive)
      : frame_(frame), tick_(tick), time_(time), alive_(alive) {
    ++alive_;
  }
  std::span<const std::byte> bytes() const override { return frame_.bytes; }
  std::span<const db::Window> windows() const override { return frame_.windows; }
  std::uint64_t tick() const override { return tick_; }
  double time() const override { return time_; }
  void release() noexcept override {
    --alive_;
    delete this;
  }

 private:
  ~CountedFrame() = default;
  const Frame& frame_;
  std::uint64_t tick_ = 0;
  double time_ = 0;  // [s]
  std::atomic<int>& alive_;
};

class RecorderFiles : public StoreFiles {
 protected:
  server::FrameHandle handle(std::uint64_t tick) {
    return server::FrameHandle(
        new CountedFrame(made[tick % made.size()], tick, time_of(tick), alive));
  }
  /// Like a simulated run, waits when the ring is full.
  void push(server::RunChannel& channel, std::uint64_t tick) {
    server::FrameHandle frame = handle(tick);
    while (!channel.push(frame)) std::this_thread::yield();
  }
  void expect_frames(db::RunId run, std::size_t count) {
    db::RunReader reader(path);
    const auto found = read_frames(reader, run, 0, 1000);
    ASSERT_EQ(found.size(), count);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(found[i], made[i % made.size()].bytes) << i;
  }

  void push(server::RunChannel& channel, std::uint64_t from, std::uint64_t to) {
    for (std::uint64_t tick = from; tick < to; ++tick) push(channel, tick);
  }
  /// Waits until `condition`, for as long as a busy machine may take.
  template <typename Condition>
  static bool comes(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }
  /// Waits until the recorder has reported something with `words` in it.
  bool tells(server::Recorder& recorder, const std::string& words) {
    return comes([&] {
      for (std::string& news : recorder.take_news()) heard.push_back(std::move(news));
      return std::ranges::any_of(
          heard, [&](const std::string& line) { return line.find(words) != std::string::npos; });
    });
  }
  /// The reasons of a run's gaps, in order.
  std::vector<db::GapCause> causes(db::RunId run) {
    db::RunReader reader(path);
    std::vector<db::GapCause> found;
    for (const db::Gap& gap : get(reader, run).gaps) found.push_back(gap.cause);
    return found;
  }

  std::vector<Frame> made = frames(53);
  std::atomic<int> alive = 0;
  std::vector<std::string> heard{};  // by tells()
};

}  // namespace test
