// server/serve/session_json.hpp: what a session is doing, as /state and GET /api/v1/session say it.
#pragma once

#include <nlohmann/json.hpp>

#include "server/serve/session.hpp"

namespace server {

/// {"ok":true,"trouble":sentence or null} for a goal {"x","y","heading"?} that nobody has set yet.
/// Throws DocumentError.
nlohmann::json goal_check_json(Session& session, const nlohmann::json& goal);
/// The answer to a request that was accepted: {"ok":true}, and for a Stop whether the robot is
/// "standing" already or the stop is "commanded" only.
nlohmann::json accepted_json(const Session& session, bool stop);
/// The `/state` document (docs/interfaces.md).
nlohmann::json state_json(const Session& session);
/// The same with the newest tick: pose, clearance, mission, hold and the two sentences.
nlohmann::json session_json(const Session& session);
/// Controllers, filters, physics and parameters by name, with labels and help.
nlohmann::json catalog_json();

}  // namespace server
