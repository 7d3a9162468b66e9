// server/serve/net/logins.hpp: tracks logins, and guesses at the token.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "server/serve/net/address.hpp"
#include "server/serve/net/clock.hpp"
#include "server/serve/net/visitor.hpp"

namespace server::net {

/// Compares in a time that depends only on the lengths.
bool equal_constant_time(std::string_view a, std::string_view b);

/// The issued cookies. A cookie expires if unused for kIdle; an open WebSocket counts as use of its
/// own.
class LoginSessions {
 public:
  static constexpr std::chrono::hours kIdle{12};
  /// How long a browser keeps the cookie, and how often a cookie in use is renewed.
  static constexpr std::chrono::hours kCookieLife{7 * 24};
  static constexpr std::chrono::hours kRenewal{24};

  /// Issues a new cookie. At kMost cookies, drops the least recently used one of the lowest role:
  /// any number of viewers leaves the operators logged in.
  std::string open(Role role, Clock::time_point now);
  /// The role of a valid cookie; counts as use.
  std::optional<Role> use(std::string_view id, Clock::time_point now);
  /// Counts a valid cookie as used: a connection opened with it is still open.
  void keep(std::string_view id, Clock::time_point now);
  /// True, once, when the browser must get this cookie with a new lifetime.
  bool renew(std::string_view id, Clock::time_point now);
  void close(std::string_view id);
  std::size_t size() const { return sessions_.size(); }

 private:
  static constexpr std::size_t kMost = 256;
  struct Session {
    Role role = Role::Viewer;
    Clock::time_point used{};
    Clock::time_point given{};
  };
  using Sessions = std::map<std::string, Session, std::less<>>;
  Sessions::iterator find(std::string_view id, Clock::time_point now);

  Sessions sessions_{};
};

/// A token bucket of `most` that fills with `per_second`.
class Bucket {
 public:
  Bucket(double most, double per_second, Clock::time_point now)
      : most_(most), per_second_(per_second), left_(most), at_(now) {}
  /// Takes one; false if the bucket is empty.
  bool take(Clock::time_point now);
  /// Time until one is available.
  std::chrono::seconds wait(Clock::time_point now) const;
  bool full(Clock::time_point now) const { return left(now) >= most_; }

 private:
  double left(Clock::time_point now) const;
  double most_;
  double per_second_;
  double left_;
  Clock::time_point at_;
};

/// Counts wrong guesses at the token by address. An address that has used up its guesses is told to
/// wait. The right token still passes, so that a neighbour behind the same router or proxy is not
/// locked out. Only tokens from an address that guesses faster than a person can are not checked.
class GuessThrottle {
 public:
  static constexpr double kGuesses = 10;            // at once
  static constexpr double kGuessesPerSecond = 0.2;  // in the long run
  static constexpr double kLooks = 50;              // wrong tokens checked, at once
  static constexpr double kLooksPerSecond = 10;
  /// Addresses with their own account; further ones share one account.
  static constexpr std::size_t kAddresses = 4096;

  explicit GuessThrottle(Clock::time_point now) : others_(now), lines_(20, 0.2, now) {}

  struct Verdict {
    std::optional<std::chrono::seconds> wait{};  // sent with 429; none: 401
    std::string line{};                          // for the log, without the token; may be empty
  };
  /// False if a token from `from` must not be checked now.
  bool may_look(const Address& from, Clock::time_point now);
  /// Counts a wrong or unchecked token from `from`.
  Verdict wrong(const Address& from, Clock::time_point now);
  /// The log line for a successful login.
  std::string right(const Address& from, Role role, Clock::time_point now);
  /// A log line for guesses not yet logged, for when guessing has stopped; empty if there are none.
  std::string overdue(Clock::time_point now);
  std::size_t addresses() const { return accounts_.size(); }

 private:
  struct Account {
    explicit Account(Clock::time_point now)
        : guesses(kGuesses, kGuessesPerSecond, now), looks(kLooks, kLooksPerSecond, now) {}
    Bucket guesses;
    Bucket looks;
    std::size_t untold = 0;  // guesses since the last line
    std::optional<Clock::time_point> told{};
  };
  Account& account(const Address& from, Clock::time_point now);
  void forget_the_patient(Clock::time_point now);
  std::string line_of(Account& account, const Address& from, Clock::time_point now);

  static constexpr std::chrono::seconds kLinePeriod{60};  // between lines of one address

  std::map<Address, Account> accounts_{};
  Account others_;
  Clock::time_point forgotten_{};  // when addresses were last removed to make room
  Bucket lines_;                   // log lines of all addresses together
};

}  // namespace server::net
