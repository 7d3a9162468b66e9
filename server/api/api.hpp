// server/api/api.hpp: REST /api/v1 over a session, the scenarios, the experiments and the record.
#pragma once

#include <functional>

#include <nlohmann/json.hpp>

#include "db/run_reader.hpp"
#include "server/experiments.hpp"
#include "server/net/router.hpp"
#include "server/operator_watch.hpp"
#include "server/recorder.hpp"
#include "server/scenario_library.hpp"
#include "server/session.hpp"

namespace server {

/// What the handlers work on. All of it belongs to the io thread, but for experiments and recorder,
/// which are safe from any.
struct ApiContext {
  Session& session;
  const ScenarioLibrary& library;
  Experiments& experiments;
  Recorder& recorder;
  db::RunReader& reader;
  std::function<void(std::function<void()>)> post_to_io{};  // from any thread
  OperatorWatch watch{};
};

/// Registers every route of the API. `context` must outlive the router.
void add_api(net::Router& router, ApiContext& context);

// One file each.
void add_catalog_routes(net::Router& router, ApiContext& context);
void add_scenario_routes(net::Router& router, ApiContext& context);
void add_session_routes(net::Router& router, ApiContext& context);
void add_run_routes(net::Router& router, ApiContext& context);

/// Saves one of the user's own, once its world has been built: what cannot be run is not kept.
/// Throws LibraryError or what is wrong with the world.
void keep_scenario(const ApiContext& context, const sim::Scenario& scenario);

/// Carries out a `/load`-like document: {"scenario", "controller"?, ...}. Throws DocumentError,
/// LibraryError or what the robot says; the present run then goes on.
void load_from_json(ApiContext& context, const nlohmann::json& body);

}  // namespace server
