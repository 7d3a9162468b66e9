// server/serve/driving.hpp: admits what people ask of a robot: only its driver controls it, over a
// link that works.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "algo/request.hpp"
#include "server/serve/session.hpp"

namespace server {

/// The controls do not change hands: what() says why.
class LeaseRefusal final : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Who sends a request, and the key of a lease that it shows; empty: none.
struct Sender {
  Party who{};
  std::string key{};
};

/// A request as a client sends it.
struct StampedRequest {
  algo::Request request{};
  StickStamp stamp{};
};
/// As request_from_json(); a joystick may also have "sequence" and "sent". Throws DocumentError; of
/// a joystick, the session counts it.
StampedRequest stamped_request_from_json(Session& session, nlohmann::json body);

/// Why `request` is not carried out now, as a sentence: somebody else drives, or the stick is late,
/// out of order or barred. Never refuses a Stop. Otherwise notes that the driver lives, and writes
/// its name into a stick.
std::optional<std::string> admit(Session& session, const Sender& sender, StampedRequest& request);
/// The same for what is no request: a reset, a load, the pace, the motors.
std::optional<std::string> admit_deed(Session& session, const Sender& sender);

/// Carries out {"action": "take", "force"?} or "ask", "give" with "to", "release"; without an
/// action it only tells. Returns {"ok", "you", "key"?, "driving"}. Throws DocumentError or
/// LeaseRefusal.
nlohmann::json lease_action(Session& session, const Sender& sender, const nlohmann::json& body);
/// The field `driving` of /state: who drives, who asks, and the sticks that were dropped.
nlohmann::json driving_json(const Session& session);

}  // namespace server
