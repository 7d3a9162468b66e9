// server/record/frame_codec.hpp: Telemetry <-> the FlatBuffers frame of web/telemetry.fbs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include <flatbuffers/flatbuffers.h>

#include "algo/telemetry.hpp"
#include "db/block_codec.hpp"

namespace tautline::wire {
struct LaserScan;
}

namespace server {

/// Bytes that are not a frame, with what is wrong.
class WireError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Keeps its buffers, so that encoding the next frame allocates nothing once they have grown.
class FrameEncoder {
 public:
  /// The frame's bytes, valid until the next call.
  std::span<const std::byte> encode(const algo::Telemetry& t);
  /// Where the last encoded frame holds ranges and strip nodes, ascending: the record codes them as
  /// differences.
  std::span<const db::Window> windows() const { return windows_; }

 private:
  void find_windows();

  flatbuffers::FlatBufferBuilder builder_{2048};
  std::vector<flatbuffers::Offset<tautline::wire::LaserScan>> scans_{};
  std::vector<db::Window> windows_{};
};

/// Reads back what a pipeline needs to repeat a tick (observation, requests) and what it commanded
/// (command, hold, mission, behaviour). What only people look at (truth, clearance, goal, strip,
/// forces) is read back at the frame's float precision. Throws WireError.
void decode_frame(std::span<const std::byte> bytes, algo::Telemetry& t);

}  // namespace server
