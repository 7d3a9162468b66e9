// server/record/encoded_frame.hpp: a frame in its wire form, encoded once for all readers.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "server/record/frame_codec.hpp"
#include "server/record/run_channel.hpp"
#include "server/run/frame_pool.hpp"

namespace server {

class EncodedFrame final : public Frame, public RecordedFrame {
 public:
  /// The wire form. The first caller encodes on its own thread. Others wait a few microseconds and
  /// share the result. Never called by the control thread of a live robot.
  std::span<const std::byte> bytes() const override;
  std::span<const db::Window> windows() const override;
  std::uint64_t tick() const override { return telemetry.tick; }
  double time() const override { return telemetry.observation.stamp; }
  void release() noexcept override { intrusive_ptr_release(this); }

 private:
  enum Encoding : int { None, Running, Done };

  void renew() override { encoding_.store(None, std::memory_order_relaxed); }
  void encode_once() const;

  mutable std::atomic<int> encoding_{None};
  mutable FrameEncoder encoder_{};
  mutable std::span<const std::byte> bytes_{};
};

/// The same frame. Throws std::logic_error if its pool makes another kind of frame.
EncodedFrame& encoded(Frame& frame);
inline const EncodedFrame& encoded(const Frame& frame) {
  return encoded(const_cast<Frame&>(frame));
}

}  // namespace server
