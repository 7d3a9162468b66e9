// server/serve/api/api.hpp: REST /api/v1 over the sessions, the scenarios, the experiments and the
// record.
#pragma once

#include <functional>

#include <nlohmann/json.hpp>

#include "server/record/recorder.hpp"
#include "server/run/scenario_library.hpp"
#include "server/serve/api/worker_reply.hpp"
#include "server/serve/experiments.hpp"
#include "server/serve/net/router.hpp"
#include "server/serve/session_registry.hpp"
#include "server/serve/workers.hpp"

namespace server {

/// The objects that the handlers use. The sessions belong to the io thread; the others are safe
/// from any thread.
struct ApiContext {
  SessionRegistry& sessions;
  const ScenarioLibrary& library;
  Experiments& experiments;
  Recorder& recorder;
  Workers& workers;
  std::function<void(std::function<void()>)> post_to_io{};  // from any thread
  RunSpec first{};                                          // default run of a new session
  PageRoom room{};
};

/// [bytes] of a body read on the io thread: small requests by people, never a whole world.
constexpr std::size_t kRequestBytes = 256 << 10;

/// Registers every route of the API. `context` must outlive the router.
void add_api(net::Router& router, ApiContext& context);

// One file each.
void add_catalog_routes(Routes& routes);
void add_scenario_routes(Routes& routes);
void add_session_routes(net::Router& router, ApiContext& context);
void add_sessions_routes(Routes& routes);
void add_run_routes(Routes& routes);

/// {"scenario"?, "controller"?, ...}: a scenario by name, and the choices that replace its own.
struct LoadRequest {
  std::optional<std::string> scenario{};
  RunOverrides overrides{};
};
/// Throws DocumentError.
LoadRequest load_request(const nlohmann::json& body);
/// Saves a scenario of the user after building its world: a scenario that cannot run is not kept.
/// Throws LibraryError, or the error from building the world.
void keep_scenario(const ApiContext& context, const sim::Scenario& scenario);

/// Carries out a `/load`-like document: {"scenario", "controller"?, ...}. Throws DocumentError on
/// an invalid document. `done` gets a later error; the current run then goes on. False if too many
/// loads wait.
bool load_from_json(ApiContext& context,
                    OpenSession& session,
                    const nlohmann::json& body,
                    SessionLoader::Done done);

}  // namespace server
