// server/run/text_file.hpp: whole files, whose errors are sentences.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace server {

/// All of these throw std::runtime_error with the path and what cannot be done.
std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, std::string_view text);
/// Makes the folder, and those it lies in, where they are not there.
void make_folder(const std::filesystem::path& folder);

}  // namespace server
