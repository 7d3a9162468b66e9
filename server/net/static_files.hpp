// server/net/static_files.hpp: the page's files, and nothing outside their folder.
#pragma once

#include <filesystem>
#include <string>

#include "server/net/http.hpp"

namespace server::net {

/// The file for `request.path` below `root`; 404 for what is not there, lies outside, or is a
/// folder; 304 when the client has it. "/" is index.html.
Response serve_file(const std::filesystem::path& root, const Request& request);

}  // namespace server::net
