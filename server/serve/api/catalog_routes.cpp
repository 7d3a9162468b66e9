// server/serve/api/catalog_routes.cpp: health, version, the API's own description, and what there
// is.
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
  add_catalog_routes(router, context);
  add_scenario_routes(router, context);
  add_session_routes(router, context);
  add_sessions_routes(router, context);
  add_run_routes(router, context);
}

void add_catalog_routes(net::Router& router, ApiContext& context) {
  router.add("GET", "/api/v1/healthz", immediate([&context](const net::Request&) {
               json body = {{"status", "ok"}};
               if (const auto& problem = context.sessions.main().session().state().problem) {
                 body = {{"status", "degraded"}, {"problem", without_folders(*problem)}};
               }
               return json_response(200, body);
             }));
  router.add("GET", "/api/v1/version", immediate([](const net::Request& request) {
               json body = {{"name", "tautline"}, {"version", kVersion}, {"api", 1}};
               // So that the page knows whether there is a login to end.
               body["signed_in"] = !request.cookie(net::Access::kCookie).empty();
               return json_response(200, body);
             }));
  router.add("GET", "/api/v1/openapi.json", immediate([](const net::Request&) {
               return net::json_response(200, openapi_document());
             }));
  router.add("GET", "/api/v1/catalog", immediate([](const net::Request&) {
               return json_response(200, catalog_json());
             }));
}

}  // namespace server
