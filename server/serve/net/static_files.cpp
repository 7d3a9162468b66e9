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

#include "server/serve/net/compression.hpp"

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

struct Coding {
  std::string_view name{};       // in Accept-Encoding and Content-Encoding
  std::string_view extension{};  // of the compressed file beside the plain one
};
constexpr std::array<Coding, 2> kCodings{{{"br", ".br"}, {"gzip", ".gz"}}};  // the smaller first

/// True for a name such as "app-NLYKNPYS.js": the build puts a hash of the content into it.
bool named_by_content(const fs::path& file) {
  constexpr std::size_t kHash = 8;
  const std::string stem = file.stem().string();
  if (stem.size() < kHash + 1 || stem[stem.size() - kHash - 1] != '-') return false;
  return std::all_of(stem.end() - kHash, stem.end(), [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= '2' && c <= '7');
  });
}

/// The file to send: a compressed one that the build has put beside `plain`, if the client takes
/// it.
std::pair<fs::path, std::string_view> best_form(const fs::path& root,
                                                const fs::path& plain,
                                                const Request& request) {
  for (const Coding& coding : kCodings) {
    if (!accepts_coding(request, coding.name)) continue;
    const std::string path = '/' + plain.lexically_relative(root).string();
    if (const auto found = resolve(root, path + std::string(coding.extension))) {
      return {*found, coding.name};
    }
  }
  return {plain, {}};
}

/// Changes whenever the file is rewritten: size and modification time in nanoseconds. Each coding
/// has its own.
std::optional<std::string> entity_tag(const fs::path& file, std::string_view coding) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) return std::nullopt;
  return '"' + std::to_string(info.st_size) + '-' + std::to_string(info.st_mtim.tv_sec) + '.' +
         std::to_string(info.st_mtim.tv_nsec) + std::string(coding) + '"';
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
  const auto [form, coding] = best_form(root_, *file, request);
  const std::optional<std::string> tag = entity_tag(form, coding);
  std::ifstream in(form, std::ios::binary);
  if (!tag || !in) return missing;

  Response response;
  response.content_type = mime_type(file->extension().string());
  // A new build shows at once: the browser must always ask again, except for a part whose name
  // changes with its content. The tag keeps that cheap.
  response.headers = {
      {"ETag", *tag},
      {"Cache-Control",
       named_by_content(*file) ? "public, max-age=31536000, immutable" : "no-cache"},
      {"Vary", "Accept-Encoding"}};
  if (!coding.empty()) response.headers.push_back({"Content-Encoding", std::string(coding)});
  if (request.header("If-None-Match") == *tag) {
    response.status = 304;
    std::erase_if(response.headers, [](const Header& h) { return h.name == "Content-Encoding"; });
    return response;
  }
  response.body = std::make_shared<const std::string>(std::istreambuf_iterator<char>(in),
                                                      std::istreambuf_iterator<char>());
  return response;
}

}  // namespace server::net
