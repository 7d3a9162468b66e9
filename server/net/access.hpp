// server/net/access.hpp: who may talk to the server: Host, Origin, token (web security checklist).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/net/http.hpp"
#include "server/net/server.hpp"

namespace server::net {

/// Throws ServerError when these options would open the robot to a network without a word.
void check_exposure(const ServerOptions& options);

/// The refusal of `request`, or nothing when it may pass: 421 for a foreign Host, 403 for a foreign
/// Origin, 401 without the token, 415 for a body that is not JSON. `upgrade`: it asks for /ws.
std::optional<Response> refuse(const ServerOptions& options, const Request& request, bool upgrade);

/// POST /api/v1/login {"token"}: a cookie for browsers, which cannot send headers on a WebSocket.
Response login(const ServerOptions& options, const Request& request);

}  // namespace server::net
