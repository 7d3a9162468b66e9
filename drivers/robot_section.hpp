// drivers/robot_section.hpp: one table of a robot's file; every error names its line.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "drivers/robot_file.hpp"

namespace drivers {

/// The range of a number, both ends included.
struct Limits {
  double min = 0;
  double max = 0;
};

/// One table of the file. done() refuses every key that was not read.
class Section {
 public:
  Section(const toml::table& table, std::string name, const std::string& file)
      : table_(table), name_(std::move(name)), file_(file) {}

  [[noreturn]] void fail_at(std::size_t line, const std::string& sentence) const {
    throw RobotFileError(file_ + ":" + std::to_string(line) + ": " + sentence);
  }
  [[noreturn]] void fail(std::string_view key, const std::string& sentence) const {
    const std::string where = name_.empty() ? std::string(key) : name_ + " " + std::string(key);
    fail_at(line_of(key), where + " " + sentence);
  }
  /// The line of `key`, or of the table without such a key.
  std::size_t line_of(std::string_view key) const {
    const toml::node* node = table_.get(key);
    const toml::source_region& at = node != nullptr ? node->source() : table_.source();
    return std::max<std::size_t>(1, at.begin.line);
  }
  bool has(std::string_view key) const { return table_.contains(key); }

  double number(std::string_view key, Limits limits) {
    const toml::node* node = find(key);
    if (node == nullptr) fail(key, "is missing");
    const std::optional<double> value = node->value<double>();
    if (!value || !node->is_number()) fail(key, "must be a number");
    if (!(*value >= limits.min && *value <= limits.max)) {
      fail(key, fmt::format("must be {:g} to {:g}, not {:g}", limits.min, limits.max, *value));
    }
    return *value;
  }
  double number_or(std::string_view key, double fallback, Limits limits) {
    return has(key) ? number(key, limits) : fallback;
  }
  int whole_or(std::string_view key, int fallback, Limits limits) {
    if (!has(key)) return fallback;
    const double value = number(key, limits);
    if (value != std::floor(value)) fail(key, "must be a whole number");
    return static_cast<int>(value);
  }
  bool flag_or(std::string_view key, bool fallback) {
    const toml::node* node = find(key);
    if (node == nullptr) return fallback;
    if (!node->is_boolean()) fail(key, "must be true or false");
    return node->value<bool>().value_or(fallback);
  }
  std::string text(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) fail(key, "is missing");
    const std::optional<std::string> value = node->value<std::string>();
    if (!value || !node->is_string()) fail(key, "must be a text in quotes");
    if (value->empty()) fail(key, "must not be empty");
    return *value;
  }
  std::string text_or(std::string_view key, std::string fallback) {
    return has(key) ? text(key) : std::move(fallback);
  }
  /// A number that must be one of `allowed`.
  template <std::size_t N>
  double one_of(std::string_view key, double fallback, const std::array<double, N>& allowed) {
    const double value = number_or(key, fallback, {-1e9, 1e9});
    if (std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return value;
    std::string known;
    for (const double a : allowed) known += (known.empty() ? "" : ", ") + fmt::format("{:g}", a);
    fail(key, fmt::format("is {:g}; it can be ", value) + known);
  }
  Section table(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr)
      fail_at(std::max(1U, table_.source().begin.line), "there is no [" + std::string(key) + "]");
    if (!node->is_table()) fail(key, "must be a table: [" + std::string(key) + "]");
    return {*node->as_table(), "[" + std::string(key) + "]", file_};
  }
  std::vector<Section> tables(std::string_view key) {
    std::vector<Section> out;
    const toml::node* node = find(key);
    if (node == nullptr) return out;
    const std::string name = "[[" + std::string(key) + "]]";
    const toml::array* list = node->as_array();
    if (list == nullptr || list->empty()) fail(key, "must be tables: " + name);
    for (const toml::node& item : *list) {
      if (!item.is_table()) fail(key, "must be tables: " + name);
      out.emplace_back(*item.as_table(), name, file_);
    }
    return out;
  }
  /// "tcp:HOST:PORT", or any path.
  std::string port() {
    std::string port = text("port");
    const std::size_t colon = port.rfind(':');
    if (port.starts_with("tcp:") && (colon <= 4 || colon + 1 == port.size())) {
      fail("port", "is '" + port + "', which is not of the form tcp:HOST:PORT");
    }
    return port;
  }
  std::vector<int> whole_list(std::string_view key, Limits limits) {
    std::vector<int> out;
    const toml::node* node = find(key);
    if (node == nullptr) return out;
    const toml::array* list = node->as_array();
    if (list == nullptr) fail(key, "must be a list of numbers");
    for (const toml::node& item : *list) {
      const auto value = item.value<std::int64_t>();
      if (!value || !item.is_integer() || static_cast<double>(*value) < limits.min ||
          static_cast<double>(*value) > limits.max) {
        fail(key, fmt::format("must be whole numbers from {:g} to {:g}", limits.min, limits.max));
      }
      out.push_back(static_cast<int>(*value));
    }
    return out;
  }
  /// A list of pairs of numbers, such as [[2.38, 0.1], [1.26, 0.2]].
  std::vector<std::array<double, 2>> pairs(std::string_view key) {
    std::vector<std::array<double, 2>> out;
    const toml::node* node = find(key);
    if (node == nullptr) return out;
    const toml::array* list = node->as_array();
    if (list == nullptr) fail(key, "must be a list of pairs of numbers");
    for (const toml::node& item : *list) {
      const toml::array* pair = item.as_array();
      if (pair == nullptr || pair->size() != 2 || !(*pair)[0].is_number() ||
          !(*pair)[1].is_number()) {
        fail(key, "must be a list of pairs of numbers");
      }
      out.push_back({(*pair)[0].value_or(0.0), (*pair)[1].value_or(0.0)});
    }
    return out;
  }
  void done() const {
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      if (asked_.contains(name)) continue;
      fail_at(node.source().begin.line,
              (name_.empty() ? "" : name_ + " ") + "'" + name + "' is no key known here");
    }
  }

 private:
  const toml::node* find(std::string_view key) {
    asked_.emplace(key);
    return table_.get(key);
  }

  const toml::table& table_;
  std::string name_;
  const std::string& file_;
  std::set<std::string> asked_{};
};

}  // namespace drivers
