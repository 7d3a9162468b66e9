// server/serve/net/static_files.hpp: serves the built page from its folder, and nothing else from
// the disk.
#pragma once

#include <filesystem>
#include <string_view>

#include "server/serve/net/http.hpp"

namespace server::net {

class StaticFiles {
 public:
  /// `root` may be empty: then every path answers 404 and says that no page is served.
  explicit StaticFiles(std::filesystem::path root);

  /// The file at request.path, with "/" as index.html, in the best coding that the client accepts
  /// and the build has put beside it (NAME.br, NAME.gz). A file named by its content may be kept
  /// for ever; every other one must be asked for again. 304 if If-None-Match names its tag. 404 for
  /// missing files, folders, hidden files and every path that would leave the root by "..",
  /// backslash or symbolic link. 405 for methods other than GET and HEAD.
  Response get(const Request& request) const;

 private:
  std::filesystem::path root_;  // canonical, or empty
};

/// Content type by file name extension; application/octet-stream if unknown.
std::string_view mime_type(std::string_view extension);

}  // namespace server::net
