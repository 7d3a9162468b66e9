// server/experiment/table.hpp: rows and columns of text in the forms that people and programs read.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace server::experiment {

struct Row;

struct Table {
  std::vector<std::string> header{};
  std::vector<std::vector<std::string>> rows{};  // each as long as the header
  std::size_t words = 1;                         // leading columns set left; the others are numbers
};

/// A column of a table whose lines are items: its title, and what it says of one.
template <typename Item>
struct TitledCell {
  std::string title{};
  std::string (*cell)(const Item& item) = nullptr;
};

/// A line for each of `items`.
template <typename Item, typename Items>
Table tabulated(const Items& items,
                std::size_t words,
                const std::vector<TitledCell<Item>>& columns) {
  Table table{.words = words};
  for (const auto& column : columns) table.header.push_back(column.title);
  for (const Item& item : items) {
    std::vector<std::string>& line = table.rows.emplace_back();
    for (const auto& column : columns) line.push_back(column.cell(item));
  }
  return table;
}

/// Columns two blanks apart, each line ended.
std::string to_text(const Table& table);
/// A pipe table, with the blank line that must follow it.
std::string to_markdown(const Table& table);
/// RFC 4180: commas, CRLF, quotes where a cell needs them.
std::string to_csv(const Table& table);
/// A tabular of its own, with what TeX reserves escaped.
std::string to_latex(const Table& table);
/// A list of objects by the titles. A cell right of the words that is a number is one; an empty
/// cell and what is not finite is null.
nlohmann::json to_json(const Table& table);

/// The table in the form that the ending of `path` names: .txt, .md, .csv, .tex, .json. Throws
/// std::invalid_argument for another ending and std::runtime_error when it cannot be written.
void write_table(const Table& table, const std::string& path);
/// Whether write_table() knows the ending.
bool is_table_file(std::string_view path);

/// Adds a run to a table whose rows are runs: `labels` under `titles`, outcome, reason, and every
/// figure in full. The first run gives the header.
void add_run(Table& table,
             const std::vector<std::string>& titles,
             std::vector<std::string> labels,
             const Row& row);

}  // namespace server::experiment
