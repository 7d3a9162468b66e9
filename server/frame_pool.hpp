// server/frame_pool.hpp: a fixed set of frames, so that the control loop allocates nothing.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <boost/intrusive_ptr.hpp>
#include <boost/lockfree/stack.hpp>

#include "algo/telemetry.hpp"
#include "server/recorder.hpp"
#include "server/wire/frame_codec.hpp"

namespace server {

class FramePool;

/// One tick and, once somebody asked, its encoded bytes. Filled by the control thread, immutable
/// and shared after that; the last reference gives it back to the pool.
class Frame final : public RecordedFrame {
 public:
  algo::Telemetry telemetry{};

  /// The wire form. The first caller encodes, on its own thread; others wait the few microseconds
  /// and share the result. Never called by the control thread of a live robot.
  std::span<const std::byte> bytes() const override;
  std::span<const db::Window> windows() const override;
  db::TickRow row() const override;
  void release() noexcept override { intrusive_ptr_release(this); }

 private:
  friend class FramePool;
  friend void intrusive_ptr_add_ref(Frame* frame);
  friend void intrusive_ptr_release(Frame* frame);
  enum Encoding : int { None, Running, Done };

  void encode_once() const;

  mutable std::atomic<int> encoding_{None};
  mutable FrameEncoder encoder_{};
  mutable std::span<const std::byte> bytes_{};
  std::atomic<int> references_{0};
  std::shared_ptr<FramePool> pool_{};  // while in somebody's hands: the record outlives the run
};
using FrameRef = boost::intrusive_ptr<Frame>;

class FramePool : public std::enable_shared_from_this<FramePool> {
 public:
  static std::shared_ptr<FramePool> make(std::size_t frames);
  ~FramePool() = default;
  FramePool(const FramePool&) = delete;
  FramePool& operator=(const FramePool&) = delete;

  /// Null when every frame is still in somebody's hands. The frame keeps its old content.
  FrameRef take();

 private:
  friend void intrusive_ptr_release(Frame* frame);
  explicit FramePool(std::size_t frames);

  std::unique_ptr<Frame[]> frames_;
  boost::lockfree::stack<Frame*> free_;
};

}  // namespace server
