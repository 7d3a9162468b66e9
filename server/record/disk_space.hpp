// server/record/disk_space.hpp: how much room a disk has.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>

namespace server {

struct DiskSpace {
  std::uint64_t free = UINT64_MAX;  // [bytes] for this user
  std::uint64_t total = 0;          // [bytes]

  /// [bytes] the record leaves free, for its own log and for everybody else.
  std::uint64_t reserve() const { return std::min<std::uint64_t>(total / 8, 64u << 20); }
};

/// Of the disk that holds `file`. What cannot be found out counts as plenty.
inline DiskSpace disk_space(const std::string& file) {
  std::error_code error;
  const auto folder = std::filesystem::weakly_canonical(file, error).parent_path();
  const auto space = std::filesystem::space(folder, error);
  if (error) return {};
  return {.free = space.available, .total = space.capacity};
}

}  // namespace server
