// server/lab/reproduce/marked.hpp: replaces the part of a document between two marks.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "server/run/text_file.hpp"

namespace server::reproduce {

struct Marks {
  std::string_view begin{};
  std::string_view end{};
};

/// Replaces the text between two marks, and the marks, by `section`, which holds both marks itself.
/// False if `text` lacks the marks.
bool replace_marked(std::string& text, const Marks& marks, const std::string& section);
/// Puts the marks and `section` between them into a file, in place of what was between them before.
/// Creates the file if needed; appends if the marks are missing. Throws std::runtime_error.
void put_marked(const std::filesystem::path& file, const Marks& marks, const std::string& section);

/// Creates the folder `name` beside the document `file`, for its pictures. Throws
/// std::runtime_error, also if `file` is a folder.
std::filesystem::path folder_beside(const std::filesystem::path& file, std::string_view name);

/// Writes the `pictures` of a study to pictures/reproduction beside `file`, and its section into
/// the file.
template <typename Study, typename Pictures>
void write_study(const std::filesystem::path& file,
                 const Marks& marks,
                 const Study& study,
                 const Pictures& pictures) {
  constexpr const char* kFolder = "pictures/reproduction";
  const std::filesystem::path folder = folder_beside(file, kFolder);
  for (const auto& picture : pictures) write_text(folder / picture.file, picture.svg);
  put_marked(file, marks, to_markdown(study, kFolder));
}

}  // namespace server::reproduce
