// server/run/frame_pool.hpp: a fixed set of frames, so that the control loop allocates nothing.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include <boost/intrusive_ptr.hpp>
#include <boost/lockfree/stack.hpp>

#include "algo/telemetry.hpp"

namespace server {

class FramePool;

/// One tick. Filled by the control thread, immutable and shared after that; the last reference
/// gives it back to the pool. Who records or shows runs derives a kind of frame that can do more.
class Frame {
 public:
  Frame() = default;
  virtual ~Frame() = default;
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  algo::Telemetry telemetry{};

 protected:
  /// The pool is about to hand it out again, to be filled anew.
  virtual void renew() {}

 private:
  friend class FramePool;
  friend void intrusive_ptr_add_ref(Frame* frame);
  friend void intrusive_ptr_release(Frame* frame);

  std::atomic<int> references_{0};
  std::shared_ptr<FramePool> pool_{};  // while in somebody's hands: the record outlives the run
};
using FrameRef = boost::intrusive_ptr<Frame>;

class FramePool : public std::enable_shared_from_this<FramePool> {
 public:
  /// So many frames of one kind.
  template <typename Kind = Frame>
  static std::shared_ptr<FramePool> make(std::size_t frames) {
    const std::shared_ptr<FramePool> pool(new FramePool(frames));
    for (std::size_t i = 0; i < frames; ++i) pool->add(std::make_unique<Kind>());
    return pool;
  }
  ~FramePool() = default;
  FramePool(const FramePool&) = delete;
  FramePool& operator=(const FramePool&) = delete;

  /// Null when every frame is still in somebody's hands. The frame keeps its old content.
  FrameRef take();

 private:
  friend void intrusive_ptr_release(Frame* frame);
  explicit FramePool(std::size_t frames) : free_(frames) {}
  void add(std::unique_ptr<Frame> frame);

  std::vector<std::unique_ptr<Frame>> frames_{};
  boost::lockfree::stack<Frame*> free_;
};

}  // namespace server
