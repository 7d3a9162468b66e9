// server/net/access.cpp: checks that need no socket, so that tests can call them straight.
#include "server/net/access.hpp"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <cctype>
#include <nlohmann/json.hpp>

#include "server/json_limits.hpp"

namespace server::net {
namespace {

constexpr std::string_view kCookie = "tautline_token=";
constexpr std::string_view kLoginPath = "/api/v1/login";

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  return out;
}

std::string host_of(std::string_view header) {
  if (!header.empty() && header.front() == '[') {  // [::1]:8080
    const std::size_t end = header.find(']');
    return lower(end == std::string_view::npos ? header : header.substr(1, end - 1));
  }
  return lower(header.substr(0, header.find(':')));
}

bool is_address(const std::string& host) {
  boost::system::error_code error;
  boost::asio::ip::make_address(host, error);
  return !error;
}

bool listens_beyond_loopback(const ServerOptions& options) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(options.address, error);
  return !error && !address.is_loopback();
}

bool host_allowed(const ServerOptions& options, const std::string& host) {
  if (host == "localhost" || host == "127.0.0.1" || host == "::1") return true;
  if (host == lower(options.address)) return true;
  // DNS rebinding needs a name: a bare address is as good as the one we listen on.
  if (listens_beyond_loopback(options) && is_address(host)) return true;
  return std::any_of(options.allow_hosts.begin(), options.allow_hosts.end(), [&](const auto& name) {
    return host_of(name) == host;
  });
}

bool origin_allowed(const ServerOptions& options, const Request& request, std::string_view origin) {
  const std::string host = lower(request.header("Host"));
  const std::string from = lower(origin);
  if (from == "http://" + host || from == "https://" + host) return true;
  return std::any_of(options.allow_origins.begin(),
                     options.allow_origins.end(),
                     [&](const auto& allowed) { return lower(allowed) == from; });
}

bool has_token(const ServerOptions& options, const Request& request) {
  const std::string_view bearer = request.header("Authorization");
  if (bearer.starts_with("Bearer ") &&
      equal_in_constant_time(bearer.substr(7), options.token)) {
    return true;
  }
  std::string_view cookies = request.header("Cookie");
  while (!cookies.empty()) {
    const std::size_t end = cookies.find(';');
    std::string_view cookie = cookies.substr(0, end);
    while (cookie.starts_with(' ')) cookie.remove_prefix(1);
    if (cookie.starts_with(kCookie) &&
        equal_in_constant_time(cookie.substr(kCookie.size()), options.token)) {
      return true;
    }
    if (end == std::string_view::npos) break;
    cookies.remove_prefix(end + 1);
  }
  return false;
}

bool safe_method(const Request& request) {
  return request.method == "GET" || request.method == "HEAD" || request.method == "OPTIONS";
}

bool is_json(std::string_view content_type) {
  const std::string type = lower(content_type.substr(0, content_type.find(';')));
  return type == "application/json" || type == "application/json ";
}

}  // namespace

void check_exposure(const ServerOptions& options) {
  boost::system::error_code error;
  boost::asio::ip::make_address(options.address, error);
  if (error) {
    throw ServerError("--listen " + options.address + ": not an address; 127.0.0.1 (this machine) "
                      "and 0.0.0.0 (every network) are the usual ones.");
  }
  if (listens_beyond_loopback(options) && options.token.empty() && !options.insecure) {
    throw ServerError("Listening on " + options.address +
                      " lets anyone on the network drive the robot. Give a --token, or say "
                      "--insecure if that is what you want.");
  }
  if (!options.token.empty() && options.token.size() < 16) {
    throw ServerError("The token is too short: at least 16 characters, best made by "
                      "'openssl rand -hex 16'.");
  }
  if (options.token.find_first_of(" ;,\"\\") != std::string::npos) {
    throw ServerError("The token must not hold spaces, quotes, commas, semicolons or backslashes.");
  }
}

std::optional<Response> refuse(const ServerOptions& options, const Request& request, bool upgrade) {
  const std::string_view host = request.header("Host");
  if (host.empty()) return problem(400, "No Host", "The request has no Host header.");
  if (!host_allowed(options, host_of(host))) {
    return problem(421,
                   "Unknown host",
                   "This server does not go by the name '" + std::string(host) +
                       "'. Start it with --allow-host to add one.");
  }
  const bool api = request.path.starts_with("/api/");
  const bool open = request.path == "/api/v1/healthz" || request.path == kLoginPath;
  const bool authorised = !options.token.empty() && has_token(options, request);
  if (!options.token.empty() && (api || upgrade) && !open && !authorised) {
    return problem(401, "Token needed", "Send 'Authorization: Bearer TOKEN', or log in first.");
  }
  if (upgrade || !safe_method(request)) {
    const std::string_view origin = request.header("Origin");
    const bool trusted = request.loopback || authorised || options.insecure;
    if (origin.empty() ? !trusted : !origin_allowed(options, request, origin)) {
      return problem(403,
                     "Foreign origin",
                     origin.empty() ? "The request has no Origin header."
                                    : "Pages from " + std::string(origin) + " may not do this.");
    }
  }
  const bool changes = !safe_method(request);
  if (changes && !request.body.empty() && !is_json(request.header("Content-Type"))) {
    return problem(
        415, "Not JSON", "A request with a body needs 'Content-Type: application/json'.");
  }
  return std::nullopt;
}

Response login(const ServerOptions& options, const Request& request) {
  std::string given;
  try {
    const nlohmann::json body = parse_json(request.body);
    given = body.at("token").get<std::string>();
  } catch (const std::exception&) {
    return problem(400, "No token", "Send {\"token\": \"...\"}.");
  }
  if (options.token.empty()) return problem(409, "No token", "This server asks for no token.");
  if (!equal_in_constant_time(given, options.token)) {
    return problem(401, "Wrong token", "That is not this server's token.");
  }
  Response response;
  response.status = 204;
  response.headers.emplace_back(
      "Set-Cookie",
      std::string(kCookie) + options.token + "; Path=/; HttpOnly; SameSite=Strict");
  return response;
}

}  // namespace server::net
