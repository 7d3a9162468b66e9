// server/run/json_reader.cpp: field access whose errors a person can act on.
#include "server/run/json_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace server {

using nlohmann::json;

double finite_number(const json& value, const std::string& path, NumberRange range) {
  if (!value.is_number()) {
    throw DocumentError(path, fmt::format("must be a number, not {}", value.type_name()));
  }
  const double number = value.get<double>();
  if (!std::isfinite(number)) throw DocumentError(path, "must be a finite number");
  if (number < range.min || number > range.max) {
    if (std::isinf(range.max)) {
      throw DocumentError(path, fmt::format("is {:g}, must be at least {:g}", number, range.min));
    }
    throw DocumentError(
        path, fmt::format("is {:g}, must lie in {:g} to {:g}", number, range.min, range.max));
  }
  return number;
}

JsonReader::JsonReader(const json& value, std::string path)
    : value_(value), path_(std::move(path)) {
  if (!value.is_object()) {
    throw DocumentError(path_, fmt::format("must be an object, not {}", value.type_name()));
  }
}

void JsonReader::only(std::span<const std::string_view> known) const {
  for (const auto& [key, unused] : value_.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw DocumentError(
        path_,
        known.empty()
            ? fmt::format("unknown field '{}'; it takes none", key)
            : fmt::format("unknown field '{}'; known are {}", key, fmt::join(known, ", ")));
  }
}

std::string JsonReader::at(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}/{}", path_, key);
}

void JsonReader::fail(std::string_view key, const std::string& complaint) const {
  throw DocumentError(at(key), complaint);
}

bool JsonReader::has(std::string_view key) const {
  const auto it = value_.find(key);
  return it != value_.end() && !it->is_null();
}

const json& JsonReader::field(std::string_view key) const {
  const auto it = value_.find(key);
  if (it == value_.end()) fail(key, "is missing");
  return *it;
}

double JsonReader::number(std::string_view key, NumberRange range) const {
  return finite_number(field(key), at(key), range);
}

double JsonReader::number_or(std::string_view key, double fallback, NumberRange range) const {
  return has(key) ? number(key, range) : fallback;
}

std::uint64_t JsonReader::whole(std::string_view key, std::uint64_t max) const {
  const json& value = field(key);
  const bool whole =
      value.is_number_unsigned() || (value.is_number_integer() && value.get<std::int64_t>() >= 0);
  if (!whole) fail(key, "must be a whole number of at least 0");
  const auto number = value.get<std::uint64_t>();
  if (number > max) fail(key, fmt::format("is {}, must be at most {}", number, max));
  return number;
}

std::uint64_t JsonReader::whole_or(std::string_view key,
                                   std::uint64_t fallback,
                                   std::uint64_t max) const {
  return has(key) ? whole(key, max) : fallback;
}

std::string JsonReader::text(std::string_view key, std::size_t max_length) const {
  const json& value = field(key);
  if (!value.is_string()) fail(key, fmt::format("must be text, not {}", value.type_name()));
  auto text = value.get<std::string>();
  if (text.size() > max_length) fail(key, fmt::format("is longer than {} bytes", max_length));
  return text;
}

std::string JsonReader::text_or(std::string_view key, std::string fallback) const {
  return has(key) ? text(key) : std::move(fallback);
}

bool JsonReader::flag_or(std::string_view key, bool fallback) const {
  if (!has(key)) return fallback;
  const json& value = field(key);
  if (!value.is_boolean()) fail(key, "must be true or false");
  return value.get<bool>();
}

JsonReader JsonReader::object(std::string_view key) const {
  return {field(key), at(key)};
}

const json& JsonReader::array(std::string_view key, std::size_t max_size) const {
  const json& value = field(key);
  if (!value.is_array()) fail(key, fmt::format("must be a list, not {}", value.type_name()));
  if (value.size() > max_size) fail(key, fmt::format("has more than {} entries", max_size));
  return value;
}

}  // namespace server
