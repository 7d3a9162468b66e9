// server/serve/net/static_files.cpp: checks the path first; then the resolved file must lie inside
// the root.
#include "server/serve/net/static_files.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <sys/stat.h>

namespace server::net {
namespace {

namespace fs = std::filesystem;

bool safe_path(std::string_view path) {
  if (path.find('\\') != std::string_view::npos || path.find('\0') != std::string_view::npos) {
    return false;
  }
  // No segment may start with a dot: covers "..", "." and hidden files.
  for (std::size_t slash = path.find('/'); slash != std::string_view::npos;
       slash = path.find('/', slash + 1)) {
    if (slash + 1 < path.size() && path[slash + 1] == '.') return false;
  }
  return true;
}

/// The existing regular file for `path`, with links resolved, if it lies inside `root`.
std::optional<fs::path> resolve(const fs::path& root, std::string_view path) {
  std::error_code error;
  const fs::path file = fs::canonical(root / fs::path(path.substr(1)), error);
  if (error || !fs::is_regular_file(file, error)) return std::nullopt;
  const auto [end, unused] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
  if (end != root.end()) return std::nullopt;
  return file;
}

/// Changes whenever the file is rewritten: size and modification time in nanoseconds.
std::optional<std::string> entity_tag(const fs::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) return std::nullopt;
  return '"' + std::to_string(info.st_size) + '-' + std::to_string(info.st_mtim.tv_sec) + '.' +
         std::to_string(info.st_mtim.tv_nsec) + '"';
}

}  // namespace

std::string_view mime_type(std::string_view extension) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kTypes{
      {{".html", "text/html; charset=utf-8"},
       {".js", "text/javascript; charset=utf-8"},
       {".mjs", "text/javascript; charset=utf-8"},
       {".css", "text/css; charset=utf-8"},
       {".json", "application/json"},
       {".map", "application/json"},
       {".svg", "image/svg+xml"},
       {".png", "image/png"},
       {".jpg", "image/jpeg"},
       {".webp", "image/webp"},
       {".ico", "image/x-icon"},
       {".woff2", "font/woff2"},
       {".wasm", "application/wasm"},
       {".txt", "text/plain; charset=utf-8"},
       {".md", "text/plain; charset=utf-8"},
       {".webmanifest", "application/manifest+json"}}};
  const auto* const found = std::find_if(
      kTypes.begin(), kTypes.end(), [&](const auto& type) { return type.first == extension; });
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

StaticFiles::StaticFiles(fs::path root) : root_(std::move(root)) {
  if (root_.empty()) return;
  std::error_code error;
  root_ = fs::canonical(root_, error);
  if (error) root_.clear();
}

Response StaticFiles::get(const Request& request) const {
  if (request.method != "GET" && request.method != "HEAD") {
    Response response = problem(405, "files can only be read");
    response.headers.push_back({"Allow", "GET, HEAD"});
    return response;
  }
  Response missing = problem(404, "there is nothing at " + request.path);
  if (root_.empty()) {
    return problem(404, "there is nothing at " + request.path + "; the page has not been built");
  }
  if (!safe_path(request.path)) return missing;
  const std::optional<fs::path> file =
      resolve(root_, request.path == "/" ? "/index.html" : request.path);
  if (!file) return missing;
  const std::optional<std::string> tag = entity_tag(*file);
  std::ifstream in(*file, std::ios::binary);
  if (!tag || !in) return missing;

  Response response;
  response.content_type = mime_type(file->extension().string());
  // The browser must always ask again, so that a new build shows at once. The tag keeps that cheap.
  response.headers = {{"ETag", *tag}, {"Cache-Control", "no-cache"}};
  if (request.header("If-None-Match") == *tag) {
    response.status = 304;
    return response;
  }
  response.body = std::make_shared<const std::string>(std::istreambuf_iterator<char>(in),
                                                      std::istreambuf_iterator<char>());
  return response;
}

}  // namespace server::net
