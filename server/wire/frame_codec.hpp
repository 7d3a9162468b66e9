// server/wire/frame_codec.hpp: Telemetry <-> the FlatBuffers frame of web/telemetry.fbs.
#pragma once

#include <flatbuffers/flatbuffers.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "algo/telemetry.hpp"

namespace server {

/// Bytes that are not a frame, with what is wrong.
class WireError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Where uint16 laser samples lie in a frame's bytes: the record codes them as differences.
struct SampleWindow {
  std::uint32_t offset = 0;  // [bytes] from the frame's start
  std::uint32_t count = 0;   // samples
};

/// Keeps its buffers, so that encoding the next frame allocates nothing once they have grown.
class FrameEncoder {
 public:
  /// The frame's bytes, valid until the next call.
  std::span<const std::byte> encode(const algo::Telemetry& t);
  /// Of the last encoded frame, ascending.
  std::span<const SampleWindow> windows() const { return windows_; }

 private:
  flatbuffers::FlatBufferBuilder builder_{2048};
  std::vector<std::uint16_t> samples_{};
  std::vector<SampleWindow> windows_{};
};

/// Reads back what a pipeline needs to repeat a tick (observation, requests) and what it commanded
/// (command, hold, mission, behaviour, truth, clearance, goal). What only people look at (strip,
/// forces, sentences) is read back at the frame's float precision. Throws WireError.
void decode_frame(std::span<const std::byte> bytes, algo::Telemetry& t);

}  // namespace server
