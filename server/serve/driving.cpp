// server/serve/driving.cpp: the lease, the link, and the words about them.
#include "server/serve/driving.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "server/run/json_reader.hpp"
#include "server/run/request_json.hpp"
#include "server/serve/credits.hpp"

namespace server {
namespace {

using nlohmann::json;

/// The beginning of `label` that fits, without half a character.
algo::Name short_name(std::string_view label) {
  std::size_t end = std::min(label.size(), algo::Name::kLongest);
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; };
  while (end < label.size() && end > 0 && continues(label[end])) --end;
  return {label.substr(0, end)};
}

/// Takes the fields of a stamp out of the document of a stick.
StickStamp take_stamp(json& body) {
  constexpr double kMostSticks = 9e15;  // whole in a double
  StickStamp stamp;
  const JsonReader in(body, "");
  if (in.has("sequence")) {
    stamp.sequence = static_cast<std::uint64_t>(in.number("sequence", {0, kMostSticks}));
  }
  if (in.has("sent")) stamp.sent = in.number("sent");
  body.erase("sequence");
  body.erase("sent");
  return stamp;
}

void refuse_if(const ControlLease::Refusal& refusal) {
  if (refusal) throw LeaseRefusal(*refusal);
}

void require_holder(const ControlLease& lease, const Sender& sender) {
  if (!lease.holds(sender.who, sender.key)) throw LeaseRefusal("You do not have the controls.");
}

}  // namespace

StampedRequest stamped_request_from_json(Session& session, json body) {
  if (JsonReader(body, "").text("type") != "joystick") return {request_from_json(body), {}};
  try {
    StickStamp stamp = take_stamp(body);
    return {request_from_json(body), stamp};
  } catch (const DocumentError&) {
    session.count_unreadable_stick();
    throw;
  }
}

std::optional<std::string> admit(Session& session, const Sender& sender, StampedRequest& request) {
  if (is_stop(request.request)) return std::nullopt;
  if (auto refusal = admit_deed(session, sender)) return refusal;
  auto* const stick = std::get_if<algo::Joystick>(&request.request);
  if (stick == nullptr) return std::nullopt;
  stick->driver = short_name(sender.who.label);
  return session.judge(sender.who.client, *stick, request.stamp);
}

std::optional<std::string> admit_deed(Session& session, const Sender& sender) {
  ControlLease& lease = session.lease();
  if (auto refusal = lease.refusal(sender.who, sender.key)) return refusal;
  lease.touch(ControlLease::Clock::now());
  return std::nullopt;
}

json lease_action(Session& session, const Sender& sender, const json& body) {
  const JsonReader in(body, "");
  in.only({"action", "force", "to"});
  const std::string action = in.text_or("action", "");
  ControlLease& lease = session.lease();
  const auto now = ControlLease::Clock::now();
  const std::string& who = sender.who.label;
  bool took = false;  // a script shows no key yet
  if (action == "take") {
    const bool force = in.flag_or("force", false);
    if (!lease.holds(sender.who, sender.key)) {
      refuse_if(lease.take(sender.who, force, now));
      took = true;
      session.pass_controls();
      tell_deed(session, who, force ? "takes the controls by force" : "takes the controls");
    }
    lease.touch(now);
  } else if (action == "ask") {
    refuse_if(lease.ask(sender.who, now));
    session.tell();
    tell_deed(session, who, "asks for the controls");
  } else if (action == "give") {
    require_holder(lease, sender);
    refuse_if(lease.give(in.whole("to", UINT32_MAX), now));
    session.pass_controls();
    tell_deed(session, who, "hands the controls over");
  } else if (action == "release") {
    require_holder(lease, sender);
    lease.release();
    session.pass_controls();
    tell_deed(session, who, "gives the controls back");
  } else if (!action.empty()) {
    in.fail("action", fmt::format("'{}' is unknown; known are take, ask, give, release", action));
  }
  json out = {{"ok", true}, {"you", sender.who.client}, {"driving", driving_json(session)}};
  if (took || lease.holds(sender.who, sender.key)) out["key"] = lease.holder()->key;
  return out;
}

json driving_json(const Session& session) {
  const auto party = [](const ControlLease::Seat& seat) {
    return json{{"client", seat.who.client}, {"name", seat.who.label}};
  };
  const ControlLease& lease = session.lease();
  json driver = nullptr;
  if (lease.holder()) {
    driver = party(*lease.holder());
    driver["silent"] = lease.silent(ControlLease::Clock::now());
  }
  json asking = json::array();
  for (const ControlLease::Seat& seat : lease.asking()) asking.push_back(party(seat));
  const DroppedSticks& dropped = session.sticks().dropped();
  return {{"driver", std::move(driver)},
          {"asking", std::move(asking)},
          {"dropped",
           {{"late", dropped.late},
            {"out_of_order", dropped.out_of_order},
            {"barred", dropped.barred},
            {"unreadable", dropped.unreadable}}}};
}

}  // namespace server
