// server/experiment/table.hpp: rows and columns of text, in formats for people and programs.
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
  std::size_t words = 1;  // leading columns of words, set left; the others hold numbers
};

/// A column of a table with one row per item: its title, and its cell for an item.
template <typename Item>
struct TitledCell {
  std::string title{};
  std::string (*cell)(const Item& item) = nullptr;
};

/// A table with one row for each of `items`.
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

/// Columns two blanks apart; every line ends with a line feed.
std::string to_text(const Table& table);
/// A pipe table and the blank line that must follow it.
std::string to_markdown(const Table& table);
/// RFC 4180: commas, CRLF, quotes where a cell needs them.
std::string to_csv(const Table& table);
/// A complete tabular, with TeX's reserved characters escaped.
std::string to_latex(const Table& table);
/// An element <table>, in light HTML: th and td, "n" the class of numeric cells.
std::string to_html(const Table& table);
/// `text` with TeX's reserved characters escaped.
std::string latex_text(const std::string& text);
/// A list of objects with the titles as keys. Right of the word columns, a numeric cell becomes a
/// number; an empty or non-finite cell becomes null.
nlohmann::json to_json(const Table& table);

/// Writes the table in the format of the ending of `path`: .txt, .md, .csv, .tex, .json. Throws
/// std::invalid_argument for another ending and std::runtime_error if it cannot write.
void write_table(const Table& table, const std::string& path);
/// True if write_table() knows the ending.
bool is_table_file(std::string_view path);

/// Adds a run as a row: `labels` under `titles`, outcome, reason, and every figure in full. The
/// first run also sets the header.
void add_run(Table& table,
             const std::vector<std::string>& titles,
             std::vector<std::string> labels,
             const Row& row);

}  // namespace server::experiment
