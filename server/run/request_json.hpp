// server/run/request_json.hpp: a client's requests to a session as JSON (docs/interfaces.md).
#pragma once

#include <nlohmann/json.hpp>

#include "algo/request.hpp"

namespace server {

/// Reads {"type":"set_goal","x":1,"y":2} and the like. Throws DocumentError.
algo::Request request_from_json(const nlohmann::json& value);

/// True for a Stop that engages, false for its release and for anything else.
bool is_stop(const algo::Request& request);

}  // namespace server
