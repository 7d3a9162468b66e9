// server/net/http.hpp: HTTP requests and responses as plain values; Beast stays behind server.hpp.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace server::net {

struct Request {
  std::string method{};
  std::string path{};                          // percent-decoded once, without the query
  std::map<std::string, std::string> query{};  // decoded; the last of a repeated key
  std::map<std::string, std::string> params{};  // of the route's pattern: {"id": "12"}
  std::vector<std::pair<std::string, std::string>> headers{};
  std::string body{};
  bool loopback = false;  // the peer is on this machine

  /// The first header of that name, letter case ignored; empty when there is none.
  std::string_view header(std::string_view name) const;
};

struct Response {
  int status = 200;
  std::string content_type{};
  std::vector<std::pair<std::string, std::string>> headers{};
  std::shared_ptr<const std::string> body{};  // null: empty
};

/// Answers one request; to be called once, on the io thread. Safe when the client has gone.
using Responder = std::function<void(Response)>;
using Handler = std::function<void(const Request&, const Responder&)>;

/// RFC 9457: {"type", "title", "status", "detail"}.
Response problem(int status, const std::string& title, const std::string& detail);

/// Splits "/a%20b?x=1&y" into path and query. False when an escape is broken or decodes to NUL.
bool parse_target(std::string_view target, std::string& path, std::map<std::string, std::string>& query);

/// Compares without telling by its time how much of a secret was right.
bool equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace server::net
