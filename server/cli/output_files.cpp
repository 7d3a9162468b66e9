// server/cli/output_files.cpp: tries each output.
#include "server/cli/output_files.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

namespace server {
namespace fs = std::filesystem;

std::string refuse_unwritable(const std::string& path) {
  std::error_code ignored;
  if (path.empty()) return "needs the name of a file";
  if (fs::is_directory(path, ignored)) return path + " is a folder: name the file to write";
  const bool exists = fs::exists(fs::symlink_status(path, ignored));
  // A pipe would wait for its reader; a link to nothing would leave its target behind.
  if (exists && !fs::is_regular_file(path, ignored)) return {};
  std::FILE* const file = std::fopen(path.c_str(), "ab");
  if (file == nullptr) {
    return fmt::format("{}: cannot be written: {}", path, std::generic_category().message(errno));
  }
  std::fclose(file);
  if (!exists) fs::remove(path, ignored);
  return {};
}

std::string refuse_unwritable_document(const std::string& path) {
  if (!fs::path(path).has_filename()) return refuse_unwritable(path);
  fs::path first_missing = fs::absolute(path);
  std::error_code ignored;
  while (!fs::exists(first_missing.parent_path(), ignored)) {
    first_missing = first_missing.parent_path();
  }
  return refuse_unwritable(first_missing.string());
}

}  // namespace server
