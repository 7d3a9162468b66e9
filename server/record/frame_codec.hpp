// server/record/frame_codec.hpp: Telemetry <-> the FlatBuffers frame of web/telemetry.fbs.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include <flatbuffers/flatbuffers.h>

#include "algo/telemetry.hpp"
#include "db/block_codec.hpp"
#include "server/record/layers_writer.hpp"

namespace tautline::wire {
struct LaserScan;
}  // namespace tautline::wire

namespace server {

/// The bytes are not a valid frame; what() says why.
class WireError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Keeps its buffers: once they have grown, encoding a frame allocates nothing.
class FrameEncoder {
 public:
  /// The frame's bytes, valid until the next call.
  std::span<const std::byte> encode(const algo::Telemetry& t);
  /// A single scan as a message whose root is LaserScan; valid until the next call.
  std::span<const std::byte> encode(const algo::LaserScan& scan);
  /// Places of the ranges in the last encoded frame, ascending: the record codes them as
  /// differences.
  std::span<const db::Window> windows() const { return windows_; }

 private:
  void find_windows();

  flatbuffers::FlatBufferBuilder builder_{2048};
  std::vector<flatbuffers::Offset<tautline::wire::LaserScan>> scans_{};
  LayersWriter layers_{};
  std::vector<db::Window> windows_{};
};

/// Reads back the inputs that a pipeline needs to repeat a tick (observation, requests) and its
/// result (command, hold, limit, mission, behaviour). The output's commands come back if
/// `answered`. Fields for viewers only (truth, moved things, clearance, goal, words) come back at
/// the frame's float precision. Layers and measures, also for viewers only, are not read. Throws
/// WireError.
void decode_frame(std::span<const std::byte> bytes, algo::Telemetry& t);

}  // namespace server
