// server/run/json_limits.hpp: JSON from strangers: bounded, and refused with a sentence that says
// where.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace server {

struct JsonLimits {
  std::size_t max_depth = 64;  // nested arrays and objects; the library itself recurses on them
  std::size_t max_bytes = 1u << 20;  // of the text
};

/// For documents this program wrote: a scenario that came in a megabyte is longer with every value
/// spelled out.
inline constexpr JsonLimits kOwnDocument{.max_bytes = 64u << 20};

/// A text that is not acceptable JSON; what() is a sentence with the line and column.
class JsonError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses `text`; of a repeated key the last value counts.
/// Throws JsonError on bad syntax, invalid UTF-8, numbers beyond a double, too deep or too long.
nlohmann::json parse_json(std::string_view text, const JsonLimits& limits = {});

/// Writes `value` in one line; invalid UTF-8 inside strings becomes U+FFFD instead of an exception.
std::string dump_json(const nlohmann::json& value);

}  // namespace server
