// server/run/frame_pool.cpp: reference counts.
#include "server/run/frame_pool.hpp"

#include <utility>

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

void FramePool::add(std::unique_ptr<Frame> frame) {
  free_.bounded_push(frame.get());
  frames_.push_back(std::move(frame));
}

FrameRef FramePool::take() {
  Frame* frame = nullptr;
  if (!free_.pop(frame)) return {};
  frame->pool_ = shared_from_this();
  frame->renew();
  return FrameRef(frame);
}

}  // namespace server
