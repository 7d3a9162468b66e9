// drivers/lms200_telegram.hpp: the frame of requests to an LMS2xx and of its answers.
//
//   02  ADDRESS  LENGTH(2)  CODE  DATA...  [STATUS]  CRC(2)        words low byte first
//
// LENGTH counts from CODE to STATUS; only answers have a STATUS. Source: SICK, Telegrams for
// Configuring and Operating the LMS2xx (2006), section 4.
#pragma once

#include <cstddef>
#include <cstdint>

#include "drivers/bytes.hpp"
#include "drivers/frame_reader.hpp"

namespace drivers::lms200 {

constexpr std::uint8_t kStart = 0x02;
constexpr std::uint8_t kAck = 0x06;  // one byte, outside of frames: telegram received
constexpr std::uint8_t kNak = 0x15;  // one byte, outside of frames: telegram received damaged
constexpr std::uint8_t kEverybody = 0;
constexpr std::uint8_t kAnswerAddress = 0x80;  // + the device's own address
constexpr std::size_t kFrameBytes = 6;         // around LENGTH bytes
constexpr std::size_t kLongestLength = 1024;   // the longest answer known has 808

/// Check value over a frame from its start mark to its last byte before the CRC. Not a usual
/// CRC-16: each step takes in two bytes of the data.
std::uint16_t crc(ByteView bytes);

/// An answer, or a request as the device sees it. Views into the reader's buffer.
struct Telegram {
  std::uint8_t address = 0;  // as on the wire
  ByteView payload{};        // LENGTH bytes, never empty

  std::uint8_t code() const { return payload[0]; }
  /// The bytes of an answer between code and status.
  ByteView data() const { return payload.subspan(1, payload.size() - 2); }
  std::uint8_t status() const { return payload.back(); }
};

/// The parts of an intact frame.
Telegram telegram_of(ByteView frame);

enum class Sender : std::uint8_t { Device, Host };

/// The framing for FrameReader. Answers from any address >= 0x80 count: a device with address 1
/// answers from 0x81 even to a broadcast.
struct Framing {
  static constexpr std::size_t kLongest = kLongestLength + kFrameBytes;
  Sender sender = Sender::Device;

  FrameStart start(ByteView bytes) const;
  bool intact(ByteView frame) const;
};

/// Finds the device's telegrams. kAck and kNak come as stray bytes, and only as a hint: bytes of a
/// cut scan may look the same, so the answer that follows decides.
using TelegramReader = FrameReader<Framing>;

/// Appends a frame around `payload`, at most kLongestLength bytes, to `out`, a FixedBytes.
template <class Bytes>
void append_frame(Bytes& out, std::uint8_t address, ByteView payload) {
  const std::size_t begin = out.size();
  out.push_back(kStart);
  out.push_back(address);
  out.append_word(static_cast<std::uint16_t>(payload.size()));
  out.append(payload);
  out.append_word(crc(out.view().subspan(begin)));
}

/// [s] Transfer time of `bytes` at `baud` with 10 bits per byte. A scan was complete that much
/// before its last byte arrived.
constexpr double transfer_time(std::size_t bytes, unsigned baud) {
  return static_cast<double>(bytes) * 10.0 / static_cast<double>(baud);
}

}  // namespace drivers::lms200
