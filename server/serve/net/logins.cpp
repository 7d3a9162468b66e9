// server/serve/net/logins.cpp: cookies and guesses, with the clock as an argument.
#include "server/serve/net/logins.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "server/serve/net/secret.hpp"

namespace server::net {

bool equal_constant_time(std::string_view a, std::string_view b) {
  std::size_t difference = a.size() ^ b.size();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char other = b.empty() ? '\0' : b[i % b.size()];
    difference |= static_cast<std::size_t>(static_cast<unsigned char>(a[i]) ^
                                           static_cast<unsigned char>(other));
  }
  return difference == 0;
}

std::string LoginSessions::open(Role role, Clock::time_point now) {
  std::erase_if(sessions_, [&](const auto& entry) { return now - entry.second.used > kIdle; });
  if (sessions_.size() >= kMost) {
    sessions_.erase(
        std::min_element(sessions_.begin(), sessions_.end(), [](const auto& a, const auto& b) {
          return std::tie(a.second.role, a.second.used) < std::tie(b.second.role, b.second.used);
        }));
  }
  std::string id = secret();
  sessions_[id] = {role, now, now};
  return id;
}

LoginSessions::Sessions::iterator LoginSessions::find(std::string_view id, Clock::time_point now) {
  // Compare every cookie in full, so that the time does not reveal how much of a guess was right.
  auto found = sessions_.end();
  for (auto it = sessions_.begin(); it != sessions_.end(); ++it) {
    if (equal_constant_time(it->first, id) && now - it->second.used <= kIdle) found = it;
  }
  return found;
}

std::optional<Role> LoginSessions::use(std::string_view id, Clock::time_point now) {
  if (id.empty()) return std::nullopt;
  const auto session = find(id, now);
  if (session == sessions_.end()) return std::nullopt;
  session->second.used = now;
  return session->second.role;
}

void LoginSessions::keep(std::string_view id, Clock::time_point now) {
  const auto session = sessions_.find(id);
  if (session != sessions_.end()) session->second.used = now;
}

bool LoginSessions::renew(std::string_view id, Clock::time_point now) {
  if (id.empty()) return false;
  const auto session = find(id, now);
  if (session == sessions_.end() || now - session->second.given < kRenewal) return false;
  session->second.given = now;
  return true;
}

void LoginSessions::close(std::string_view id) {
  std::erase_if(sessions_, [&](const auto& entry) { return equal_constant_time(entry.first, id); });
}

double Bucket::left(Clock::time_point now) const {
  const double passed = std::chrono::duration<double>(now - at_).count();
  return std::min(most_, left_ + std::max(0.0, passed) * per_second_);
}

bool Bucket::take(Clock::time_point now) {
  left_ = left(now);
  at_ = std::max(at_, now);
  if (left_ < 1) return false;
  left_ -= 1;
  return true;
}

std::chrono::seconds Bucket::wait(Clock::time_point now) const {
  const double seconds = std::max(0.0, 1 - left(now)) / per_second_;
  return std::chrono::seconds(static_cast<std::int64_t>(std::ceil(seconds)));
}

/// Removes addresses that have all their guesses again: they are like new ones.
void GuessThrottle::forget_the_patient(Clock::time_point now) {
  std::erase_if(accounts_, [&](const auto& entry) { return entry.second.guesses.full(now); });
}

GuessThrottle::Account& GuessThrottle::account(const Address& from, Clock::time_point now) {
  const Address visitor = from.visitor();
  const auto found = accounts_.find(visitor);
  if (found != accounts_.end()) return found->second;
  if (accounts_.size() >= kAddresses && now - forgotten_ >= std::chrono::seconds(1)) {
    forgotten_ = now;
    forget_the_patient(now);
  }
  if (accounts_.size() >= kAddresses) return others_;
  return accounts_.emplace(visitor, Account(now)).first->second;
}

bool GuessThrottle::may_look(const Address& from, Clock::time_point now) {
  const auto found = accounts_.find(from.visitor());
  return found == accounts_.end() || found->second.looks.wait(now).count() == 0;
}

GuessThrottle::Verdict GuessThrottle::wrong(const Address& from, Clock::time_point now) {
  Account& guesser = account(from, now);
  guesser.looks.take(now);
  ++guesser.untold;
  Verdict verdict;
  if (!guesser.guesses.take(now)) {
    verdict.wait = std::max(std::chrono::seconds(1), guesser.guesses.wait(now));
  }
  verdict.line = line_of(guesser, from, now);
  return verdict;
}

std::string GuessThrottle::line_of(Account& guesser, const Address& from, Clock::time_point now) {
  if (guesser.told && now - *guesser.told < kLinePeriod) return {};
  if (!lines_.take(now)) return {};
  guesser.told = now;
  const std::size_t count = std::exchange(guesser.untold, 0);
  return count == 1 ? fmt::format("A wrong token came from {}.", from.text())
                    : fmt::format("{} wrong tokens came from {}.", count, from.text());
}

std::string GuessThrottle::overdue(Clock::time_point now) {
  for (auto& [address, account] : accounts_) {
    if (account.untold == 0) continue;
    std::string line = line_of(account, address, now);
    if (!line.empty()) return line;
  }
  return {};
}

std::string GuessThrottle::right(const Address& from, Role role, Clock::time_point now) {
  if (!lines_.take(now)) return {};
  return fmt::format("Somebody at {} has logged in as {}.", from.text(), name(role));
}

}  // namespace server::net
