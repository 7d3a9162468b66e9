// server/lab/reproduce/marked.hpp: the part of a document that a program writes, between two marks.
#pragma once

#include <string>
#include <string_view>

namespace server::reproduce {

struct Marks {
  std::string_view begin{};
  std::string_view end{};
};

/// Puts `section`, which brings both marks itself, in the place of what lies between them, marks
/// included. False when `text` does not have them.
inline bool replace_marked(std::string& text, const Marks& marks, const std::string& section) {
  const std::size_t begin = text.find(marks.begin);
  if (begin == std::string::npos) return false;
  const std::size_t end = text.find(marks.end, begin);
  if (end == std::string::npos) return false;
  text.replace(begin, end + marks.end.size() - begin, section);
  return true;
}

}  // namespace server::reproduce
