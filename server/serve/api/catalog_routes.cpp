// server/serve/api/catalog_routes.cpp: health, version, the API's own description, and the catalog.
#include "server/run/paths.hpp"
#include "server/run/version.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/api/openapi.hpp"
#include "server/serve/api/reply.hpp"
#include "server/serve/net/access.hpp"
#include "server/serve/session_json.hpp"

namespace server {

using nlohmann::json;

void add_api(net::Router& router, ApiContext& context) {
  Routes routes(router, context);
  add_catalog_routes(routes);
  add_scenario_routes(routes);
  add_session_routes(router, context);
  add_sessions_routes(routes);
  add_run_routes(routes);
  add_run_list_routes(routes);
  add_run_edit_routes(routes);
  add_experiment_routes(routes);
  add_experiment_run_routes(routes);
  add_system_routes(routes);
  take_described_queries(router);
  // Nothing has an owner: deleting what others have made is for admins.
  for (const char* path :
       {"/runs/{id}", "/experiments/{id}", "/scenarios/{name}", "/sessions/{session}"}) {
    router.need("DELETE", std::string("/api/v1") + path, net::Role::Admin);
  }
  router.need("POST", "/api/v1/runs/delete", net::Role::Admin);
  router.need("POST", "/api/v1/runs/restore", net::Role::Admin);
  router.need("GET", "/api/v1/view_link", net::Role::Operator);
}

void add_catalog_routes(Routes& routes) {
  routes.at_once("GET", "/healthz", [](ApiContext& context, const net::Request&) {
    json body = {{"status", "ok"}};
    if (const auto& problem = context.sessions.main().session().state().problem) {
      body = {{"status", "degraded"}, {"problem", without_folders(*problem)}};
    }
    return json_response(200, body);
  });
  routes.at_once("GET", "/version", [](ApiContext&, const net::Request& request) {
    json body = {{"name", "tautline"}, {"version", kVersion}, {"api", 1}};
    // The page must know whether there is a login to end.
    body["signed_in"] = !request.cookie(net::Access::kCookie).empty();
    return json_response(200, body);
  });
  routes.at_once("GET", "/openapi.json", [](ApiContext&, const net::Request&) {
    return net::json_response(200, openapi_document());
  });
  routes.at_once("GET", "/catalog", [](ApiContext& context, const net::Request&) {
    return json_response(200, catalog_json(controllers_of(context.first)));
  });
}

}  // namespace server
