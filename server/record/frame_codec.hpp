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
  /// A scan on its own, as a message whose root is LaserScan; valid until the next call.
  std::span<const std::byte> encode(const algo::LaserScan& scan);
  /// Where the last encoded frame holds ranges, ascending: the record codes them as differences.
  std::span<const db::Window> windows() const { return windows_; }

 private:
  void find_windows();

  flatbuffers::FlatBufferBuilder builder_{2048};
  std::vector<flatbuffers::Offset<tautline::wire::LaserScan>> scans_{};
  LayersWriter layers_{};
  std::vector<db::Window> windows_{};
};

/// Reads back what a pipeline needs to repeat a tick (observation, requests) and what it commanded
/// (command, hold, limit, mission, behaviour). What only people look at (truth, what moved,
/// clearance, goal, words) is read back at the frame's float precision; layers and measures, which
/// only they read, not at all. Throws WireError.
void decode_frame(std::span<const std::byte> bytes, algo::Telemetry& t);

}  // namespace server
