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

/// What the handlers work on. The sessions belong to the io thread; the others are safe from any
/// thread.
struct ApiContext {
  SessionRegistry& sessions;
  const ScenarioLibrary& library;
  Experiments& experiments;
  Recorder& recorder;
  Workers& workers;
  std::function<void(std::function<void()>)> post_to_io{};  // from any thread
  RunSpec first{};  // of a session that is opened without a word of what it is to be
  PageRoom room{};
};

/// [bytes] of what is read on the io thread: what a person does, never a whole world.
constexpr std::size_t kRequestBytes = 256 << 10;

/// Registers every route of the API. `context` must outlive the router.
void add_api(net::Router& router, ApiContext& context);

// One file each.
void add_catalog_routes(Routes& routes);
void add_scenario_routes(Routes& routes);
void add_session_routes(net::Router& router, ApiContext& context);
void add_sessions_routes(Routes& routes);
void add_run_routes(Routes& routes);

/// {"scenario"?, "controller"?, ...}: which scenario by its name, and what is to be otherwise.
struct LoadRequest {
  std::optional<std::string> scenario{};
  RunOverrides overrides{};
};
/// Throws DocumentError.
LoadRequest load_request(const nlohmann::json& body);
/// Saves one of the user's own, once its world has been built: what cannot be run is not kept.
/// Throws LibraryError or what is wrong with the world.
void keep_scenario(const ApiContext& context, const sim::Scenario& scenario);

/// Carries out a `/load`-like document: {"scenario", "controller"?, ...}. Throws DocumentError on
/// a document that does not say what it must; `done` gets what goes wrong later, and the present
/// run then goes on. False when too many loads wait.
bool load_from_json(ApiContext& context,
                    OpenSession& session,
                    const nlohmann::json& body,
                    SessionLoader::Done done);

}  // namespace server
