// tests/server/record/encoded_frame_test.cpp: one encoding shared by all readers.
#include "server/record/encoded_frame.hpp"

#include <cstdint>
#include <span>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace server {
namespace {

TEST(EncodedFrame, TwoThreadsGetTheSameBytes) {
  const auto pool = FramePool::make<EncodedFrame>(1);
  for (int round = 0; round < 200; ++round) {
    const FrameRef frame = pool->take();
    frame->telemetry.tick = static_cast<std::uint64_t>(round);
    std::span<const std::byte> other;
    std::jthread thread([&] { other = encoded(*frame).bytes(); });
    const auto mine = encoded(*frame).bytes();
    thread.join();
    EXPECT_EQ(mine.data(), other.data());
    algo::Telemetry back;
    decode_frame(mine, back);
    EXPECT_EQ(back.tick, static_cast<std::uint64_t>(round));
  }
}

TEST(EncodedFrame, OfAnotherPoolIsRefused) {
  const FrameRef frame = FramePool::make(1)->take();
  EXPECT_THROW(encoded(*frame), std::logic_error);
}

}  // namespace
}  // namespace server
