// server/serve/net/access.cpp: Host, Origin and token rules, without a socket.
#include "server/serve/net/access.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "server/run/json_limits.hpp"
#include "server/serve/net/secret.hpp"

namespace server::net {
namespace {

bool reads(const Request& request) {
  return request.method == "GET" || request.method == "HEAD" || request.method == "OPTIONS";
}

constexpr std::size_t kMinToken = 16;
constexpr std::string_view kHttp = "http://";
constexpr std::string_view kHttps = "https://";

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

/// A browser omits the default port in both Host and Origin; other clients may not.
std::string with_port(std::string_view authority, std::string_view default_port) {
  const HostPort parts = split_host(authority);
  const std::string_view port = parts.port.empty() ? default_port : parts.port;
  return std::string(parts.host).append(":").append(port);
}

std::string_view bearer(const Request& request) {
  const std::string_view value = request.header("Authorization");
  constexpr std::string_view kScheme = "Bearer ";
  if (value.size() <= kScheme.size() || !equal_no_case(value.substr(0, kScheme.size()), kScheme)) {
    return {};
  }
  return value.substr(kScheme.size());
}

Address address_of(const Request& request) {
  return Address::parse(request.peer).value_or(Address());
}

/// The browser sends this cookie only to this server and shows it to no script. If the connection
/// was encrypted, it sends the cookie only over encrypted ones.
Header cookie_header(const Request& request, std::string_view id, std::chrono::seconds life) {
  // An accepted origin also shows encryption: an encrypting proxy need not be a trusted one.
  const std::string_view origin = request.header("Origin");
  const bool https = request.https || equal_no_case(origin.substr(0, kHttps.size()), kHttps);
  return {"Set-Cookie",
          std::string(Access::kCookie) + '=' + std::string(id) +
              "; Path=/; Max-Age=" + std::to_string(life.count()) + "; HttpOnly; SameSite=Strict" +
              (https ? "; Secure" : "")};
}

Response too_many_guesses(std::chrono::seconds wait) {
  Response response = problem(429, "too many wrong tokens came from this address; wait a little");
  response.headers.push_back({"Retry-After", std::to_string(wait.count())});
  return response;
}

}  // namespace

bool is_loopback_name(std::string_view host) {
  if (equal_no_case(host, "localhost") || host == "::1") return true;
  // Only the dotted form: "127.0.0.1.example" may be a real domain.
  return host.substr(0, 4) == "127." && std::all_of(host.begin(), host.end(), [](char c) {
           return c == '.' || (c >= '0' && c <= '9');
         });
}

Access::Access(AccessOptions options, Log log)
    : options_(std::move(options)), log_(std::move(log)), proxies_(options_.trusted_proxies) {
  check_tokens();
  if (token_required() && options_.viewer_token.empty()) options_.viewer_token = secret();
}

void Access::check_tokens() const {
  const auto& [token, operators, viewers] =
      std::tie(options_.token, options_.operator_token, options_.viewer_token);
  for (const std::string* given : {&token, &operators, &viewers}) {
    if (given->empty() || given->size() >= kMinToken) continue;
    throw std::invalid_argument("the token has " + std::to_string(given->size()) +
                                " characters; give it at least " + std::to_string(kMinToken));
  }
  if (token.empty() && !(operators.empty() && viewers.empty())) {
    throw std::invalid_argument(
        "a token of viewers or operators needs one of admins as well: give --token");
  }
  const bool equal = (!operators.empty() && (operators == token || operators == viewers)) ||
                     (!viewers.empty() && viewers == token);
  if (equal) throw std::invalid_argument("two roles have the same token; give each its own");
}

/// Compares with every token, so that the time does not tell which one was nearly right.
Role Access::role_of(std::string_view token) const {
  Role role = Role::Nobody;
  const auto compare = [&](const std::string& with, Role gives) {
    if (!with.empty() && equal_constant_time(token, with)) role = gives;
  };
  compare(options_.viewer_token, Role::Viewer);
  compare(options_.operator_token, Role::Operator);
  compare(options_.token, Role::Admin);
  return role;
}

bool Access::host_allowed(std::string_view host, std::string_view local_address) const {
  const HostPort parts = split_host(host);
  if (parts.host.empty()) return false;
  if (is_loopback_name(parts.host) || parts.host == local_address) return true;
  return std::any_of(options_.allow_hosts.begin(), options_.allow_hosts.end(), [&](const auto& a) {
    return equal_no_case(a, host) || equal_no_case(a, parts.host);
  });
}

bool Access::origin_allowed(const Request& request, bool login, bool authorized) const {
  if (request.count("Origin") > 1) return false;
  if (request.count("Origin") == 0) {
    // Not a browser. A client with the token may log in too.
    return request.loopback || options_.insecure || (token_required() && (login || authorized));
  }
  const std::string_view origin = request.header("Origin");
  const auto& list = options_.allow_origins;
  if (std::any_of(
          list.begin(), list.end(), [&](const auto& o) { return equal_no_case(o, origin); })) {
    return true;
  }
  const std::string_view scheme = request.https ? kHttps : kHttp;
  const std::string_view port = request.https ? "443" : "80";
  if (!equal_no_case(origin.substr(0, scheme.size()), scheme)) return false;
  return equal_no_case(with_port(origin.substr(scheme.size()), port),
                       with_port(request.header("Host"), port));
}

/// Names the missing option if a proxy encrypts for this server.
Response Access::foreign_origin(const Request& request) const {
  const std::string origin{request.header("Origin")};
  const bool encrypted = !request.https && equal_no_case(origin.substr(0, kHttps.size()), kHttps);
  return problem(403,
                 "requests from the origin '" + origin +
                     "' are not taken; the page must come from this server or an allowed origin" +
                     (encrypted ? ". Behind a proxy that encrypts, start the server with "
                                  "--trusted-proxy and the proxy's address"
                                : ""));
}

void Access::identify(Request& request, const Address& peer) const {
  const Sender sender = proxies_.sender(peer, request);
  request.peer = sender.address.text();
  request.loopback = sender.loopback;
  request.https = sender.https;
  const auto name = percent_decode(request.header(kNameHeader), false);
  request.person = clean_name(name.value_or(""));
}

void Access::log(const std::string& line) const {
  if (log_ && !line.empty()) log_(line);
}

Access::Presented Access::look_at(std::string_view token,
                                  const Address& from,
                                  Clock::time_point now) {
  const Role role = guesses_.may_look(from, now) ? role_of(token) : Role::Nobody;
  if (role != Role::Nobody) return {role};
  const GuessThrottle::Verdict verdict = guesses_.wrong(from, now);
  log(verdict.line);
  return {Role::Nobody, verdict.wait};
}

/// A cookie is random and long: an invalid one is old, not a guess.
Access::Presented Access::look_at(const Request& request, Clock::time_point now) {
  if (!token_required()) return {Role::Admin};
  const std::string_view token = bearer(request);
  if (const auto role = logins_.use(request.cookie(kCookie), now); role && token.empty()) {
    return {*role};
  }
  if (token.empty()) return {};
  return look_at(token, address_of(request), now);
}

bool Access::needs_token(const Request& request) const {
  const auto& open = options_.open_paths;
  return request.path != kLoginPath && request.path != kLogoutPath &&
         std::find(open.begin(), open.end(), request.path) == open.end();
}

bool Access::may_drive(const Request& request, bool upgrade, bool api) const {
  return (upgrade || (api && !reads(request))) && needs_token(request);
}

std::optional<Response> Access::refuse(Request& request,
                                       std::string_view local_address,
                                       bool upgrade,
                                       bool protected_path,
                                       Clock::time_point now) {
  if (request.count("Host") != 1) {
    return problem(400, "a request needs exactly one Host header");
  }
  const std::string host{request.header("Host")};
  if (!host_allowed(host, local_address)) {
    return problem(421,
                   "this server does not go by the name '" + host +
                       "'; start it with --allow-host " + host + " if it should");
  }
  const bool login = request.path == kLoginPath || request.path == kLogoutPath;
  const bool asks = (protected_path || upgrade) && needs_token(request);
  const Presented presented = asks ? look_at(request, now) : Presented{};
  const bool authorized = presented.role != Role::Nobody;
  request.role = presented.role;
  if (presented.wait) return too_many_guesses(*presented.wait);
  const bool browser = request.count("Origin") > 0;
  if ((upgrade || !reads(request)) && (browser || !token_required() || !asks || authorized) &&
      !origin_allowed(request, login, authorized)) {
    return foreign_origin(request);
  }
  if (asks && !authorized) {
    Response response = problem(
        401, "this server wants its token, as 'Authorization: Bearer' or by a login of the page");
    response.headers.push_back({"WWW-Authenticate", "Bearer"});
    return response;
  }
  return std::nullopt;
}

Response Access::login(const Request& request, Clock::time_point now) {
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
  const Address from = address_of(request);
  const Presented presented = look_at(token, from, now);
  if (presented.wait) return too_many_guesses(*presented.wait);
  if (presented.role == Role::Nobody) return problem(401, "that is not the token");
  log(guesses_.right(from, presented.role, now));
  Response response = text_response(204, "", "");
  response.headers.push_back(
      cookie_header(request, logins_.open(presented.role, now), LoginSessions::kCookieLife));
  return response;
}

Response Access::logout(const Request& request) {
  logins_.close(request.cookie(kCookie));
  Response response = text_response(204, "", "");
  response.headers.push_back(cookie_header(request, "", std::chrono::seconds(0)));
  return response;
}

std::string Access::login_of(const Request& request, Clock::time_point now) {
  const std::string_view id = request.cookie(kCookie);
  return logins_.use(id, now) ? std::string(id) : std::string();
}

std::optional<Header> Access::renewal(const Request& request, Clock::time_point now) {
  const std::string_view id = request.cookie(kCookie);
  if (!logins_.renew(id, now)) return std::nullopt;
  return cookie_header(request, id, LoginSessions::kCookieLife);
}

void Access::sweep(Clock::time_point now) {
  log(guesses_.overdue(now));
}

}  // namespace server::net
