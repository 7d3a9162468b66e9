// server/serve/api/run_reply.hpp: what the routes of runs share.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "db/records.hpp"
#include "server/serve/net/http.hpp"

namespace server {

/// The number of the run in the path. Throws DocumentError.
db::RunId run_id(const net::Request& request);

net::Response no_such_run(db::RunId run);

/// Appends `item` to a JSON list.
void append_item(std::string& list, const nlohmann::json& item);

/// {"items":[...],"next":...}, followed by the fields `more`.
net::Response page_response(std::string list,
                            const nlohmann::json& next,
                            const std::string& more = "");

}  // namespace server
