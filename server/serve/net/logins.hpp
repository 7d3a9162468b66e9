// server/serve/net/logins.hpp: who has logged in, and who guesses at the token.
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

namespace server::net {

/// Compares in a time that depends on the lengths only.
bool equal_constant_time(std::string_view a, std::string_view b);

/// The cookies given out. One that is not used for kIdle opens nothing any more; an open WebSocket
/// uses its own.
class LoginSessions {
 public:
  static constexpr std::chrono::hours kIdle{12};
  /// How long a browser keeps the cookie, and how often one in use is given afresh.
  static constexpr std::chrono::hours kCookieLife{7 * 24};
  static constexpr std::chrono::hours kRenewal{24};

  /// A new one; the one used longest ago goes when there are kMost.
  std::string open(Clock::time_point now);
  /// True, and counted as used, when `id` is one of them.
  bool use(std::string_view id, Clock::time_point now);
  /// Counts one of ours as used: something opened with it is still open.
  void keep(std::string_view id, Clock::time_point now);
  /// True, once, when the browser is to be given this cookie's life afresh.
  bool renew(std::string_view id, Clock::time_point now);
  void close(std::string_view id);
  std::size_t size() const { return sessions_.size(); }

 private:
  static constexpr std::size_t kMost = 64;
  struct Session {
    Clock::time_point used{};
    Clock::time_point given{};
  };
  using Sessions = std::map<std::string, Session, std::less<>>;
  Sessions::iterator find(std::string_view id, Clock::time_point now);

  Sessions sessions_{};
};

/// A bucket of `most` that fills with `per_second`.
class Bucket {
 public:
  Bucket(double most, double per_second, Clock::time_point now)
      : most_(most), per_second_(per_second), left_(most), at_(now) {}
  /// Takes one; false when there is none.
  bool take(Clock::time_point now);
  /// Time until there is one.
  std::chrono::seconds wait(Clock::time_point now) const;
  bool full(Clock::time_point now) const { return left(now) >= most_; }

 private:
  double left(Clock::time_point now) const;
  double most_;
  double per_second_;
  double left_;
  Clock::time_point at_;
};

/// Wrong guesses at the token, by address. An address that has used up its guesses is told to wait.
/// The right token passes all the same, so that a neighbour behind the same router or proxy is not
/// locked out by them; only an address that guesses faster than a person can is not looked at.
class GuessThrottle {
 public:
  static constexpr double kGuesses = 10;            // at once
  static constexpr double kGuessesPerSecond = 0.2;  // in the long run
  static constexpr double kLooks = 50;              // wrong tokens looked at, at once
  static constexpr double kLooksPerSecond = 10;
  /// Addresses kept apart; more of them at once share one account.
  static constexpr std::size_t kAddresses = 4096;

  explicit GuessThrottle(Clock::time_point now) : others_(now), lines_(20, 0.2, now) {}

  struct Verdict {
    std::optional<std::chrono::seconds> wait{};  // to be told, with 429; none: 401
    std::string line{};                          // for the log, without the token; often empty
  };
  /// False when a token from `from` is not to be looked at just now.
  bool may_look(const Address& from, Clock::time_point now);
  /// A wrong token came from `from`, or one that was not looked at.
  Verdict wrong(const Address& from, Clock::time_point now);
  /// The line for a login that succeeded.
  std::string right(const Address& from, Clock::time_point now);
  /// A line for guesses not told of yet, for when there are no more; empty when there is none.
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

  static constexpr std::chrono::seconds kLinePeriod{60};  // of one address

  std::map<Address, Account> accounts_{};
  Account others_;
  Clock::time_point forgotten_{};  // when addresses were last forgotten to make room
  Bucket lines_;                   // of the log, for all addresses together
};

}  // namespace server::net
