// server/serve/session_json.hpp: the state of a session for /state and GET /api/v1/session.
#pragma once

#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include "server/serve/session.hpp"

namespace server {

/// {"ok":true,"trouble":sentence or null} for a goal {"x","y","heading"?} without setting it.
/// Throws DocumentError.
nlohmann::json goal_check_json(Session& session, const nlohmann::json& goal);
/// Submits a request. When the control thread has accepted it, calls `accepted` with {"ok":true},
/// the "id" of a new obstacle, a "warning" about a goal, and for a Stop whether the robot is
/// "standing" already or the stop is only "commanded". Otherwise calls `refused` with the reason.
/// Returns false if the session can take no more now.
bool submit(Session& session,
            algo::Request request,
            std::function<void(const nlohmann::json&)> accepted,
            std::function<void(const std::string&)> refused);
/// The `/state` document (docs/interfaces.md).
nlohmann::json state_json(const Session& session);
/// The `/state` document with the newest tick: pose, clearance, mission, hold and the two
/// sentences.
nlohmann::json session_json(const Session& session);
/// Controllers, filters, physics and parameters by name, with labels and help.
nlohmann::json catalog_json();

}  // namespace server
