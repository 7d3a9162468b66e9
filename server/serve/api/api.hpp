// server/serve/api/api.hpp: REST /api/v1 over the sessions, the scenarios, the experiments and
// the record.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/record/recorder.hpp"
#include "server/run/scenario_library.hpp"
#include "server/serve/api/worker_reply.hpp"
#include "server/serve/experiments/experiments.hpp"
#include "server/serve/net/server.hpp"
#include "server/serve/run_queue.hpp"
#include "server/serve/session_registry.hpp"
#include "server/serve/workers.hpp"

namespace server {

/// The objects that the handlers use. The sessions belong to the io thread; the others are safe
/// from any thread.
struct ApiContext {
  SessionRegistry& sessions;
  const ScenarioLibrary& library;
  Experiments& experiments;
  RunQueue& queue;
  Recorder& recorder;
  Workers& workers;
  Workers& checker;  // one thread, for what would keep the others busy for a minute
  std::function<void(std::function<void()>)> post_to_io{};  // from any thread
  RunSpec first{};                                          // default run of a new session
  std::shared_ptr<const nlohmann::json> first_document{};   // its world, if not the library's
  std::string started{};                                    // ISO 8601, UTC
  net::Server* server = nullptr;                            // io thread only
  std::function<std::vector<std::string>()> log_tail{};     // the newest log lines, oldest first
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
void add_run_list_routes(Routes& routes);
void add_run_edit_routes(Routes& routes);
void add_experiment_routes(Routes& routes);
void add_experiment_run_routes(Routes& routes);
void add_system_routes(Routes& routes);

/// Of the request's path. Throws net::HttpError 404.
std::shared_ptr<Experiment> experiment_of(ApiContext& context, const net::Request& request);

/// Queues the runs and answers 202 with their numbers, or 503.
void queue_runs(ApiContext& context, RepeatedRun asked, const net::Responder& respond);

/// {"scenario"?, "controller"?, ...}: a scenario by name or as a document, the choices that replace
/// its own, and where the robot begins. Without a scenario: the world as it stands.
struct LoadRequest {
  std::optional<std::string> name{};
  /// Of the world asked for; without a scenario, that of the world as it stands, or null.
  std::shared_ptr<const nlohmann::json> document{};
  RunOverrides overrides{};
  std::optional<algo::Pose2> begin_W{};
  bool same_world = false;
};
/// Without the document of the world as it stands. Throws DocumentError.
LoadRequest load_request(const nlohmann::json& body);
/// The run that `asked` describes; `now` is the run to keep the world of. Throws DocumentError or
/// LibraryError. Not on the io thread.
RunSpec spec_to_load(const ScenarioLibrary& library, LoadRequest asked, const RunSpec& now);
/// Saves a scenario of the user after building its world: a scenario that cannot run is not kept.
/// Returns it as saved. Throws LibraryError, or the error from building the world.
sim::Scenario keep_scenario(const ApiContext& context, const sim::Scenario& scenario);

/// Carries out a `/load`-like document: {"scenario", "controller"?, ...}. Throws DocumentError on
/// an invalid document. `done` gets a later error; the current run then goes on. False if too many
/// loads wait.
bool load_from_json(ApiContext& context,
                    OpenSession& session,
                    const nlohmann::json& body,
                    SessionLoader::Done done);

}  // namespace server
