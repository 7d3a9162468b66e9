// server/record/disk_space.hpp: free and total space of a disk.
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

  /// [bytes] the record leaves free for its own log and for other programs.
  std::uint64_t reserve() const { return std::min<std::uint64_t>(total / 8, 64u << 20); }
};

/// The space of the disk that holds `file`. If it cannot be read, it counts as plenty.
inline DiskSpace disk_space(const std::string& file) {
  std::error_code error;
  const auto folder = std::filesystem::weakly_canonical(file, error).parent_path();
  const auto space = std::filesystem::space(folder, error);
  if (error) return {};
  return {.free = space.available, .total = space.capacity};
}

}  // namespace server
