// server/experiment/table.cpp: alignment.
#include "server/experiment/table.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace server::reproduce {

std::string to_text(const Table& table) {
  std::vector<std::size_t> widths;
  widths.reserve(table.header.size());
  for (const std::string& title : table.header) widths.push_back(title.size());
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += i < table.words ? fmt::format("{:<{}}  ", row[i], widths[i])
                              : fmt::format("{:>{}}  ", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  };
  add(table.header);
  for (const auto& row : table.rows) add(row);
  return text;
}

std::string to_markdown(const Table& table) {
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    text += fmt::format("| {} |\n", fmt::join(row, " | "));
  };
  add(table.header);
  std::vector<std::string> rule;
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    rule.emplace_back(i < table.words ? "---" : "---:");
  }
  add(rule);
  for (const auto& row : table.rows) add(row);
  return text + "\n";
}

}  // namespace server::reproduce
