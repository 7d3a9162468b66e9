// db/network_disk.cpp: asks the system for the number of the file system.
#include "db/network_disk.hpp"

#include <filesystem>

#include <sys/vfs.h>

namespace db {

std::optional<std::string_view> network_file_system(unsigned long magic) {
  switch (magic & 0xFFFFFFFF) {  // some systems give the 32 bits with their sign
    case 0x6969:
      return "NFS";
    case 0x517B:
    case 0xFE534D42:
    case 0xFF534D42:
      return "SMB";
    default:
      return std::nullopt;
  }
}

std::optional<std::string> refusal_on_network(const std::string& path) {
  struct statfs found {};
  const std::string folder = std::filesystem::absolute(path).parent_path().string();
  if (::statfs(path.c_str(), &found) != 0 && ::statfs(folder.c_str(), &found) != 0) return {};
  const auto name = network_file_system(static_cast<unsigned long>(found.f_type));
  if (!name) return {};
  return path + ": lies on " + std::string(*name) +
         ", where another machine could write at the same time; choose a folder on a disk of this "
         "machine.";
}

}  // namespace db
