// server/lab/soak/drive_hash.hpp: the hash by which two drives are seen to be the same.
#pragma once

#include <bit>
#include <cstdint>

namespace server::soak {

/// Takes `value` into `hash`, bit for bit (FNV-1a over words).
inline void mix(std::uint64_t& hash, double value) {
  hash ^= std::bit_cast<std::uint64_t>(value);
  hash *= 0x100000001b3ULL;
}

}  // namespace server::soak
