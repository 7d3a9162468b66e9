// drivers/lms200_telegram.hpp: the frame around everything an LMS2xx says or is told.
//
//   02  ADDRESS  LENGTH(2)  CODE  DATA...  [STATUS]  CRC(2)        words low byte first
//
// LENGTH counts from CODE to STATUS, which answers alone have. Source: SICK, Telegrams for
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

/// Check value over a frame from its start mark to its last byte before the CRC. None of the usual
/// CRC-16: each step takes in two bytes of the data.
std::uint16_t crc(ByteView bytes);

/// An answer, or a request as the device sees it. Views into the reader's buffer.
struct Telegram {
  std::uint8_t address = 0;  // as on the wire
  ByteView payload{};        // LENGTH bytes, never empty

  std::uint8_t code() const { return payload[0]; }
  /// Of an answer: what is between code and status.
  ByteView data() const { return payload.subspan(1, payload.size() - 2); }
  std::uint8_t status() const { return payload.back(); }
};

/// The parts of a frame found intact.
Telegram telegram_of(ByteView frame);

enum class Sender : std::uint8_t { Device, Host };

/// What FrameReader needs to know. Answers from any address >= 0x80 count, as a device that was
/// given address 1 answers from 0x81 even when everybody was asked.
struct Framing {
  static constexpr std::size_t kLongest = kLongestLength + kFrameBytes;
  Sender sender = Sender::Device;

  FrameStart start(ByteView bytes) const;
  bool intact(ByteView frame) const;
};

/// Telegrams of the device; stray bytes are where to look for kAck and kNak. A hint only: after a
/// scan that was cut they may lie within its debris, so the answer that follows decides.
using TelegramReader = FrameReader<Framing>;

/// Appends a frame around `payload`, of at most kLongestLength bytes, to `out`: a FixedBytes.
template <class Bytes>
void append_frame(Bytes& out, std::uint8_t address, ByteView payload) {
  const std::size_t begin = out.size();
  out.push_back(kStart);
  out.push_back(address);
  out.append_word(static_cast<std::uint16_t>(payload.size()));
  out.append(payload);
  out.append_word(crc(out.view().subspan(begin)));
}

/// [s] What `bytes` take on a line of `baud`: start bit, eight, stop bit. A scan was complete that
/// much before its last byte arrived.
constexpr double transfer_time(std::size_t bytes, unsigned baud) {
  return static_cast<double>(bytes) * 10.0 / static_cast<double>(baud);
}

}  // namespace drivers::lms200
