// server/record/record_sink.hpp: a record channel as the place where a run's frames go.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "server/record/encoded_frame.hpp"
#include "server/record/run_channel.hpp"
#include "server/run/runner.hpp"

namespace server {

/// More frames than all rings of a run can hold between them, so that the pool cannot run dry
/// before a ring is full and says so.
constexpr std::size_t kRecordRing = 512;
constexpr std::size_t kPoolFrames = kRecordRing + 64 + 128;

class RecordSink final : public FrameSink {
 public:
  explicit RecordSink(std::shared_ptr<RunChannel> channel) : channel_(std::move(channel)) {}

  bool push(const FrameRef& frame) override {
    EncodedFrame& recorded = encoded(*frame);
    intrusive_ptr_add_ref(&recorded);
    FrameHandle handle(&recorded);
    return channel_->push(handle);  // a handle that was not taken gives its reference back
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
