// server/run/frame_pool.hpp: the frames of a run, used again and again, as many as those who listen
// hold at once.
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

/// Frames that many pools may have between them beyond those each has of its own. Any thread.
class FrameRoom {
 public:
  explicit FrameRoom(std::size_t frames) : left_(static_cast<std::ptrdiff_t>(frames)) {}
  bool take();
  void give(std::size_t frames);

 private:
  std::atomic<std::ptrdiff_t> left_;
};

/// take() belongs to one thread, the run's; frames come back from any.
class FramePool : public std::enable_shared_from_this<FramePool> {
 public:
  /// So many frames of one kind, made at once: take() allocates nothing.
  template <typename Kind = Frame>
  static std::shared_ptr<FramePool> make(std::size_t frames) {
    const std::shared_ptr<FramePool> pool(new FramePool(frames, frames, nullptr, &make_one<Kind>));
    while (pool->frames_.size() < frames) pool->add();
    return pool;
  }
  /// Frames are made when they are needed: up to `own`, and up to `most` while `room` has some
  /// left. Those that nobody has needed for a while go.
  template <typename Kind>
  static std::shared_ptr<FramePool> growing(std::size_t own,
                                            std::size_t most,
                                            std::shared_ptr<FrameRoom> room) {
    return std::shared_ptr<FramePool>(new FramePool(own, most, std::move(room), &make_one<Kind>));
  }
  ~FramePool();
  FramePool(const FramePool&) = delete;
  FramePool& operator=(const FramePool&) = delete;

  /// Null when no frame can be had just now. The frame keeps its old content.
  FrameRef take();
  /// How many there are. The run's thread.
  std::size_t size() const { return frames_.size(); }

 private:
  using MakeOne = std::unique_ptr<Frame> (*)();
  static constexpr std::size_t kLook = 256;  // frames taken between two looks at what is spare

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
  std::shared_ptr<FrameRoom> room_{};  // null: it does not grow
  MakeOne make_one_;
  std::vector<std::unique_ptr<Frame>> frames_{};
  boost::lockfree::stack<Frame*> free_;
  std::atomic<std::size_t> free_count_{0};
  std::size_t spare_ = 0;  // the least that were free since the last look
  std::size_t taken_ = 0;  // since then
};

}  // namespace server
