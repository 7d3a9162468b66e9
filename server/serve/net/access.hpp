// server/serve/net/access.hpp: access control by Host, Origin, token and login cookie.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/serve/net/http.hpp"
#include "server/serve/net/logins.hpp"
#include "server/serve/net/proxy.hpp"

namespace server::net {

struct AccessOptions {
  std::string token{};                         // of admins; empty: no token required
  std::string operator_token{};                // empty: operators need the one above
  std::string viewer_token{};                  // empty: made at the start, for view-only links
  bool insecure = false;                       // allows access beyond loopback without a token
  std::vector<std::string> allow_hosts{};      // "robot.lan" or "robot.lan:8081"
  std::vector<std::string> allow_origins{};    // "https://viewer.example"
  std::vector<std::string> trusted_proxies{};  // "127.0.0.1", "172.17.0.0/16"
  /// API paths that need no token, for health checks.
  std::vector<std::string> open_paths{"/api/v1/healthz"};
};

/// Judges a request by its head alone. The rules, in order of checking:
/// - Host names this server: a loopback name, the address the connection arrived at, or an
///   allowed host (421). A web page can point its own name at 127.0.0.1, but not change Host.
/// - Origin, on upgrades and everything that is not GET, HEAD or OPTIONS: equal to the scheme the
///   client uses + "://" + Host, or listed; absent (not a browser) only from loopback, for a login,
///   with the token, or if insecure (403).
/// - Token, if one is set: Bearer or login cookie for /api and every upgrade (401; 429 for an
///   address that has guessed too often). The page itself needs no token, so that it can ask for
///   one.
class Access {
 public:
  using Log = std::function<void(std::string_view)>;

  /// Throws std::invalid_argument on tokens that are too short, equal or without an admin's, or a
  /// proxy that is no address. `log` gets logins and guesses.
  explicit Access(AccessOptions options, Log log = {});

  /// Fills in the request's peer, loopback and https from its sender, as seen from this connection,
  /// and the name that the person gave.
  void identify(Request& request, const Address& peer) const;
  bool is_proxy(const Address& peer) const { return proxies_.contains(peer); }

  /// @param local_address  address of this end of the connection
  /// @param protected_path false for static files, which anyone may read
  /// @return the refusal, or nothing if the request may pass: then its role is filled in
  std::optional<Response> refuse(Request& request,
                                 std::string_view local_address,
                                 bool upgrade,
                                 bool protected_path,
                                 Clock::time_point now);

  /// True if a passing request comes from a client that may drive, and does: not from a visitor who
  /// only watches, logs in or asks for the health.
  bool may_drive(const Request& request, bool upgrade, bool api) const;

  bool token_required() const { return !options_.token.empty(); }
  /// The token that signs a person in as a viewer; empty if no token is required.
  const std::string& viewer_token() const { return options_.viewer_token; }

  /// The body of POST /api/v1/login: {"token":"..."}. A right token gives 204 and a cookie, a wrong
  /// one 401, or 429 after too many.
  Response login(const Request& request, Clock::time_point now);
  /// Ends the login of the request's cookie: 204, and the cookie is withdrawn.
  Response logout(const Request& request);
  static constexpr std::string_view kLoginPath = "/api/v1/login";
  static constexpr std::string_view kLogoutPath = "/api/v1/logout";
  static constexpr std::string_view kCookie = "tautline_session";
  /// The header with a person's name, percent-encoded; an upgrade has it in its query, as `name`.
  static constexpr std::string_view kNameHeader = "X-Tautline-Name";

  /// The login of the request's cookie, counted as used; empty for none.
  std::string login_of(const Request& request, Clock::time_point now);
  /// Counts a login as used: a connection opened with it is still open.
  void keep_login(std::string_view id, Clock::time_point now) { logins_.keep(id, now); }
  /// A header that renews the request's cookie, if that is due.
  std::optional<Header> renewal(const Request& request, Clock::time_point now);
  /// Call it at intervals: logs guesses not logged yet.
  void sweep(Clock::time_point now);

 private:
  struct Presented {
    Role role = Role::Nobody;
    std::optional<std::chrono::seconds> wait{};  // for a wrong token sent too often
  };

  void check_tokens() const;
  Role role_of(std::string_view token) const;
  bool needs_token(const Request& request) const;
  bool host_allowed(std::string_view host, std::string_view local_address) const;
  bool origin_allowed(const Request& request, bool login, bool authorized) const;
  Response foreign_origin(const Request& request) const;
  Presented look_at(const Request& request, Clock::time_point now);
  Presented look_at(std::string_view token, const Address& from, Clock::time_point now);
  void log(const std::string& line) const;

  AccessOptions options_;
  Log log_;
  TrustedProxies proxies_;
  LoginSessions logins_{};
  GuessThrottle guesses_{Clock::now()};
};

/// True for loopback names and addresses: localhost, 127.x.y.z, ::1.
bool is_loopback_name(std::string_view host);

}  // namespace server::net
