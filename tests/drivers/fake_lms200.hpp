// tests/drivers/fake_lms200.hpp: a minimal LMS200 for the driver's tests.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "tests/drivers/line_bench.hpp"
#include "tests/drivers/lms200_telegrams.hpp"

#include "drivers/lms200_protocol.hpp"
#include "drivers/lms200_scan.hpp"

namespace drivers::lms200 {

class FakeLms200 final : public LineDevice {
 public:
  unsigned baud = 9600;
  std::uint8_t address = 0;
  double boots_until = 0;  // [s] silent until then, then sends its greeting
  bool dead = false;
  bool refuses_variant = false;
  bool wrong_password = false;
  unsigned highest_baud = 500'000;  // a change to a higher rate leads to silence
  std::uint8_t status = 0x10;
  bool damages = false;  // flips a bit of every scan
  Variant variant{180, 100};
  Bytes block = Bytes(34, 0);
  bool streams = false;
  bool partial = false;
  int writes = 0;
  int resets = 0;
  std::uint64_t scans_sent = 0;
  unsigned range_mm = 1234;

  FakeLms200() {
    block[2] = 0x70;
    block[9] = block[10] = 2;
  }

  void restart(double now, double boot) {
    baud = 9600;
    streams = false;
    boots_until = now + boot;
    greeted_ = false;
    out_.clear();
  }
  void hear(double now, ByteView bytes, unsigned at) override {
    if (dead || now < boots_until || at != baud) return;
    host_.feed(bytes);
    for (const Bytes& frame : host_.frames) act(now, telegram_of(ByteView(frame)));
    host_.frames.clear();
  }
  Bytes say(double now, unsigned host_baud) override {
    if (dead || now < boots_until) return {};
    if (!greeted_) {
      greeted_ = true;
      if (boots_until > 0) answer(now, Bytes{0x90}, "LMS200;301063;V02.30 ");
    }
    stream(now);
    Bytes bytes;
    while (!out_.empty() && out_.front().time <= now) {
      append(bytes, out_.front().bytes);
      const std::optional<unsigned> next = out_.front().baud_after;
      const bool heard = baud == host_baud;
      out_.pop_front();
      if (!heard) bytes.clear();
      if (next) baud = *next;
    }
    return bytes;
  }

 private:
  struct Answer {
    double time = 0;
    Bytes bytes{};
    std::optional<unsigned> baud_after{};
  };

  void put(double now, const Bytes& payload, std::optional<unsigned> baud_after = {}) {
    Bytes bytes = framed(static_cast<std::uint8_t>(0x80 + address), payload);
    out_.push_back({now + 0.005 + transfer_time(bytes.size(), baud), std::move(bytes), baud_after});
  }
  void answer(double now, Bytes payload, const std::string& text = "") {
    for (const char c : text) payload.push_back(static_cast<std::uint8_t>(c));
    payload.push_back(status);
    put(now, payload);
  }

  void act(double now, const Telegram& t) {
    if (t.address != 0 && t.address != address) return;
    out_.clear();  // a request interrupts what is being sent
    out_.push_back({now + 0.002, Bytes{kAck}, {}});
    const ByteView data = t.payload.subspan(1);
    switch (t.code()) {
      case 0x10:
        ++resets;
        return;
      case 0x20:
        mode(now, data);
        return;
      case 0x31:
        put_status(now);
        return;
      case 0x3A:
        answer(now, Bytes{0xBA}, "LMS200;301063;V02.30 ");
        return;
      case 0x3B: {
        if (!refuses_variant) variant = {word_at(data, 0), word_at(data, 2)};
        answer(now,
               Bytes{0xBB,
                     static_cast<std::uint8_t>(refuses_variant ? 0 : 1),
                     static_cast<std::uint8_t>(variant.angle_degrees),
                     0,
                     static_cast<std::uint8_t>(variant.step_centidegrees),
                     0});
        return;
      }
      case 0x74: {
        Bytes payload{0xF4};
        append(payload, block);
        answer(now, payload);
        return;
      }
      case 0x77: {
        ++writes;
        block = bytes_of(data);
        Bytes payload{0xF7, 1};
        append(payload, block);
        answer(now, payload);
        return;
      }
      default:
        answer(now, Bytes{0x92});
    }
  }

  void mode(double now, ByteView data) {
    const std::uint8_t wanted = data[0];
    if (wanted == 0x00 && wrong_password) {
      answer(now, Bytes{0xA0, 1});
      return;
    }
    std::optional<unsigned> after;
    if (wanted == 0x40) after = 38400;
    if (wanted == 0x41) after = 19200;
    if (wanted == 0x42) after = 9600;
    if (wanted == 0x48) after = 500'000;
    if (after && *after > highest_baud) after = 1;  // a rate that no host can use
    if (!after) {
      streams = wanted == 0x24 || wanted == 0x2A;
      partial = wanted == 0x2A;
      next_scan_ = now + 0.02;
    }
    Bytes payload{0xA0, 0, status};
    put(now, payload, after);
  }

  void put_status(double now) {
    Bytes payload(153, 0);
    payload[0] = 0xB1;
    const std::string software = "V02.30 ";
    for (std::size_t i = 0; i < software.size(); ++i) {
      payload[1 + i] = static_cast<std::uint8_t>(software[i]);
    }
    payload[67] = 148;
    payload[102] = block[5];
    payload[107] = static_cast<std::uint8_t>(variant.angle_degrees);
    payload[109] = static_cast<std::uint8_t>(variant.step_centidegrees);
    payload[120] = address;
    payload[122] = block[6];
    answer(now, payload);
  }

  void stream(double now) {
    while (streams && next_scan_ <= now) {
      const unsigned unit = block[6] == 1 ? 0x4000U : 0U;
      Bytes frame;
      if (partial) {
        const auto part = static_cast<unsigned>(scans_sent % 4);
        frame = scan_frame(unit | 0x2000U | (part << 11U) | (part == 0 ? 181U : 180U),
                           std::vector<unsigned>(part == 0 ? 181 : 180, range_mm + part));
      } else {
        frame = scan_frame(static_cast<unsigned>(unit | variant.beams()),
                           std::vector<unsigned>(variant.beams(), range_mm));
      }
      frame[frame.size() - 3] = status;
      const std::uint16_t check = crc(ByteView(frame).first(frame.size() - 2));
      frame[frame.size() - 2] = static_cast<std::uint8_t>(check & 0xFFU);
      frame[frame.size() - 1] = static_cast<std::uint8_t>(check >> 8U);
      if (damages && scans_sent % 4 != 0) frame[20] ^= 0x10U;
      const double turns = partial ? 1 : variant.turns();
      const double needed = transfer_time(frame.size(), baud);
      out_.push_back({next_scan_ + needed, frame, {}});
      ++scans_sent;
      next_scan_ += std::max(turns * kTurnPeriod, needed + 0.01);
    }
  }

  Kept host_{Sender::Host};
  std::deque<Answer> out_{};
  bool greeted_ = false;
  double next_scan_ = 0;
};

}  // namespace drivers::lms200
