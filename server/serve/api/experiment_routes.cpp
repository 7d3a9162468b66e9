// server/serve/api/experiment_routes.cpp: starts, watches and ends experiments, and hands out their
// results.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "server/experiment/judge.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/json_reader.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/api/event_stream.hpp"
#include "server/serve/api/reply.hpp"

namespace server {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::shared_ptr<Experiment> experiment_of(ApiContext& context, const net::Request& request) {
  return context.experiments.find(request.params.at("id"));
}

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

net::Response post_experiment(ApiContext& context, const net::Request& request, Worker&) {
  const Experiments::Posted posted = context.experiments.post(
      body_json(request), std::string(request.header("Idempotency-Key")), request.person);
  const ExperimentInfo info = posted.experiment->info();
  net::Response response =
      json_response(info.state == ExperimentState::Finished ? 200 : 202, to_json(info));
  response.headers.push_back({"Location", "/api/v1/experiments/" + info.id});
  return response;
}

/// Checks everything as POST /experiments does and runs a few seconds of each controller.
net::Response post_estimate(ApiContext& context, const net::Request& request, Worker&) {
  const sweep::Plan plan(
      sweep::document_from_json(body_json(request), context.library, context.first.controllers));
  plan.check();
  const sweep::Estimate cost = estimate(plan);
  const sweep::Document& document = plan.document();
  return json_response(200,
                       {{"name", document.name},
                        {"runs", plan.size()},
                        {"scenarios", document.scenarios.size()},
                        {"controllers", document.controllers.size()},
                        {"settings", document.points.size()},
                        {"seeds", document.repeats},
                        {"cpu_time", cost.cpu_time},
                        {"bytes", cost.bytes}});
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
  const std::shared_ptr<const json> results = experiment->write_report();
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

// ---- the runs ----------------------------------------------------------------------------------

/// Which runs a page lists, and in which order.
struct RunQuery {
  std::string arm{}, scenario{}, outcome{}, sort{};
  bool descending = false;
};

json figures_json(const experiment::Row& row) {
  json figures = json::object();
  for (const auto& [column, value] : row.figures) {
    figures[std::string(column)] = std::isfinite(value) ? json(value) : json(nullptr);
  }
  return figures;
}

json run_json(const sweep::Plan& plan, std::size_t i, const experiment::Row& row) {
  const sweep::RunPlace at = plan.place(i);
  return {{"run", i},
          {"scenario", plan.document().scenarios[at.scenario].name},
          {"controller", plan.arms()[at.arm].label},
          {"seed", plan.seed(i)},
          {"outcome", algo::name(row.outcome)},
          {"reason", row.reason},
          {"figures", figures_json(row)},
          {"command", plan.command(i)}};
}

RunQuery query_of(const net::Request& request) {
  const auto text = [&](const char* key) {
    const auto it = request.query.find(key);
    return it == request.query.end() ? std::string() : it->second;
  };
  RunQuery query{text("controller"), text("scenario"), text("outcome"), text("sort")};
  if (query.sort.starts_with('-')) {
    query.descending = true;
    query.sort.erase(0, 1);
  }
  if (!query.sort.empty() && experiment::find_column(query.sort) == nullptr) {
    throw DocumentError("?sort", fmt::format("no figure is called '{}'", query.sort));
  }
  return query;
}

/// The numbers of the finished runs that `query` asks for, in its order. Runs without the figure
/// come last.
std::vector<std::size_t> found(const sweep::Plan& plan,
                               const sweep::Rows& rows,
                               const RunQuery& query) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows.has(i)) continue;
    const sweep::RunPlace at = plan.place(i);
    const auto other = [](const std::string& wanted, std::string_view is) {
      return !wanted.empty() && wanted != is;
    };
    if (other(query.arm, plan.arms()[at.arm].label)) continue;
    if (other(query.scenario, plan.document().scenarios[at.scenario].name)) continue;
    if (other(query.outcome, algo::name(rows.outcome(i)))) continue;
    list.push_back(i);
  }
  if (query.sort.empty()) return list;
  std::vector<double> keys(rows.size());
  for (const std::size_t i : list) {
    const double value = rows.figure(i, query.sort);
    const double worst = std::numeric_limits<double>::infinity();
    keys[i] = !std::isfinite(value) ? worst : query.descending ? -value : value;
  }
  std::ranges::stable_sort(list, {}, [&](std::size_t i) { return keys[i]; });
  return list;
}

net::Response list_experiment_runs(ApiContext& context, const net::Request& request, Worker&) {
  const std::shared_ptr<Experiment> experiment = experiment_of(context, request);
  const RunQuery query = query_of(request);
  const std::shared_ptr<const sweep::Plan> plan = experiment->plan();
  const sweep::Rows rows = experiment->rows();
  context.experiments.looked_at(experiment);
  const std::vector<std::size_t> list = found(*plan, rows, query);
  const std::size_t from = std::min<std::size_t>(list.size(), number_of(request, "from", 0));
  const std::size_t end = std::min(list.size(), from + limit_of(request, 100, 1000));
  json items = json::array();
  for (std::size_t k = from; k < end; ++k)
    items.push_back(run_json(*plan, list[k], rows.row(list[k])));
  return json_response(200,
                       {{"items", std::move(items)},
                        {"found", list.size()},
                        {"next", end < list.size() ? json(end) : json(nullptr)}});
}

/// Makes the run once more, with its record.
void record_run(ApiContext& context,
                const net::Request& request,
                Worker&,
                const net::Responder& respond) {
  const std::shared_ptr<Experiment> experiment = experiment_of(context, request);
  const std::shared_ptr<const sweep::Plan> plan = experiment->plan();
  const auto run = whole_number(request.params.at("run"));
  if (!run || *run >= plan->size()) {
    throw net::HttpError(404,
                         fmt::format("The experiment has the runs 0 to {}.", plan->size() - 1));
  }
  queue_runs(context, {.spec = plan->trial(*run).spec}, respond);
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
    experiment->write_report();
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
  routes.make("POST", "/experiments", post_experiment);
  routes.make("POST", "/experiments/estimate", post_estimate);
  routes.make("GET", "/experiments/{id}", get_experiment);
  routes.make("DELETE", "/experiments/{id}", delete_experiment);
  routes.make("POST", "/experiments/{id}/pause", changes(&Experiments::pause));
  routes.make("POST", "/experiments/{id}/resume", changes(&Experiments::resume));
  routes.make("POST", "/experiments/{id}/cancel", changes(&Experiments::cancel));
  routes.make("GET", "/experiments/{id}/events", get_events);
  routes.make("GET", "/experiments/{id}/results", get_results);
  routes.make("GET", "/experiments/{id}/runs", list_experiment_runs);
  routes.work("POST", "/experiments/{id}/runs/{run}/record", record_run);
  routes.make("GET", "/experiments/{id}/files/{file}", get_file);
  routes.make("GET", "/experiments/{id}/pictures/{file}", get_picture);
}

}  // namespace server
