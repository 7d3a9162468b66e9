// server/serve/api/sessions_routes.cpp: opening, listing and ending sessions.
#include <string>
#include <utility>

#include "server/run/hardware.hpp"
#include "server/run/json_reader.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/api/reply.hpp"

namespace server {
namespace {

using nlohmann::json;

json summary(OpenSession& open) {
  const SessionState& state = open.session().state();
  return {{"id", open.id()},
          {"source", source_of(state.spec)},
          {"scenario", state.spec.scenario.name},
          {"run", open.session().run_id()},
          {"viewers", open.bridge().hub().clients()},
          {"missed_periods", state.missed_periods},
          {"lateness", to_json(open.session().lateness())}};
}

/// A client that knows an id has full control of its session. If each visitor has one, the ids of
/// others stay hidden.
json list(ApiContext& context) {
  json items = json::array();
  const std::vector<OpenSession*> all = context.sessions.all();
  for (OpenSession* open : all) {
    if (!context.sessions.rules().per_visitor || open == &context.sessions.main())
      items.push_back(summary(*open));
  }
  return {{"items", std::move(items)},
          {"next", nullptr},
          {"count", all.size() - 1},
          {"most", context.sessions.rules().sessions}};
}

void open_session(ApiContext& context, const net::Request& request, const net::Responder& respond) {
  // The fields of `/load`; without a scenario, the run that the server began with.
  LoadRequest asked = load_request(request.body.empty() ? json::object() : body_json(request));
  if (!asked.overrides.seed) asked.overrides.seed = context.first.seed;
  if (asked.same_world) asked.document = context.first_document;
  context.sessions.open(
      [&context, asked] { return spec_to_load(context.library, asked, context.first); },
      [respond, document = asked.document](OpenSession* open, const std::exception_ptr& failure) {
        if (failure) {
          respond(problem_of(failure));
          return;
        }
        open->set_document(document);
        net::Response response = json_response(201, {{"id", open->id()}});
        response.headers.push_back({"Location", "/api/v1/sessions/" + open->id()});
        respond(std::move(response));
      });
}

}  // namespace

void add_sessions_routes(Routes& routes) {
  routes.at_once("GET", "/sessions", [](ApiContext& context, const net::Request&) {
    return json_response(200, list(context));
  });
  routes.answer("POST", "/sessions", open_session, kRequestBytes);
  routes.at_once(
      "DELETE", "/sessions/{session}", [](ApiContext& context, const net::Request& request) {
        const std::string& id = request.params.at("session");
        if (id == SessionRegistry::kMain) {
          return net::problem(
              409, "Refused", "The session main is there as long as the server is.");
        }
        if (!context.sessions.end(id))
          return net::problem(404, std::string(SessionRegistry::kGone));
        return net::Response{.status = 204};
      });
}

}  // namespace server
