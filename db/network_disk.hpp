// db/network_disk.hpp: tells network file systems, where one writer's lock may not hold others off.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace db {

/// Name of the network file system with this number in statfs(2); nothing for any other.
std::optional<std::string_view> network_file_system(unsigned long magic);

/// A sentence that refuses to write `path` if it lies on a network file system; else nothing. The
/// file may be missing, its folder decides then.
std::optional<std::string> refusal_on_network(const std::string& path);

}  // namespace db
