// db/tags.hpp: the tags of a run as one text: lines, each between two line breaks.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace db::detail {

/// "\nfast\nred\n"; empty without tags.
inline std::string tags_text(const std::vector<std::string>& tags) {
  std::string text;
  for (const std::string& tag : tags) text += (text.empty() ? "\n" : "") + tag + '\n';
  return text;
}

inline std::vector<std::string> tags_of(std::string_view text) {
  std::vector<std::string> tags;
  for (std::size_t from = 1; from < text.size();) {
    const std::size_t end = text.find('\n', from);
    tags.emplace_back(text.substr(from, end - from));
    from = end + 1;
  }
  return tags;
}

}  // namespace db::detail
