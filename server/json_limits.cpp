// server/json_limits.cpp: a scan for depth, then the parser.
#include "server/json_limits.hpp"

namespace server {
namespace {

/// Offset of the bracket that is one too deep, or npos.
std::size_t too_deep_at(std::string_view text) {
  std::size_t depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') {
        ++i;
      } else if (c == '"') {
        in_string = false;
      }
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMaxJsonDepth) return i;
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return std::string_view::npos;
}

}  // namespace

nlohmann::json parse_json(std::string_view text) {
  if (const std::size_t at = too_deep_at(text); at != std::string_view::npos) {
    throw JsonError("nested more than " + std::to_string(kMaxJsonDepth) + " deep at byte " +
                    std::to_string(at));
  }
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& e) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    const std::string what = e.what();
    const std::size_t start = what.find("] ");
    throw JsonError(start == std::string::npos ? what : what.substr(start + 2));
  }
}

std::string dump_json(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace server
