// tests/server/record/recorder_test.cpp: frames go from control threads to the disk, despite
// failures.
#include "server/record/recorder.hpp"

#include "tests/server/record/recorder_fixture.hpp"
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using db::RunReader;
using db::RunStatus;
using server::FrameHandle;
using server::Recorder;
using server::RecorderOptions;
using test::refusal;
using testing::ElementsAre;
using testing::HasSubstr;

class RecorderTest : public test::RecorderFiles {};

TEST_F(RecorderTest, TwoConcurrentRunsLoseNoFrames) {
  Recorder recorder(path);
  constexpr std::size_t kTicks = 4000;  // several times the ring
  std::array<db::RunId, 2> runs{};
  std::array<std::thread, 2> producers;
  for (std::size_t k = 0; k < 2; ++k) {
    producers[k] = std::thread([&, k] {
      const auto channel = recorder.open(what("case" + std::to_string(k + 1)));
      runs[k] = channel->run();
      for (std::uint64_t tick = 0; tick < kTicks; ++tick) push(*channel, tick);
      channel->close({.outcome = "reached", .lost_ticks = k});
    });
  }
  for (auto& producer : producers) producer.join();
  recorder.flush();
  EXPECT_EQ(alive, 0);
  RunReader reader(path);
  for (std::size_t k = 0; k < 2; ++k) {
    expect_frames(runs[k], kTicks);
    const db::RunRow run = get(reader, runs[k]);
    EXPECT_EQ(run.status, RunStatus::Finished);
    EXPECT_EQ(run.what.scenario, "case" + std::to_string(k + 1));
    EXPECT_EQ(run.ticks, kTicks);
    EXPECT_EQ(run.lost_ticks, k);
  }
}

TEST_F(RecorderTest, CommitsAboutOnceASecondByItself) {
  Recorder recorder(path, {.commit_interval = std::chrono::milliseconds(100)});
  const auto channel = recorder.open(what());
  RunReader reader(path);
  EXPECT_EQ(get(reader, channel->run()).status, RunStatus::Recording);
  push(*channel, 0);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (get(reader, channel->run()).ticks == 0 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(get(reader, channel->run()).ticks, 1U);
}

TEST_F(RecorderTest, AFullRingLeavesTheFrameWithTheProducer) {
  Recorder recorder(path, {.ring_frames = 8});
  const auto channel = recorder.open(what());
  // The database thread is kept busy, so the ring is not emptied.
  std::promise<void> go;
  recorder.post([&](db::RunStore&) { go.get_future().wait(); });
  std::uint64_t tick = 0;
  FrameHandle frame = handle(tick);
  while (channel->push(frame)) frame = handle(++tick);
  EXPECT_TRUE(frame);  // still the producer's
  EXPECT_GE(tick, 8U);
  EXPECT_FALSE(channel->failed());
  go.set_value();
  while (!channel->push(frame)) std::this_thread::yield();
  recorder.flush();
  expect_frames(channel->run(), tick + 1);
  EXPECT_EQ(alive, 0);
}

TEST_F(RecorderTest, QueuedRunsAreRecordedInOrder) {
  Recorder recorder(path);
  const db::RunId run = recorder.ask([&](db::RunStore& store) { return store.queue_run(what()); });
  RunReader reader(path);
  EXPECT_EQ(get(reader, run).status, RunStatus::Queued);
  const auto channel = recorder.open(run, what());
  EXPECT_EQ(channel->run(), run);
  EXPECT_EQ(get(reader, run).status, RunStatus::Recording);
  push(*channel, 0);
  channel->close({.outcome = "stuck"});
  recorder.flush();
  EXPECT_EQ(get(reader, run).outcome, "stuck");
  EXPECT_THAT(refusal([&] { recorder.open(run, what()); }), HasSubstr("not waiting"));
}

TEST_F(RecorderTest, ARunWhoseThreadDiedIsMarkedFailed) {
  Recorder recorder(path);
  auto channel = recorder.open(what());
  const db::RunId run = channel->run();
  push(*channel, 0);
  channel.reset();
  recorder.flush();
  RunReader reader(path);
  EXPECT_EQ(get(reader, run).status, RunStatus::Failed);
  EXPECT_THAT(get(reader, run).reason, HasSubstr("broke off"));
  expect_frames(run, 1);
}

TEST_F(RecorderTest, StoppingEndsOpenRunsAsInterrupted) {
  std::shared_ptr<server::RunChannel> open;
  db::RunId closed = 0;
  {
    Recorder recorder(path);
    open = recorder.open(what());
    const auto other = recorder.open(what());
    closed = other->run();
    for (std::uint64_t tick = 0; tick < 100; ++tick) {
      push(*open, tick);
      push(*other, tick);
    }
    other->close({.outcome = "reached"});
  }
  EXPECT_TRUE(open->failed());
  EXPECT_THAT(open->problem(), HasSubstr("server was stopped"));
  push(*open, 100);  // dropped, not leaked
  EXPECT_EQ(alive, 0);
  RunReader reader(path);
  EXPECT_EQ(get(reader, open->run()).status, RunStatus::Interrupted);
  EXPECT_EQ(get(reader, closed).status, RunStatus::Finished);
  expect_frames(open->run(), 100);
  expect_frames(closed, 100);
  const db::RunStore store(path);
  EXPECT_TRUE(store.interrupted().empty());
}

TEST_F(RecorderTest, AFrameThatCannotBeStoredEndsItsOwnRunOnly) {
  Recorder recorder(path);
  const auto bad = recorder.open(what());
  const auto good = recorder.open(what());
  push(*bad, 5);
  push(*bad, 5);  // the same tick again
  push(*good, 0);
  recorder.flush();
  EXPECT_TRUE(bad->failed());
  EXPECT_THAT(bad->problem(), HasSubstr("does not follow"));
  EXPECT_FALSE(good->failed());
  good->close({.outcome = "reached"});
  bad->close({.outcome = "reached"});
  recorder.flush();
  RunReader reader(path);
  EXPECT_EQ(get(reader, good->run()).status, RunStatus::Finished);
  EXPECT_NE(get(reader, bad->run()).status, RunStatus::Finished);
}

/// Memory shared by child and parent; it survives the kill.
struct Shared {
  std::atomic<std::uint64_t> pushed = 0;
  std::atomic<double> latest = 0;  // [s] by which the machine woke a sleeping thread too late
};

[[noreturn]] void sleep_and_measure(Shared& shared) {
  for (;;) {
    const auto due = std::chrono::steady_clock::now() + std::chrono::milliseconds(20);
    std::this_thread::sleep_until(due);
    const std::chrono::duration<double> late = std::chrono::steady_clock::now() - due;
    shared.latest = std::max(shared.latest.load(), late.count());
  }
}

// The child records at the rate of a real run and writes its progress to shared memory; then it is
// killed. A run may lose 1.1 s plus the time that an overloaded machine runs no thread.
TEST_F(RecorderTest, AKillLosesAtMostElevenTenthsOfASecond) {
  constexpr double kPeriod = 0.026;
  void* memory =
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  for (const int wait_ms : {350, 1230, 1900}) {
    auto& shared = *new (memory) Shared;
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      Recorder recorder(path);
      const auto channel = recorder.open(what());
      std::thread([&] { sleep_and_measure(shared); }).detach();
      auto due = std::chrono::steady_clock::now();
      for (std::uint64_t tick = 0;; ++tick) {
        push(*channel, tick);
        shared.pushed = tick + 1;
        due += std::chrono::microseconds(26'000);
        std::this_thread::sleep_until(due);
      }
    }
    while (shared.pushed == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const db::RunStore store(path);
    ASSERT_EQ(store.interrupted().size(), 1U);
    RunReader reader(path);
    const db::RunRow run = get(reader, store.interrupted()[0]);
    EXPECT_EQ(run.status, RunStatus::Interrupted);
    ASSERT_LE(run.ticks, shared.pushed + 1);  // it may die between the push and the count
    const double pushed = static_cast<double>(shared.pushed);
    const double lost = (pushed - static_cast<double>(run.ticks)) * kPeriod;
    EXPECT_LE(lost, 1.1 + shared.latest);
    EXPECT_LT(lost, 3.0) << "nothing was committed in time";
    expect_frames(run.id, run.ticks);
    EXPECT_EQ(integrity(path), "ok");
  }
  munmap(memory, sizeof(Shared));
}

}  // namespace
