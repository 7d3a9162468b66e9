// server/serve/api/system_routes.cpp: who asks, and how the server is doing: storage, limits,
// clients, log.
#include <string>

#include "server/record/run_json.hpp"
#include "server/run/paths.hpp"
#include "server/run/version.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/api/reply.hpp"

namespace server {
namespace {

using nlohmann::json;

json me_json(ApiContext& context, const net::Request& request) {
  const net::Visitor who = request.visitor();
  return {{"role", net::name(who.role)},
          {"name", who.name},
          {"address", who.address},
          {"label", who.label()},
          {"token_required", context.server->access().token_required()},
          {"signed_in", !request.cookie(net::Access::kCookie).empty()}};
}

json limits_json(ApiContext& context) {
  const SessionRules& rules = context.sessions.rules();
  return {
      {"sessions", {{"open", context.sessions.all().size() - 1}, {"most", rules.sessions}}},
      {"session_runs", rules.runs},
      {"session_idle", rules.idle.count()},
      {"connections",
       {{"open", context.server->connections()}, {"most", context.server->most_connections()}}}};
}

json client_json(const SessionClient& client) {
  const net::WsClient& socket = *client.socket;
  const net::WsCounters counters = socket.counters();
  return {{"id", socket.id()},
          {"role", net::name(socket.who().role)},
          {"name", socket.who().name},
          {"address", socket.who().address},
          {"session", client.session},
          {"since", client.since},
          {"messages", counters.sent_messages},
          {"bytes", counters.sent_bytes},
          {"dropped", counters.dropped_messages}};
}

/// Addresses and log lines are for people who have shown a token, or sit at this machine: where no
/// token is required, everybody is an admin.
bool known(ApiContext& context, const net::Request& request) {
  return context.server->access().token_required() || request.loopback;
}

/// What a visitor may not see is null.
json system_json(ApiContext& context, const net::Request& request) {
  const std::vector<SessionClient> clients = context.sessions.clients();
  json out = {{"version", kVersion},
              {"api", 1},
              {"started", context.started},
              {"storage", to_json(context.recorder.status())},
              {"limits", limits_json(context)},
              {"viewers", clients.size()},
              {"clients", nullptr},
              {"log", nullptr}};
  if (request.role >= net::Role::Admin && known(context, request)) {
    out["clients"] = json::array();
    for (const SessionClient& client : clients) out["clients"].push_back(client_json(client));
  }
  if (request.role >= net::Role::Operator && known(context, request)) {
    out["log"] = json::array();
    if (context.log_tail) {
      for (const std::string& line : context.log_tail())
        out["log"].push_back(without_folders(line));
    }
  }
  return out;
}

/// The token of viewers, for a link that lets others watch.
net::Response view_link(ApiContext& context, const net::Request&) {
  const std::string& token = context.server->access().viewer_token();
  if (token.empty()) {
    return net::problem(409,
                        "Refused",
                        "This server asks for no token, so everybody who opens it may drive. Start "
                        "it with --token to give out view-only links.");
  }
  return json_response(200, {{"token", token}});
}

}  // namespace

void add_system_routes(Routes& routes) {
  routes.at_once("GET", "/me", [](ApiContext& context, const net::Request& request) {
    return json_response(200, me_json(context, request));
  });
  routes.at_once("GET", "/system", [](ApiContext& context, const net::Request& request) {
    return json_response(200, system_json(context, request));
  });
  routes.at_once("GET", "/view_link", view_link);
}

}  // namespace server
