// server/serve/api/experiment_routes.cpp: starts, watches and ends experiments, and hands out their
// results.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "server/experiment/judge.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/json_reader.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/api/event_stream.hpp"
#include "server/serve/api/reply.hpp"

namespace server {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// The files for people and their programs, by extension.
bool is_result(const fs::path& file) {
  constexpr std::string_view kResults[] = {".csv", ".json", ".md", ".tex", ".html", ".svg"};
  return std::ranges::find(kResults, file.extension().string()) != std::end(kResults) &&
         file.filename() != "state.json";
}

json files_in(const fs::path& folder, const std::string& prefix) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error) && is_result(entry.path())) {
      names.push_back(prefix + entry.path().filename().string());
    }
  }
  std::ranges::sort(names);
  return names;
}

/// "report.html", then "pictures/success.svg".
json files_of(const Experiment& experiment) {
  json files = files_in(experiment.folder(), "");
  for (json& picture : files_in(experiment.folder() / "pictures", "pictures/")) {
    files.push_back(std::move(picture));
  }
  return files;
}

net::Response list_experiments(ApiContext& context, const net::Request&, Worker&) {
  json items = json::array();
  for (const ExperimentInfo& info : context.experiments.list()) items.push_back(to_json(info));
  return json_response(200, {{"items", std::move(items)}, {"next", nullptr}});
}

net::Response post_experiment(ApiContext& context, const net::Request& request, Worker& worker) {
  const Experiments::Posted posted =
      context.experiments.post(body_json(request),
                               std::string(request.header("Idempotency-Key")),
                               request.person,
                               worker.stop());
  const ExperimentInfo info = posted.experiment->info();
  net::Response response =
      json_response(info.state == ExperimentState::Finished ? 200 : 202, to_json(info));
  response.headers.push_back({"Location", "/api/v1/experiments/" + info.id});
  return response;
}

/// Checks everything as POST /experiments does and runs a few seconds of each controller.
net::Response post_estimate(ApiContext& context, const net::Request& request, Worker& worker) {
  const auto [plan, cost] = context.experiments.estimate(body_json(request), worker.stop());
  const sweep::Document& document = plan.document();
  return json_response(200,
                       {{"name", document.name},
                        {"runs", plan.size()},
                        {"scenarios", document.scenarios.size()},
                        {"controllers", document.controllers.size()},
                        {"settings", document.points.size()},
                        {"seeds", document.most_repeats()},
                        {"cpu_time", cost.cpu_time},
                        {"bytes", cost.bytes},
                        {"extrapolated", cost.extrapolated}});
}

net::Response get_experiment(ApiContext& context, const net::Request& request, Worker&) {
  const std::shared_ptr<Experiment> experiment = experiment_of(context, request);
  const std::shared_ptr<const sweep::Plan> plan = experiment->plan();
  context.experiments.looked_at(experiment);
  json body = to_json(experiment->info());
  json arms = json::array();
  for (const sweep::Arm& arm : plan->arms()) arms.push_back(arm.label);
  json scenarios = json::array();
  for (const sim::Scenario& scenario : plan->document().scenarios) {
    scenarios.push_back(scenario.name);
  }
  body["arms"] = std::move(arms);
  body["scenarios"] = std::move(scenarios);
  body["document"] = plan->document().source;
  body["files"] = files_of(*experiment);
  return json_response(200, body);
}

using Change = void (Experiments::*)(const std::string&);

Routes::Make changes(Change change) {
  return [change](ApiContext& context, const net::Request& request, Worker&) {
    const std::shared_ptr<Experiment> experiment = experiment_of(context, request);
    (context.experiments.*change)(request.params.at("id"));
    return json_response(202, to_json(experiment->info()));
  };
}

net::Response delete_experiment(ApiContext& context, const net::Request& request, Worker&) {
  context.experiments.remove(request.params.at("id"));
  net::Response response;
  response.status = 204;
  return response;
}

/// results.json, of its scenarios only the asked one: a page shows one at a time.
net::Response get_results(ApiContext& context, const net::Request& request, Worker&) {
  const std::shared_ptr<Experiment> experiment = experiment_of(context, request);
  const std::shared_ptr<const json> results = experiment->write_report().results;
  context.experiments.looked_at(experiment);
  json body = json::object();
  for (const auto& [key, value] : results->items()) {
    if (key != "scenarios" && key != "document") body[key] = value;
  }
  const auto wanted = request.query.find("scenario");
  if (wanted != request.query.end()) {
    json& groups = body["scenarios"] = json::array();
    for (const json& group : results->at("scenarios")) {
      if (group.at("scenario") == wanted->second) groups.push_back(group);
    }
    if (groups.empty()) throw DocumentError("?scenario", "the experiment has no such scenario");
  }
  return json_response(200, body);
}

// ---- the files ---------------------------------------------------------------------------------

std::string_view content_type_of(const fs::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".csv") return "text/csv; charset=utf-8";
  if (extension == ".json") return "application/json";
  if (extension == ".html") return "text/html; charset=utf-8";
  if (extension == ".svg") return "image/svg+xml";
  if (extension == ".md") return "text/markdown; charset=utf-8";
  return "text/plain; charset=utf-8";
}

/// The files hold text of the person who posted the experiment. It must not act as part of the
/// page.
constexpr const char* kSandbox =
    "sandbox allow-scripts; default-src 'none'; style-src 'unsafe-inline'; script-src "
    "'unsafe-inline'; img-src data:";

/// The file in `folder` of the experiment's own, "" or "pictures", as it is now; a later report
/// replaces it and does not change it.
net::Response file_of(ApiContext& context, const net::Request& request, const char* folder) {
  constexpr std::size_t kSlice = std::size_t{256} << 10;
  const std::shared_ptr<Experiment> experiment = experiment_of(context, request);
  const std::string& name = request.params.at("file");
  const fs::path file = experiment->folder() / folder / name;
  const bool one_of_ours = name.find('/') == std::string::npos && is_result(name);
  if (one_of_ours) {
    const std::string problem = experiment->write_report().problem;
    if (!problem.empty()) throw net::HttpError(503, problem);
    context.experiments.looked_at(experiment);
  }
  const auto in = std::make_shared<std::ifstream>();
  if (one_of_ours) in->open(file, std::ios::binary);
  if (!in->is_open()) {
    throw net::HttpError(404, fmt::format("The experiment has no file '{}'.", name));
  }
  net::Response response;
  response.content_type = content_type_of(file);
  response.headers.push_back(
      {"Content-Disposition",
       fmt::format("inline; filename=\"{}-{}\"", experiment->info().name, name)});
  response.headers.push_back({"Content-Security-Policy", kSandbox});
  response.stream = std::make_shared<WorkerStream>(context, [in](Worker&) {
    std::string slice(kSlice, '\0');
    in->read(slice.data(), static_cast<std::streamsize>(slice.size()));
    slice.resize(static_cast<std::size_t>(in->gcount()));
    return slice;
  });
  return response;
}

net::Response get_file(ApiContext& context, const net::Request& request, Worker&) {
  return file_of(context, request, "");
}

net::Response get_picture(ApiContext& context, const net::Request& request, Worker&) {
  return file_of(context, request, "pictures");
}

// ---- the progress ------------------------------------------------------------------------------

net::Response get_events(ApiContext& context, const net::Request& request, Worker&) {
  const std::shared_ptr<Experiment> experiment = experiment_of(context, request);
  const std::string id = request.params.at("id");
  return event_stream(context, [&context, id](Worker&) -> std::optional<Event> {
    try {
      return Event{"progress", dump_json(to_json(context.experiments.find(id)->info()))};
    } catch (const net::HttpError&) {
      return std::nullopt;  // deleted
    }
  });
}

}  // namespace

void add_experiment_routes(Routes& routes) {
  routes.make("GET", "/experiments", list_experiments);
  routes.make_in_turn("POST", "/experiments", post_experiment);
  routes.make("POST", "/experiments/estimate", post_estimate);
  routes.make("GET", "/experiments/{id}", get_experiment);
  routes.make("DELETE", "/experiments/{id}", delete_experiment);
  routes.make("POST", "/experiments/{id}/pause", changes(&Experiments::pause));
  routes.make("POST", "/experiments/{id}/resume", changes(&Experiments::resume));
  routes.make("POST", "/experiments/{id}/cancel", changes(&Experiments::cancel));
  routes.make("GET", "/experiments/{id}/events", get_events);
  routes.make("GET", "/experiments/{id}/results", get_results);
  routes.make("GET", "/experiments/{id}/files/{file}", get_file);
  routes.make("GET", "/experiments/{id}/pictures/{file}", get_picture);
}

}  // namespace server
