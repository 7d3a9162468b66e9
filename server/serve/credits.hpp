// server/serve/credits.hpp: who did what last in a session, for the others to read.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "algo/request.hpp"

namespace server {

class Session;

/// Names, or addresses, of visitors (net::Visitor::label()); empty: nobody, such as the scenario's
/// own goal. What no longer holds is not cleared: by_json() leaves it out.
struct Credits {
  std::string goal{};
  std::string stop{};
  std::string pause{};
  std::string arming{};  // or disarming
};

/// Notes that `who` had an accepted `request` made, and tells the session's log if others want to
/// know. Call it before the session's clients are told of the change.
void credit(Session& session, const algo::Request& request, const std::string& who);
/// The same of something that is no request: "paused the world".
void tell_deed(const Session& session, const std::string& who, const std::string& deed);

/// The field `by` of /state: a name, or null, for each of goal, stop, pause and arming.
nlohmann::json by_json(const Session& session);

}  // namespace server
