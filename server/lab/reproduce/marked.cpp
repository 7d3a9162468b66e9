// server/lab/reproduce/marked.cpp: finds and replaces the marked part.
#include "server/lab/reproduce/marked.hpp"

#include <stdexcept>

namespace server::reproduce {

bool replace_marked(std::string& text, const Marks& marks, const std::string& section) {
  const std::size_t begin = text.find(marks.begin);
  if (begin == std::string::npos) return false;
  const std::size_t end = text.find(marks.end, begin);
  if (end == std::string::npos) return false;
  text.replace(begin, end + marks.end.size() - begin, section);
  return true;
}

void put_marked(const std::filesystem::path& file, const Marks& marks, const std::string& section) {
  std::string text = std::filesystem::exists(file) ? read_text(file) : "";
  const std::string whole = std::string(marks.begin) + section + std::string(marks.end);
  if (!replace_marked(text, marks, whole)) {
    if (!text.empty()) text += text.ends_with('\n') ? "\n" : "\n\n";
    text += whole;
  }
  write_text(file, text);
}

std::filesystem::path folder_beside(const std::filesystem::path& file, std::string_view name) {
  if (std::filesystem::is_directory(file)) {
    throw std::runtime_error(file.string() + ": is a folder, not a file");
  }
  std::filesystem::path folder = file.parent_path() / name;
  make_folder(folder);
  return folder;
}

}  // namespace server::reproduce
