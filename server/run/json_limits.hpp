// server/run/json_limits.hpp: parses untrusted JSON within limits. A refusal is a sentence that
// says where.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace server {

struct JsonLimits {
  std::size_t max_depth = 64;        // of nested arrays and objects: the library recurses on them
  std::size_t max_bytes = 1u << 20;  // of text
};

/// For documents that this program wrote: a scenario read from one megabyte grows when every value
/// is written out.
inline constexpr JsonLimits kOwnDocument{.max_bytes = 64u << 20};

/// The text is not acceptable JSON; what() is a sentence with the line and column.
class JsonError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses `text`; the last value of a repeated key counts. Throws JsonError on bad syntax, invalid
/// UTF-8, a number beyond a double, or a text that is too deep or too long.
nlohmann::json parse_json(std::string_view text, const JsonLimits& limits = {});

/// Writes `value` in one line; invalid UTF-8 inside strings becomes U+FFFD instead of an exception.
std::string dump_json(const nlohmann::json& value);

}  // namespace server
