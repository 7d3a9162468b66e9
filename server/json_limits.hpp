// server/json_limits.hpp: parsing JSON from strangers.
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

namespace server {

/// Text that is not JSON, or nested too deeply; what() says where.
class JsonError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

constexpr std::size_t kMaxJsonDepth = 64;

/// Parses `text`. Depth is checked before the parser sees it: the library builds 100,000 nested
/// lists without complaint and then overruns the stack on the first copy. Throws JsonError.
nlohmann::json parse_json(std::string_view text);

/// As text, with invalid UTF-8 replaced instead of thrown over.
std::string dump_json(const nlohmann::json& value);

}  // namespace server
