// server/net/access.hpp: who may talk to the server: Host, Origin, token and login cookie.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/net/http.hpp"

namespace server::net {

struct AccessOptions {
  std::string token{};                       // empty: none asked for
  bool insecure = false;                     // beyond loopback without a token
  std::vector<std::string> allow_hosts{};    // "robot.lan" or "robot.lan:8081"
  std::vector<std::string> allow_origins{};  // "https://viewer.example"
  /// API paths that answer without the token, for health checks.
  std::vector<std::string> open_paths{"/api/v1/healthz"};
};

/// Decides about one request from its head alone. The rules, in order of checking:
/// - Host names this server: a loopback name, the address the connection arrived at, or an
///   allowed host (421). A web page can point its own name at 127.0.0.1, but not change Host.
/// - Origin, on upgrades and everything that is not GET, HEAD or OPTIONS: equal to "http://" + Host
///   or listed; absent (not a browser) only from loopback, with the token, or when insecure (403).
/// - Token, where one is set: Bearer or login cookie for /api and every upgrade (401). The page
///   itself is served without, so that it can ask for the token.
class Access {
 public:
  /// Throws std::invalid_argument on a token shorter than 16 characters.
  explicit Access(AccessOptions options);

  /// @param local_address  address of this end of the connection
  /// @param protected_path false for what anyone may read: static files
  /// @return the refusal, or nothing when the request may pass
  std::optional<Response> refuse(const Request& request,
                                 std::string_view local_address,
                                 bool upgrade,
                                 bool protected_path) const;

  bool authorized(const Request& request) const;
  bool token_required() const { return !options_.token.empty(); }

  /// The body of POST /api/v1/login: {"token":"..."}. Right: 204 and a session cookie; wrong: 401.
  Response login(const Request& request);
  static constexpr std::string_view kLoginPath = "/api/v1/login";

 private:
  bool host_allowed(std::string_view host, std::string_view local_address) const;
  bool origin_allowed(const Request& request) const;

  AccessOptions options_;
  std::deque<std::string> sessions_{};  // cookie values given out, the newest kMaxSessions
};

/// Compares in a time that depends on the lengths only.
bool equal_constant_time(std::string_view a, std::string_view b);

/// True for loopback names and addresses: localhost, 127.x.y.z, ::1.
bool is_loopback_name(std::string_view host);

}  // namespace server::net
