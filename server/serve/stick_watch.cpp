// server/serve/stick_watch.cpp: age, order, and the middle.
#include "server/serve/stick_watch.hpp"

#include <utility>

#include <fmt/format.h>

namespace server {

double clock_seconds(StickWatch::Time now) {
  return std::chrono::duration<double>(now.time_since_epoch()).count();
}

std::optional<std::string> StickWatch::late(const StickStamp& stamp, Time now) {
  if (!stamp.sent) return std::nullopt;
  const double age = clock_seconds(now) - *stamp.sent;
  if (age >= -kClockError && age <= kOldest) return std::nullopt;
  ++dropped_.late;
  if (age < 0) {
    return fmt::format("The stick says that it was sent in {:.1f} s: measure the clock again.",
                       -age);
  }
  return fmt::format(
      "The stick is {:.1f} s old: none older than {:.1f} s is obeyed.", age, kOldest);
}

std::optional<std::string> StickWatch::refusal(std::uint64_t client,
                                               const algo::Joystick& stick,
                                               const StickStamp& stamp,
                                               Time now) {
  auto why = late(stamp, now);
  const auto found = links_.find(client);
  if (found == links_.end()) return why;
  Link& link = found->second;
  if (!why && stamp.sequence && link.newest && *stamp.sequence <= *link.newest) {
    ++dropped_.out_of_order;
    return "A newer stick has come already.";
  }
  if (why) {
    link.barred = true;
  } else if (stick.centred() || (link.barred && now - link.heard >= kSilence)) {
    link.barred = false;
  }
  if (!why && stamp.sequence) link.newest = stamp.sequence;
  if (!stick.centred()) link.heard = now;
  if (!why && link.barred) {
    ++dropped_.barred;
    why = "Let go of the stick first: it is obeyed after it has been in the middle.";
  }
  return why;
}

}  // namespace server
