// drivers/emulators/line.cpp: byte times, faults, and reception at a wrong rate.
#include "drivers/emulators/line.hpp"

#include <cmath>

namespace drivers::emulators {
namespace {

constexpr std::size_t kBits = 10;  // per byte on the line

/// The line's level while `bytes` are sent; `bit` counts from the first start bit. Low for a start
/// bit, high for a stop bit and after the last byte.
bool level(ByteView bytes, std::size_t bit) {
  const std::size_t byte = bit / kBits;
  if (byte >= bytes.size()) return true;
  const std::size_t place = bit % kBits;
  if (place == 0) return false;
  if (place == kBits - 1) return true;
  return ((bytes[byte] >> (place - 1)) & 1U) != 0;
}

}  // namespace

bool Line::happens(double probability) {
  if (!(probability > 0)) return false;
  const double draw = static_cast<double>(random_() >> 11U) * 0x1p-53;
  return draw < probability;
}

/// Puts a damaged copy of `bytes` into spoiled_; false when they stay intact.
bool Line::spoil(ByteView bytes) {
  spoiled_.clear();
  std::size_t victim = bytes.size();
  if (!bytes.empty() && happens(faults.damage)) victim = random_() % bytes.size();
  const bool victim_lost = victim < bytes.size() && happens(0.5);
  bool damaged = false;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const bool lost = happens(faults.drop) || (i == victim && victim_lost);
    const bool flipped = happens(faults.flip) || (i == victim && !victim_lost);
    damaged = damaged || lost || flipped;
    if (lost) continue;
    const std::uint64_t bit = flipped ? std::uint64_t{1} << (random_() % 8) : 0;
    spoiled_.push_back(static_cast<std::uint8_t>(bytes[i] ^ bit));
  }
  return damaged;
}

void Line::hear(ByteView bytes, double now) {
  spoil(bytes);
  heard_until_ = std::max(heard_until_, now);
  for (const std::uint8_t byte : spoiled_) {
    heard_until_ += byte_time();
    incoming_.push_back({.time = heard_until_, .baud = baud_, .value = byte});
  }
}

Sending Line::say(ByteView telegram, double earliest) {
  const bool damaged = spoil(telegram);
  const double begin = std::max(earliest, free_at_);
  free_at_ = begin;
  for (const std::uint8_t byte : spoiled_) {
    free_at_ += byte_time();
    outgoing_.push_back({.time = free_at_, .baud = baud_, .value = byte});
  }
  return {.begin = begin, .end = free_at_, .intact = !damaged};
}

bool Line::cut(double now) {
  const auto kept = std::ranges::find_if(outgoing_, [&](const Timed& b) { return b.time > now; });
  const bool something = kept != outgoing_.end();
  outgoing_.erase(kept, outgoing_.end());
  free_at_ = std::min(free_at_, now);
  return something;
}

unsigned Line::leave(double now, std::vector<std::uint8_t>& out) {
  if (outgoing_.empty() || outgoing_.front().time > now) return baud_;
  const unsigned rate = outgoing_.front().baud;
  while (!outgoing_.empty() && outgoing_.front().time <= now && outgoing_.front().baud == rate) {
    out.push_back(outgoing_.front().value);
    outgoing_.pop_front();
  }
  return rate;
}

std::vector<std::uint8_t> misread(ByteView bytes, unsigned from, unsigned to) {
  std::vector<std::uint8_t> read;
  const double ratio = static_cast<double>(from) / static_cast<double>(to);  // bits sent per read
  const auto at = [&](double time) { return level(bytes, static_cast<std::size_t>(time)); };
  const auto end = static_cast<double>(bytes.size() * kBits);
  double time = 0;  // [bits sent]
  const auto wait_for = [&](bool wanted) {
    while (time < end && at(time) != wanted) time = std::floor(time) + 1;
  };
  for (wait_for(false); time < end; wait_for(false)) {
    unsigned value = 0;
    for (unsigned bit = 0; bit < 8; ++bit) {
      if (at(time + (1.5 + bit) * ratio)) value |= 1U << bit;
    }
    time += 9.5 * ratio;
    const bool framed = at(time);
    read.push_back(framed ? static_cast<std::uint8_t>(value) : std::uint8_t{0});
    if (!framed) wait_for(true);
  }
  return read;
}

}  // namespace drivers::emulators
