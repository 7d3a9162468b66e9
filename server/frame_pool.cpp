// server/frame_pool.cpp: reference counts and encode-once.
#include "server/frame_pool.hpp"

namespace server {

void intrusive_ptr_add_ref(Frame* frame) {
  frame->references_.fetch_add(1, std::memory_order_relaxed);
}

void intrusive_ptr_release(Frame* frame) {
  // The last reader's reads must happen before the pool hands the frame out for writing.
  if (frame->references_.fetch_sub(1, std::memory_order_acq_rel) == 1) {
    frame->pool_->free_.bounded_push(frame);
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

std::span<const SampleWindow> Frame::windows() const {
  encode_once();
  return encoder_.windows();
}

FramePool::FramePool(std::size_t frames) : frames_(new Frame[frames]), free_(frames) {
  for (std::size_t i = 0; i < frames; ++i) {
    frames_[i].pool_ = this;
    free_.bounded_push(&frames_[i]);
  }
}

FrameRef FramePool::take() {
  Frame* frame = nullptr;
  if (!free_.pop(frame)) return {};
  frame->encoding_.store(Frame::None, std::memory_order_relaxed);
  return FrameRef(frame);
}

}  // namespace server
