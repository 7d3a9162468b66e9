// server/run/json_limits.cpp: a depth-limited builder on top of the library's event parser.
#include "server/run/json_limits.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace server {
namespace {

using nlohmann::json;

/// "line 2, column 7" of the byte at `offset`, both counted from 1.
std::string place(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t newline = before.rfind('\n');
  const std::size_t start = newline == std::string_view::npos ? 0 : newline + 1;
  return "line " + std::to_string(line) + ", column " +
         std::to_string(std::max<std::size_t>(1, before.size() - start));
}

/// The library's message without its prefixes.
std::string plain_reason(const std::string& message) {
  std::string reason = message;
  for (const std::string_view mark : {"syntax error ", "] "}) {
    const std::size_t at = reason.find(mark);
    if (at == std::string::npos) continue;
    reason = reason.substr(at + mark.size());
    break;
  }
  return reason;
}

/// Builds the value event by event. The open containers are a stack of pointers into `root_`: a
/// parent does not grow while a child is open, so they stay valid.
class Builder final : public nlohmann::json_sax<json> {
 public:
  Builder(std::string_view text, const JsonLimits& limits) : text_(text), limits_(limits) {}

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(std::int64_t value) override { return put(value); }
  bool number_unsigned(std::uint64_t value) override { return put(value); }
  bool number_float(double value, const std::string& /*text*/) override { return put(value); }
  bool string(std::string& value) override { return put(std::move(value)); }
  bool binary(json::binary_t& /*value*/) override { return false; }
  bool start_object(std::size_t /*size*/) override { return open(json::object()); }
  bool start_array(std::size_t /*size*/) override { return open(json::array()); }
  bool key(std::string& name) override {
    key_ = std::move(name);
    return true;
  }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t position,
                   const std::string& /*token*/,
                   const nlohmann::detail::exception& error) override {
    error_ = "bad JSON at " + place(text_, position) + ": " + plain_reason(error.what());
    return false;
  }

  json take() {
    if (!error_.empty()) throw JsonError(error_);
    return std::move(root_);
  }

 private:
  json* place_value(json value) {
    if (stack_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    json& parent = *stack_.back();
    if (parent.is_object()) return &(parent[key_] = std::move(value));
    parent.push_back(std::move(value));
    return &parent.back();
  }
  bool put(json value) {
    place_value(std::move(value));
    return true;
  }
  bool open(json container) {
    if (stack_.size() >= limits_.max_depth) {
      error_ = "JSON nested deeper than " + std::to_string(limits_.max_depth) + " levels";
      return false;
    }
    stack_.push_back(place_value(std::move(container)));
    return true;
  }
  bool close() {
    stack_.pop_back();
    return true;
  }

  std::string_view text_;
  JsonLimits limits_;
  json root_{};
  std::vector<json*> stack_{};
  std::string key_{};
  std::string error_{};
};

}  // namespace

json parse_json(std::string_view text, const JsonLimits& limits) {
  if (text.size() > limits.max_bytes) {
    throw JsonError("JSON of " + std::to_string(text.size()) + " bytes, more than the " +
                    std::to_string(limits.max_bytes) + " accepted");
  }
  Builder builder(text, limits);
  json::sax_parse(text, &builder);
  return builder.take();
}

std::string dump_json(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace server
