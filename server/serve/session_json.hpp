// server/serve/session_json.hpp: the state of a session for /state and GET /api/v1/session.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "server/serve/net/visitor.hpp"
#include "server/serve/session.hpp"

namespace server {

/// {"ok":true,"trouble":sentence or null} for a goal {"x","y","heading"?} without setting it.
/// Throws DocumentError.
nlohmann::json goal_check_json(Session& session, const nlohmann::json& goal);
/// Moves the start to {"x","y","heading"?}. Returns the reason for a refusal. Throws DocumentError.
std::optional<std::string> set_start(Session& session, const nlohmann::json& start);
/// Submits a request. When the control thread has accepted it, calls `accepted` with {"ok":true},
/// the "id" of a new obstacle, a "warning" about a goal, and for a Stop whether the robot is
/// "standing" already or the stop is only "commanded". Otherwise calls `refused` with the reason.
/// `who` gets the credit. Returns false if the session can take no more now.
bool submit(Session& session,
            algo::Request request,
            std::function<void(const nlohmann::json&)> accepted,
            std::function<void(const std::string&)> refused,
            const std::string& who);
/// The role that a request needs: everybody who sees the robot may press Stop.
net::Role needed_for(const algo::Request& request);
/// Pauses the world, or lets it go on, for `who`.
void pause(Session& session, bool paused, const std::string& who);
/// The `/state` document (docs/interfaces.md).
nlohmann::json state_json(const Session& session);
/// The `/state` document with the newest tick: pose, clearance, mission, hold and the two
/// sentences.
nlohmann::json session_json(const Session& session);
/// Controllers, filters, physics and parameters by name, with labels and help.
nlohmann::json catalog_json(const algo::ControllerCatalogue& catalogue);

}  // namespace server
