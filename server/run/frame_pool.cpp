// server/run/frame_pool.cpp: counts references and grows or shrinks the pool.
#include "server/run/frame_pool.hpp"

#include <algorithm>
#include <utility>

namespace server {

void intrusive_ptr_add_ref(Frame* frame) {
  frame->references_.fetch_add(1, std::memory_order_relaxed);
}

void intrusive_ptr_release(Frame* frame) {
  // The last reader's reads must happen before the pool hands the frame out for writing.
  if (frame->references_.fetch_sub(1, std::memory_order_acq_rel) == 1) {
    const std::shared_ptr<FramePool> pool = std::move(frame->pool_);
    pool->put(frame);
  }
}

bool FrameRoom::take() {
  if (left_.fetch_sub(1, std::memory_order_relaxed) > 0) return true;
  give(1);
  return false;
}

void FrameRoom::give(std::size_t frames) {
  left_.fetch_add(static_cast<std::ptrdiff_t>(frames), std::memory_order_relaxed);
}

FramePool::FramePool(std::size_t own,
                     std::size_t most,
                     std::shared_ptr<FrameRoom> room,
                     MakeOne factory)
    : own_(own), most_(most), room_(std::move(room)), make_one_(factory), free_(most) {}

FramePool::~FramePool() {
  if (room_ && frames_.size() > own_) room_->give(frames_.size() - own_);
}

/// Counts first: another thread may take the frame at once, and the count must not fall below zero.
void FramePool::put(Frame* frame) {
  free_count_.fetch_add(1, std::memory_order_relaxed);
  free_.bounded_push(frame);
}

void FramePool::add() {
  frames_.push_back(make_one_());
  put(frames_.back().get());
}

bool FramePool::grow() {
  if (!room_ || frames_.size() >= most_) return false;
  if (frames_.size() >= own_ && !room_->take()) return false;
  add();
  return true;
}

void FramePool::drop(std::size_t frames) {
  Frame* frame = nullptr;
  for (; frames > 0 && free_.pop(frame); --frames) {
    free_count_.fetch_sub(1, std::memory_order_relaxed);
    if (frames_.size() > own_) room_->give(1);
    std::erase_if(frames_, [frame](const auto& one) { return one.get() == frame; });
  }
}

FrameRef FramePool::take() {
  if (room_ && ++taken_ >= kLook) {
    drop(spare_);
    taken_ = 0;
    spare_ = most_;
  }
  Frame* frame = nullptr;
  if (!free_.pop(frame) && !(grow() && free_.pop(frame))) return {};
  const std::size_t left = free_count_.fetch_sub(1, std::memory_order_relaxed) - 1;
  spare_ = std::min(spare_, left);
  frame->pool_ = shared_from_this();
  frame->renew();
  return FrameRef(frame);
}

}  // namespace server
