// server/record/record_sink.hpp: sends a run's frames to a record channel.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "server/record/encoded_frame.hpp"
#include "server/record/run_channel.hpp"
#include "server/run/runner.hpp"

namespace server {

/// More frames than all rings of a run hold together, so that a ring is full, and reports it,
/// before the pool is empty.
constexpr std::size_t kRecordRing = 512;
constexpr std::size_t kPoolFrames = kRecordRing + 64 + 128;

class RecordSink final : public FrameSink {
 public:
  explicit RecordSink(std::shared_ptr<RunChannel> channel) : channel_(std::move(channel)) {}

  bool push(const FrameRef& frame) override {
    EncodedFrame& recorded = encoded(*frame);
    intrusive_ptr_add_ref(&recorded);
    FrameHandle handle(&recorded);
    return channel_->push(handle);  // a handle that was not taken drops its reference
  }
  void pause() override { channel_->pause(); }
  std::optional<std::string> failure() const override {
    if (!channel_->failed()) return std::nullopt;
    return channel_->problem();
  }

 private:
  std::shared_ptr<RunChannel> channel_;
};

}  // namespace server
