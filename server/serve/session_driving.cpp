// server/serve/session_driving.cpp: the drivers of a session: who has the controls, and how good
// the links are.
#include <utility>

#include "server/serve/session.hpp"

namespace server {

void Session::client_came(std::uint64_t client) {
  sticks_.connected(client, StickWatch::Clock::now());
}

void Session::client_gone(std::uint64_t client) {
  watch_.page_gone(client);
  sticks_.gone(client);
  after([&] { return lease_.lost(client); });
}

/// Does what may end the lease or a question; tells the clients if it did.
void Session::after(const std::function<bool()>& end) {
  const bool held = lease_.holder().has_value();
  if (!end()) return;
  if (held && !lease_.holder()) {
    log(LogLevel::Info, "The controls are free: their holder has left them.");
    pass_controls();
  } else {
    changed();
  }
}

void Session::pass_controls() {
  if (!state_.asked.stick.centred()) submit(algo::Joystick{}, {});
  changed();
}

std::optional<std::string> Session::judge(std::uint64_t client,
                                          const algo::Joystick& stick,
                                          const StickStamp& stamp) {
  const DroppedSticks before = sticks_.dropped();
  auto refusal = sticks_.refusal(client, stick, stamp, StickWatch::Clock::now());
  if (sticks_.dropped() != before) changed();
  return refusal;
}

void Session::count_unreadable_stick() {
  sticks_.count_unreadable();
  changed();
}

void Session::watch_lease() {
  const auto now = ControlLease::Clock::now();
  after([&] { return lease_.expire(now); });
  const bool silent = lease_.silent(now);
  if (std::exchange(told_silent_, silent) != silent) changed();
}

}  // namespace server
