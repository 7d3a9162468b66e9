// server/lab/reproduce/marked.hpp: replaces the part of a document between two marks.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace server::reproduce {

struct Marks {
  std::string_view begin{};
  std::string_view end{};
};

/// Replaces the text between two marks, and the marks, by `section`, which holds both marks itself.
/// False if `text` lacks the marks.
bool replace_marked(std::string& text, const Marks& marks, const std::string& section);
/// As replace_marked(), in a file. Creates the file if needed; appends `section` if the marks are
/// missing. Throws std::runtime_error.
void put_marked(const std::filesystem::path& file, const Marks& marks, const std::string& section);

/// Creates the folder `name` beside the document `file`, for its pictures. Throws
/// std::runtime_error, also if `file` is a folder.
std::filesystem::path folder_beside(const std::filesystem::path& file, std::string_view name);

}  // namespace server::reproduce
