// server/external/messages.hpp: writes the messages to a controller and reads its answers
// (controller.fbs).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <flatbuffers/flatbuffers.h>

#include "server/external/peer.hpp"
#include "server/external/texts.hpp"

namespace server::external {

constexpr std::uint32_t kProtocol = 1;  // version
constexpr std::size_t kPrefix = 4;      // bytes of a message's length, which begins it
constexpr std::size_t kMostBytes = std::size_t{1} << 20U;  // of a message from a controller
constexpr std::size_t kMostLayers = 32;
constexpr std::size_t kMostMeasures = 64;
constexpr std::size_t kMostValues = 65532;   // of a layer
constexpr std::size_t kMostCells = 262'144;  // of a grid
constexpr std::size_t kMostLetters = 500;    // of a sentence

/// Messages with their prefix, valid until the next call. Keeps its buffer: once it has grown, a
/// question allocates nothing.
class MessageWriter {
 public:
  using Bytes = std::span<const std::byte>;
  Bytes welcome(std::string_view controller);
  Bytes begin(const Begin& run);
  Bytes question(const Question& question, algo::ParameterList parameters);
  Bytes end(std::string_view reason);

 private:
  flatbuffers::FlatBufferBuilder builder_{8192};
  std::vector<double> values_{};  // of the parameters
};

struct Hello {
  std::uint32_t version = 0;
  std::string token{};
};
/// `message` with its prefix. Throws ControllerError for any bytes that are no Hello.
Hello read_hello(std::span<const std::byte> message);

/// Reads a Command with its prefix, the answer to the tick `tick`, into `out` and `words`, which
/// are cleared on entry. Throws ControllerError for any bytes that are not such an answer; the
/// sentences begin with "It".
void read_answer(std::span<const std::byte> message,
                 std::uint64_t tick,
                 Texts& texts,
                 algo::ControlOutput& out,
                 algo::Explanation& words);

/// Throws ControllerError if base or joints are not commanded by finite numbers.
void check_speeds(const algo::ControlOutput& out);

}  // namespace server::external
