// server/cli/output_files.cpp: tries each output, and compares its path with the others.
#include "server/cli/output_files.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

namespace server {
namespace {

namespace fs = std::filesystem;

/// A device or a pipe: nothing is lost if two outputs go there.
bool is_special(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) && fs::is_other(path, ignored);
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  if (fs::equivalent(a, b, missing)) return true;
  return fs::weakly_canonical(fs::absolute(a)) == fs::weakly_canonical(fs::absolute(b));
}

}  // namespace

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

void refuse_shared_files(const std::vector<NamedFile>& inputs,
                         const std::vector<NamedFile>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const NamedFile& output = outputs[i];
    if (output.path.empty() || is_special(output.path)) continue;
    const auto refuse = [&](const NamedFile& other, const char* loss) {
      if (other.path.empty() || !is_same_file(output.path, other.path)) return;
      throw std::runtime_error(fmt::format(
          "{} and {} are one file, {}: {}", other.name, output.name, output.path.string(), loss));
    };
    for (const NamedFile& input : inputs) refuse(input, "it would be overwritten");
    for (std::size_t k = 0; k < i; ++k) refuse(outputs[k], "one would overwrite the other");
  }
}

}  // namespace server
