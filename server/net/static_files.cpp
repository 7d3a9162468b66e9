// server/net/static_files.cpp: resolve, then check that the result is still inside.
#include "server/net/static_files.hpp"

#include <array>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace server::net {
namespace {

namespace fs = std::filesystem;

// Everything the page needs comes from this server; nothing is inline.
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "font-src 'self'; connect-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

const char* content_type(const fs::path& path) {
  static constexpr std::array<std::pair<const char*, const char*>, 9> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".ico", "image/x-icon"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".woff2", "font/woff2"},
  }};
  for (const auto& [extension, type] : kTypes) {
    if (path.extension() == extension) return type;
  }
  return "application/octet-stream";
}

bool inside(const fs::path& root, const fs::path& path) {
  const auto [end, unused] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  return end == root.end();
}

}  // namespace

Response serve_file(const fs::path& root, const Request& request) {
  const Response missing = problem(404, "Not found", "There is nothing at " + request.path + ".");
  if (!request.path.starts_with('/') || request.path.find('\\') != std::string::npos ||
      request.path.find("/.") != std::string::npos) {
    return missing;
  }
  std::error_code error;
  const std::string relative = request.path == "/" ? "index.html" : request.path.substr(1);
  const fs::path base = fs::canonical(root, error);
  if (error) {
    return problem(404, "No page", "The page is not built: run 'npm ci && npm run build' in web/.");
  }
  const fs::path file = fs::canonical(base / relative, error);  // follows symbolic links
  if (error || !inside(base, file) || !fs::is_regular_file(file, error)) return missing;

  const auto written = fs::last_write_time(file, error).time_since_epoch().count();
  const std::string tag =
      '"' + std::to_string(written) + '-' + std::to_string(fs::file_size(file, error)) + '"';
  Response response;
  response.headers = {{"ETag", tag},
                      {"Cache-Control", "no-cache"},
                      {"Content-Security-Policy", kContentSecurityPolicy}};
  if (request.header("If-None-Match") == tag) {
    response.status = 304;
    return response;
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) return missing;
  response.content_type = content_type(file);
  response.body = std::make_shared<const std::string>(std::istreambuf_iterator<char>(in),
                                                      std::istreambuf_iterator<char>());
  return response;
}

}  // namespace server::net
