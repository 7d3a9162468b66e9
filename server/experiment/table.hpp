// server/experiment/table.hpp: rows and columns of text, for the terminal and for Markdown.
#pragma once

#include <string>
#include <vector>

namespace server::reproduce {

struct Table {
  std::vector<std::string> header{};
  std::vector<std::vector<std::string>> rows{};  // each as long as the header
  std::size_t words = 1;                         // leading columns set left; the others are numbers
};

/// Columns two blanks apart, each line ended.
std::string to_text(const Table& table);
/// A pipe table, with the blank line that must follow it.
std::string to_markdown(const Table& table);

}  // namespace server::reproduce
