// server/run/library_files.cpp: file access; errors become sentences.
#include "server/run/library_files.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>
#include <vector>

#include <fmt/format.h>

namespace server {

namespace fs = std::filesystem;

bool valid_name(std::string_view name) {
  return !name.empty() && name.size() <= 64 &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string_view::npos;
}

bool names_file(const std::string& text) {
  std::error_code error;
  const fs::path path(text);
  return text.find('/') != std::string::npos || path.has_extension() ||
         fs::is_regular_file(path, error);
}

std::string read_file(const fs::path& path, const std::string& shown) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    throw LibraryError(LibraryError::Kind::NotFound,
                       fmt::format("{} is a folder, not a file.", shown));
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw LibraryError(LibraryError::Kind::NotFound, fmt::format("Cannot read {}.", shown));
  return {std::istreambuf_iterator<char>(in), {}};
}

void for_each_file(const fs::path& folder,
                   const char* extension,
                   const std::function<void(const fs::path&)>& visit) {
  std::error_code error;
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error) && entry.path().extension() == extension &&
        valid_name(entry.path().stem().string())) {
      paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  for (const fs::path& path : paths) visit(path);
}

}  // namespace server
