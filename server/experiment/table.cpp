// server/experiment/table.cpp: one table in six formats.
#include "server/experiment/table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "server/experiment/svg_canvas.hpp"
#include "server/experiment/trial.hpp"
#include "server/run/text_file.hpp"

namespace server::experiment {
namespace {

using Cells = std::vector<std::string>;

/// Calls `add` with the header and then with every row.
template <typename Add>
void each_line(const Table& table, const Add& add) {
  add(table.header);
  for (const Cells& row : table.rows) add(row);
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::optional<double> number(const std::string& text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [ptr, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || ptr != end) return std::nullopt;
  return value;
}

nlohmann::json json_cell(const std::string& text, bool words) {
  if (words) return text;
  if (text.empty()) return nullptr;
  const std::optional<double> value = number(text);
  if (!value) return text;
  if (!std::isfinite(*value)) return nullptr;
  const bool whole = *value == std::floor(*value) && std::abs(*value) < 1e15;
  return whole ? nlohmann::json(static_cast<std::int64_t>(*value)) : nlohmann::json(*value);
}

struct Form {
  std::string_view ending{};
  std::string (*write)(const Table&) = nullptr;
};
constexpr auto kForms = std::to_array<Form>({
    {".txt", to_text},
    {".md", to_markdown},
    {".csv", to_csv},
    {".tex", to_latex},
    {".json", [](const Table& table) { return to_json(table).dump(1) + "\n"; }},
});

const Form* form_of(std::string_view path) {
  const auto* const found =
      std::ranges::find_if(kForms, [&](const Form& form) { return path.ends_with(form.ending); });
  return found == kForms.end() ? nullptr : found;
}

}  // namespace

std::string to_text(const Table& table) {
  std::vector<std::size_t> widths(table.header.size());
  each_line(table, [&](const Cells& row) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  });
  std::string text;
  each_line(table, [&](const Cells& row) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += i < table.words ? fmt::format("{:<{}}  ", row[i], widths[i])
                              : fmt::format("{:>{}}  ", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  });
  return text;
}

std::string to_markdown(const Table& table) {
  std::string text;
  std::string rule = "|";
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    rule += i < table.words ? " --- |" : " ---: |";
  }
  each_line(table, [&](const Cells& row) {
    text += fmt::format("| {} |\n", fmt::join(row, " | "));
    if (&row == &table.header) text += rule + "\n";
  });
  return text + "\n";
}

std::string to_html(const Table& table) {
  std::string text = "<table>\n";
  each_line(table, [&](const Cells& row) {
    const bool head = &row == &table.header;
    const char* const cell = head ? "th" : "td";
    text += head ? "<thead><tr>" : "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const char* const numeric = i < table.words ? "" : " class=\"n\"";
      text += fmt::format("<{0}{1}>{2}</{0}>", cell, numeric, xml_text(row[i]));
    }
    text += head ? "</tr></thead>\n<tbody>\n" : "</tr>\n";
  });
  return text + "</tbody></table>\n";
}

std::string to_csv(const Table& table) {
  std::string text;
  each_line(table, [&](const Cells& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += (i > 0 ? "," : "") + csv_cell(row[i]);
    }
    text += "\r\n";
  });
  return text;
}

std::string latex_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\textbackslash{}";
    } else if (c == '~' || c == '^') {
      out += fmt::format("\\{}{{}}", c);
    } else {
      if (std::string_view("#$%&_{}").find(c) != std::string_view::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

std::string to_latex(const Table& table) {
  std::string columns;
  for (std::size_t i = 0; i < table.header.size(); ++i) columns += i < table.words ? 'l' : 'r';
  std::string text = fmt::format("\\begin{{tabular}}{{{}}}\n\\hline\n", columns);
  each_line(table, [&](const Cells& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += (i > 0 ? " & " : "") + latex_text(row[i]);
    }
    text += &row == &table.header ? " \\\\\n\\hline\n" : " \\\\\n";
  });
  return text + "\\hline\n\\end{tabular}\n";
}

nlohmann::json to_json(const Table& table) {
  nlohmann::json list = nlohmann::json::array();
  for (const Cells& row : table.rows) {
    nlohmann::json object = nlohmann::json::object();
    for (std::size_t i = 0; i < row.size(); ++i) {
      object[table.header[i]] = json_cell(row[i], i < table.words);
    }
    list.push_back(std::move(object));
  }
  return list;
}

bool is_table_file(std::string_view path) {
  return form_of(path) != nullptr;
}

void write_table(const Table& table, const std::string& path) {
  const Form* const form = form_of(path);
  if (form == nullptr) {
    throw std::invalid_argument(path + ": must end in .txt, .md, .csv, .tex or .json");
  }
  write_text(path, form->write(table));
}

void add_run(Table& table,
             const std::vector<std::string>& titles,
             std::vector<std::string> labels,
             const Row& row) {
  if (table.header.empty()) {
    table.words = titles.size() + 2;
    table.header = titles;
    table.header.insert(table.header.end(), {"outcome", "reason"});
    for (const auto& [column, unused] : row.figures) table.header.emplace_back(column);
  }
  labels.insert(labels.end(), {std::string(algo::name(row.outcome)), row.reason});
  for (const auto& [unused, value] : row.figures) {
    labels.push_back(std::isfinite(value) ? fmt::format("{}", value) : "");
  }
  table.rows.push_back(std::move(labels));
}

}  // namespace server::experiment
