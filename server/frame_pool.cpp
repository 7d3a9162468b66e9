// server/frame_pool.cpp: reference counts and encode-once.
#include "server/frame_pool.hpp"

#include <utility>

#include "server/run_json.hpp"

namespace server {

void intrusive_ptr_add_ref(Frame* frame) {
  frame->references_.fetch_add(1, std::memory_order_relaxed);
}

void intrusive_ptr_release(Frame* frame) {
  // The last reader's reads must happen before the pool hands the frame out for writing.
  if (frame->references_.fetch_sub(1, std::memory_order_acq_rel) == 1) {
    const std::shared_ptr<FramePool> pool = std::move(frame->pool_);
    pool->free_.bounded_push(frame);
  }
}

void Frame::encode_once() const {
  int expected = None;
  if (encoding_.compare_exchange_strong(expected, Running, std::memory_order_acquire)) {
    bytes_ = encoder_.encode(telemetry);
    encoding_.store(Done, std::memory_order_release);
    encoding_.notify_all();
    return;
  }
  while (encoding_.load(std::memory_order_acquire) != Done) encoding_.wait(Running);
}

std::span<const std::byte> Frame::bytes() const {
  encode_once();
  return bytes_;
}

std::span<const db::Window> Frame::windows() const {
  encode_once();
  return encoder_.windows();
}

db::TickRow Frame::row() const {
  return tick_row(telemetry);
}

std::shared_ptr<FramePool> FramePool::make(std::size_t frames) {
  return std::shared_ptr<FramePool>(new FramePool(frames));
}

FramePool::FramePool(std::size_t frames) : frames_(new Frame[frames]), free_(frames) {
  for (std::size_t i = 0; i < frames; ++i) free_.bounded_push(&frames_[i]);
}

FrameRef FramePool::take() {
  Frame* frame = nullptr;
  if (!free_.pop(frame)) return {};
  frame->pool_ = shared_from_this();
  frame->encoding_.store(Frame::None, std::memory_order_relaxed);
  return FrameRef(frame);
}

}  // namespace server
