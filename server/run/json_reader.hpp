// server/run/json_reader.hpp: reads fields out of untrusted JSON; each error names the field and
// the fault.
#pragma once

#include <initializer_list>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace server {

/// The document is invalid. what() is "obstacles/2/radius: must be above 0".
class DocumentError : public std::runtime_error {
 public:
  DocumentError(const std::string& path, const std::string& complaint)
      : std::runtime_error((path.empty() ? "document" : path) + ": " + complaint) {}
};

struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// One JSON object under inspection. Holds references: the document must outlive it.
class JsonReader {
 public:
  /// Throws DocumentError when `value` is not an object.
  JsonReader(const nlohmann::json& value, std::string path);

  /// Throws when a field is not among `known`: a misspelt field must not pass unnoticed.
  void only(std::initializer_list<std::string_view> known) const { only(std::span(known)); }
  void only(std::span<const std::string_view> known) const;

  bool has(std::string_view key) const;  // present and not null
  double number(std::string_view key, NumberRange range = {}) const;
  double number_or(std::string_view key, double fallback, NumberRange range = {}) const;
  std::uint64_t whole(std::string_view key, std::uint64_t max) const;
  std::uint64_t whole_or(std::string_view key, std::uint64_t fallback, std::uint64_t max) const;
  std::string text(std::string_view key, std::size_t max_length = 4096) const;
  std::string text_or(std::string_view key, std::string fallback) const;
  bool flag_or(std::string_view key, bool fallback) const;
  JsonReader object(std::string_view key) const;
  const nlohmann::json& array(std::string_view key, std::size_t max_size) const;
  /// Calls `visit(value, path)` for each entry of the list `key`.
  template <typename Visit>
  void each(std::string_view key, std::size_t max_size, const Visit& visit) const {
    const nlohmann::json& list = array(key, max_size);
    for (std::size_t i = 0; i < list.size(); ++i) visit(list[i], at(key) + '/' + std::to_string(i));
  }
  const nlohmann::json& raw() const { return value_; }
  std::string at(std::string_view key) const;  // path of a field
  [[noreturn]] void fail(std::string_view key, const std::string& complaint) const;

 private:
  const nlohmann::json& field(std::string_view key) const;

  const nlohmann::json& value_;
  std::string path_;
};

/// A finite number at `path`. Throws DocumentError.
double finite_number(const nlohmann::json& value, const std::string& path, NumberRange range = {});

}  // namespace server
