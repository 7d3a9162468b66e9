// server/net/access.cpp: Host, Origin and token rules, without a socket.
#include "server/net/access.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <utility>

#include "server/json_limits.hpp"

namespace server::net {
namespace {

constexpr std::string_view kCookie = "tautline_session";
constexpr std::size_t kMinToken = 16;
constexpr std::size_t kMaxSessions = 64;

struct HostPort {
  std::string_view host{};  // IPv6 without its brackets
  std::string_view port{};  // empty when not given
};

HostPort split_host(std::string_view text) {
  if (!text.empty() && text.front() == '[') {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return {};
    const std::string_view rest = text.substr(end + 1);
    return {text.substr(1, end - 1), rest.empty() ? rest : rest.substr(1)};
  }
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return {text, {}};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

/// A browser leaves the default port out of both Host and Origin, other clients may not.
std::string with_port(std::string_view authority, std::string_view default_port) {
  const HostPort parts = split_host(authority);
  const std::string_view port = parts.port.empty() ? default_port : parts.port;
  return std::string(parts.host).append(":").append(port);
}

/// 128 random bits in hex. random_device reads the kernel's generator on this platform.
std::string random_id() {
  static constexpr std::string_view kHex = "0123456789abcdef";
  std::random_device source;
  std::string id;
  for (int word = 0; word < 4; ++word) {
    std::uint32_t bits = source();
    for (int digit = 0; digit < 8; ++digit, bits >>= 4) id.push_back(kHex[bits & 15u]);
  }
  return id;
}

std::string_view bearer(const Request& request) {
  const std::string_view value = request.header("Authorization");
  constexpr std::string_view kScheme = "Bearer ";
  if (value.size() <= kScheme.size() || !equal_no_case(value.substr(0, kScheme.size()), kScheme)) {
    return {};
  }
  return value.substr(kScheme.size());
}

std::size_t count_headers(const Request& request, std::string_view name) {
  return static_cast<std::size_t>(
      std::count_if(request.headers.begin(), request.headers.end(), [&](const Header& h) {
        return equal_no_case(h.name, name);
      }));
}

}  // namespace

bool equal_constant_time(std::string_view a, std::string_view b) {
  std::size_t difference = a.size() ^ b.size();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char other = b.empty() ? '\0' : b[i % b.size()];
    difference |= static_cast<std::size_t>(static_cast<unsigned char>(a[i]) ^
                                           static_cast<unsigned char>(other));
  }
  return difference == 0;
}

bool is_loopback_name(std::string_view host) {
  if (equal_no_case(host, "localhost") || host == "::1") return true;
  // Only the dotted form: "127.0.0.1.example" is somebody's domain.
  return host.substr(0, 4) == "127." && std::all_of(host.begin(), host.end(), [](char c) {
           return c == '.' || (c >= '0' && c <= '9');
         });
}

Access::Access(AccessOptions options) : options_(std::move(options)) {
  if (!options_.token.empty() && options_.token.size() < kMinToken) {
    throw std::invalid_argument("the token has " + std::to_string(options_.token.size()) +
                                " characters; give it at least " + std::to_string(kMinToken));
  }
}

bool Access::host_allowed(std::string_view host, std::string_view local_address) const {
  const HostPort parts = split_host(host);
  if (parts.host.empty()) return false;
  if (is_loopback_name(parts.host) || parts.host == local_address) return true;
  return std::any_of(options_.allow_hosts.begin(), options_.allow_hosts.end(), [&](const auto& a) {
    return equal_no_case(a, host) || equal_no_case(a, parts.host);
  });
}

bool Access::origin_allowed(const Request& request) const {
  if (count_headers(request, "Origin") > 1) return false;
  if (count_headers(request, "Origin") == 0) {
    return request.loopback || options_.insecure || (token_required() && authorized(request));
  }
  const std::string_view origin = request.header("Origin");
  const auto& list = options_.allow_origins;
  if (std::any_of(
          list.begin(), list.end(), [&](const auto& o) { return equal_no_case(o, origin); })) {
    return true;
  }
  constexpr std::string_view kScheme = "http://";
  if (!equal_no_case(origin.substr(0, kScheme.size()), kScheme)) return false;
  return equal_no_case(with_port(origin.substr(kScheme.size()), "80"),
                       with_port(request.header("Host"), "80"));
}

bool Access::authorized(const Request& request) const {
  if (options_.token.empty()) return true;
  if (equal_constant_time(bearer(request), options_.token)) return true;
  const std::string_view cookie = request.cookie(kCookie);
  return !cookie.empty() && std::any_of(sessions_.begin(), sessions_.end(), [&](const auto& id) {
    return equal_constant_time(cookie, id);
  });
}

std::optional<Response> Access::refuse(const Request& request,
                                       std::string_view local_address,
                                       bool upgrade,
                                       bool protected_path) const {
  if (count_headers(request, "Host") != 1) {
    return problem(400, "a request needs exactly one Host header");
  }
  const std::string host{request.header("Host")};
  if (!host_allowed(host, local_address)) {
    return problem(421,
                   "this server does not go by the name '" + host +
                       "'; start it with --allow-host " + host + " if it should");
  }
  const bool reads =
      request.method == "GET" || request.method == "HEAD" || request.method == "OPTIONS";
  const bool authorized_now = authorized(request);
  const bool needs_token =
      (protected_path || upgrade) && request.path != kLoginPath &&
      std::find(options_.open_paths.begin(), options_.open_paths.end(), request.path) ==
          options_.open_paths.end();
  if ((upgrade || !reads) && !origin_allowed(request)) {
    const std::string origin{request.header("Origin")};
    if (origin.empty() && token_required() && needs_token && !authorized_now) {
      // Not a browser and no token: say what is missing rather than speak of origins.
      Response response = problem(401, "this server wants its token, as 'Authorization: Bearer'");
      response.headers.push_back({"WWW-Authenticate", "Bearer"});
      return response;
    }
    return problem(403,
                   "requests from the origin '" + origin +
                       "' are not taken; the page must come from this server or an allowed origin");
  }
  if (needs_token && !authorized_now) {
    Response response = problem(
        401, "this server wants its token, as 'Authorization: Bearer' or by a login of the page");
    response.headers.push_back({"WWW-Authenticate", "Bearer"});
    return response;
  }
  return std::nullopt;
}

Response Access::login(const Request& request) {
  if (!token_required()) return text_response(204, "", "");
  std::string token;
  try {
    const nlohmann::json body = parse_json(request.body);
    if (!body.is_object() || !body.contains("token") || !body["token"].is_string()) {
      return problem(422, "the body must be an object with a string 'token'");
    }
    token = body["token"].get<std::string>();
  } catch (const JsonError& error) {
    return problem(400, error.what());
  }
  if (!equal_constant_time(token, options_.token)) return problem(401, "that is not the token");

  if (sessions_.size() >= kMaxSessions) sessions_.pop_front();
  sessions_.push_back(random_id());
  Response response = text_response(204, "", "");
  response.headers.push_back(
      {"Set-Cookie",
       std::string(kCookie) + '=' + sessions_.back() + "; Path=/; HttpOnly; SameSite=Strict"});
  return response;
}

}  // namespace server::net
