// server/run/text_file.hpp: reads and writes whole files; errors are sentences.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace server {

/// All of these throw std::runtime_error with the path and the action that failed.
std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, std::string_view text);
/// As write_text(), but all or nothing: a reader, or the next start after a full disk, finds the
/// old text or the new one.
void replace_text(const std::filesystem::path& file, std::string_view text);
/// Creates the folder and its missing parents.
void make_folder(const std::filesystem::path& folder);

}  // namespace server
