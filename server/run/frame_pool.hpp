// server/run/frame_pool.hpp: recycles the frames of a run. There are as many as all listeners hold
// at once.
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

/// One tick. The control thread fills it; afterwards it is shared and immutable. Dropping the last
/// reference returns it to the pool. A recorder or viewer derives a frame type that can do more.
class Frame {
 public:
  Frame() = default;
  virtual ~Frame() = default;
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  algo::Telemetry telemetry{};

 protected:
  /// Called before the pool hands the frame out again to be refilled.
  virtual void renew() {}

 private:
  friend class FramePool;
  friend void intrusive_ptr_add_ref(Frame* frame);
  friend void intrusive_ptr_release(Frame* frame);

  std::atomic<int> references_{0};
  std::shared_ptr<FramePool> pool_{};  // set while the frame is in use: the record outlives the run
};
using FrameRef = boost::intrusive_ptr<Frame>;

/// The number of frames that several pools may share beyond each pool's own. Any thread.
class FrameRoom {
 public:
  explicit FrameRoom(std::size_t frames) : left_(static_cast<std::ptrdiff_t>(frames)) {}
  bool take();
  void give(std::size_t frames);

 private:
  std::atomic<std::ptrdiff_t> left_;
};

/// Only the run's thread may call take(). Any thread may return a frame.
class FramePool : public std::enable_shared_from_this<FramePool> {
 public:
  /// Makes all `frames` at once, so that take() allocates nothing.
  template <typename Kind = Frame>
  static std::shared_ptr<FramePool> make(std::size_t frames) {
    std::shared_ptr<FramePool> pool(new FramePool(frames, frames, nullptr, &make_one<Kind>));
    while (pool->frames_.size() < frames) pool->add();
    return pool;
  }
  /// Makes frames on demand: up to `own`, and up to `most` while `room` has some left. Frees frames
  /// that have been spare for a while.
  template <typename Kind>
  static std::shared_ptr<FramePool> growing(std::size_t own,
                                            std::size_t most,
                                            std::shared_ptr<FrameRoom> room) {
    return std::shared_ptr<FramePool>(new FramePool(own, most, std::move(room), &make_one<Kind>));
  }
  ~FramePool();
  FramePool(const FramePool&) = delete;
  FramePool& operator=(const FramePool&) = delete;

  /// Null when no frame is available now. The frame keeps its old content.
  FrameRef take();
  /// The number of frames in the pool. Call it on the run's thread.
  std::size_t size() const { return frames_.size(); }

 private:
  using MakeOne = std::unique_ptr<Frame> (*)();
  static constexpr std::size_t kLook = 256;  // frames taken between two checks for spare frames

  friend void intrusive_ptr_release(Frame* frame);
  FramePool(std::size_t own, std::size_t most, std::shared_ptr<FrameRoom> room, MakeOne factory);
  template <typename Kind>
  static std::unique_ptr<Frame> make_one() {
    return std::make_unique<Kind>();
  }
  void add();
  bool grow();
  void drop(std::size_t frames);
  void put(Frame* frame);

  const std::size_t own_;
  const std::size_t most_;
  std::shared_ptr<FrameRoom> room_{};  // null: the pool does not grow
  MakeOne make_one_;
  std::vector<std::unique_ptr<Frame>> frames_{};
  boost::lockfree::stack<Frame*> free_;
  std::atomic<std::size_t> free_count_{0};
  std::size_t spare_ = 0;  // least number of free frames since the last check
  std::size_t taken_ = 0;  // frames taken since the last check
};

}  // namespace server
