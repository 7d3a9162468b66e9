// server/serve/control_lease.cpp: the ways of the controls from hand to hand.
#include "server/serve/control_lease.hpp"

#include <algorithm>
#include <random>
#include <utility>

#include <fmt/format.h>

namespace server {
namespace {

/// 128 random bits: nobody guesses the key of another's lease.
std::string new_key() {
  std::random_device source;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", source(), source(), source(), source());
}

}  // namespace

bool ControlLease::holds(const Party& who, std::string_view key) const {
  if (!holder_) return false;
  if (!key.empty()) return key == holder_->key;
  return who.client != Party::kNoClient && who.client == holder_->who.client;
}

ControlLease::Refusal ControlLease::refusal(const Party& who, std::string_view key) const {
  if (!holder_ || holds(who, key)) return std::nullopt;
  return holder_->who.label + " has the controls. Ask for them, or press Stop if you must.";
}

void ControlLease::seat(const Party& who, Time now, std::chrono::seconds patience) {
  std::erase_if(asking_, [&](const Seat& s) {
    return s.who.client == who.client && who.client != Party::kNoClient;
  });
  holder_ = Seat{who, new_key(), now};
  touched_ = now;
  patience_ = patience;
}

ControlLease::Refusal ControlLease::take(const Party& who, bool force, Time now) {
  const bool mine = holds(who);
  if (force && who.role < net::Role::Admin) {
    return net::role_refusal(who.role, net::Role::Admin);
  }
  if (holder_ && !mine && !force && !silent(now)) {
    return fmt::format(
        "{} drives. Ask for the controls; they can be taken once {} has sent nothing for {} s.",
        holder_->who.label,
        holder_->who.label,
        kSilent.count());
  }
  if (mine) {
    touched_ = now;
    patience_ = kForgotten;
  } else {
    seat(who, now, kForgotten);
  }
  return std::nullopt;
}

ControlLease::Refusal ControlLease::take_by_publishing(const Party& who, Time now) {
  if (!holder_) seat(who, now, kPublisher);
  return refusal(who);
}

ControlLease::Refusal ControlLease::ask(const Party& who, Time now) {
  if (!holder_) return "Nobody has the controls: take them.";
  if (holds(who)) return "You have the controls.";
  if (who.client == Party::kNoClient) {
    return "Only a page or another WebSocket client can be given the controls. Take them once they "
           "are free.";
  }
  const auto mine =
      std::ranges::find(asking_, who.client, [](const Seat& s) { return s.who.client; });
  if (mine != asking_.end()) {
    mine->since = now;
  } else if (asking_.size() >= kMostAsking) {
    return "Too many ask for the controls already.";
  } else {
    asking_.push_back({who, {}, now});
  }
  return std::nullopt;
}

ControlLease::Refusal ControlLease::give(std::uint64_t to, Time now) {
  const auto next = std::ranges::find(asking_, to, [](const Seat& s) { return s.who.client; });
  if (next == asking_.end()) return "That client does not ask for the controls, or has gone.";
  seat(Party(next->who), now, kForgotten);
  return std::nullopt;
}

void ControlLease::release() {
  holder_.reset();
  asking_.clear();
}

bool ControlLease::lost(std::uint64_t client) {
  const bool asked =
      std::erase_if(asking_, [&](const Seat& s) { return s.who.client == client; }) > 0;
  if (!holder_ || holder_->who.client != client || client == Party::kNoClient) return asked;
  release();
  return true;
}

bool ControlLease::expire(Time now) {
  const bool forgotten =
      std::erase_if(asking_, [&](const Seat& s) { return now - s.since >= kAsks; }) > 0;
  if (!holder_ || now - touched_ < patience_) return forgotten;
  release();
  return true;
}

}  // namespace server
