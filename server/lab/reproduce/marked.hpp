// server/lab/reproduce/marked.hpp: the part of a document that a program writes, between two marks.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace server::reproduce {

struct Marks {
  std::string_view begin{};
  std::string_view end{};
};

/// Puts `section`, which brings both marks itself, in the place of what lies between them, marks
/// included. False when `text` does not have them.
bool replace_marked(std::string& text, const Marks& marks, const std::string& section);
/// The same in a file, which is made where it is not there; without the marks at its end. Throws
/// std::runtime_error.
void put_marked(const std::filesystem::path& file, const Marks& marks, const std::string& section);

/// Makes the folder `name` beside the document `file`, for its pictures. Throws std::runtime_error,
/// also when `file` is a folder.
std::filesystem::path folder_beside(const std::filesystem::path& file, std::string_view name);

}  // namespace server::reproduce
