// server/api/run_routes.cpp: experiments in, records out.
#include <cstring>

#include <fmt/format.h>

#include "server/api/api.hpp"
#include "server/api/reply.hpp"
#include "server/json_reader.hpp"
#include "server/run_json.hpp"
#include "server/scenario_json.hpp"

namespace server {
namespace {

using nlohmann::json;
constexpr std::uint64_t kMaxRepeats = 10'000;
constexpr std::size_t kMaxQueued = 20'000;  // runs of all experiments together

db::RunId run_id(const net::Request& request) {
  const std::string& text = request.params.at("id");
  if (text.empty() || text.size() > 18 ||
      text.find_first_not_of("0123456789") != std::string::npos) {
    throw DocumentError("id", fmt::format("'{}' is not a run's number", text));
  }
  return std::stoll(text);
}

net::Response no_such_run(db::RunId run) {
  return net::problem(404, "Not found", fmt::format("There is no run {}.", run));
}

db::RunFilter filter_of(const net::Request& request) {
  db::RunFilter filter;
  const auto get = [&](const char* key) -> std::optional<std::string> {
    const auto it = request.query.find(key);
    if (it == request.query.end() || it->second.empty()) return std::nullopt;
    return it->second;
  };
  filter.scenario = get("scenario");
  filter.controller = get("controller");
  filter.outcome = get("outcome");
  if (const auto status = get("status")) {
    filter.status = db::find_status(*status);
    if (!filter.status) {
      throw DocumentError("status",
                          fmt::format("'{}' is unknown; known are queued, recording, finished, "
                                      "interrupted, cancelled, failed",
                                      *status));
    }
  }
  return filter;
}

net::Response list_runs(ApiContext& context, const net::Request& request) {
  std::optional<db::RunId> cursor;
  if (request.query.contains("cursor")) {
    cursor = static_cast<db::RunId>(number_of(request, "cursor", 0));
  }
  const db::RunFilter filter = filter_of(request);
  const db::RunPage page = context.reader.list(filter, limit_of(request, 50, 500), cursor);
  json items = json::array();
  for (const db::RunRow& row : page.runs) items.push_back(to_json(row));
  json body = {{"items", std::move(items)}, {"next", nullptr}};
  if (page.next) body["next"] = std::to_string(*page.next);
  if (!cursor) body["total"] = context.reader.count(filter);
  return json_response(200, body);
}

Experiment experiment_from_json(const ApiContext& context, const json& body) {
  const JsonReader in(body, "");
  in.only({"scenario", "controller", "filter", "vehicle", "parameters", "seed", "repeats", "pace"});
  sim::Scenario scenario = body.contains("scenario") && body["scenario"].is_object()
                               ? scenario_from_json(body["scenario"])
                               : context.library.load(in.text("scenario", 64));
  Experiment experiment;
  experiment.spec = make_spec(std::move(scenario), overrides_from_json(body));
  experiment.repeats = static_cast<std::uint32_t>(in.whole_or("repeats", 1, kMaxRepeats));
  if (experiment.repeats == 0) in.fail("repeats", "must be at least 1");
  experiment.pace = pace_from_json(body, "pace", 0);
  return experiment;
}

void start_runs(ApiContext& context, const net::Request& request, const net::Responder& respond) {
  Experiment experiment = experiment_from_json(context, body_json(request));
  if (context.experiments.waiting() + experiment.repeats > kMaxQueued) {
    respond(net::problem(503, "Busy", "Too many runs are queued already. Try again later."));
    return;
  }
  context.experiments.start(
      std::move(experiment),
      [&context, respond](const std::vector<db::RunId>& runs, const std::string& failure) {
        context.post_to_io([runs, failure, respond] {
          if (runs.empty()) {
            respond(net::problem(503, "The record is not available", failure));
            return;
          }
          net::Response response = json_response(202, {{"runs", runs}});
          response.headers.push_back({"Location", fmt::format("/api/v1/runs/{}", runs.front())});
          respond(std::move(response));
        });
      });
}

void delete_run(ApiContext& context, const net::Request& request, const net::Responder& respond) {
  const db::RunId run = run_id(request);
  context.recorder.post([&context, run, respond](db::RunStore& store) {
    net::Response response;
    response.status = 204;
    try {
      switch (store.delete_run(run)) {
        case db::RunStore::Deletion::Deleted:
          store.commit();
          break;
        case db::RunStore::Deletion::NotFound:
          response = no_such_run(run);
          break;
        case db::RunStore::Deletion::StillRecording:
          response = net::problem(409, "Still recording", "Cancel or end the run first.");
          break;
      }
    } catch (const std::exception& e) {
      response = net::problem(503, "The record is not available", e.what());
    }
    context.post_to_io([respond, response = std::move(response)] { respond(response); });
  });
}

net::Response list_ticks(ApiContext& context, const net::Request& request) {
  const db::RunId run = run_id(request);
  if (!context.reader.get(run)) return no_such_run(run);
  const db::TickPage page =
      context.reader.ticks(run, number_of(request, "from", 0), limit_of(request, 1000, 10'000));
  json items = json::array();
  for (const db::TickRow& row : page.ticks) items.push_back(to_json(row));
  json body = {{"items", std::move(items)}, {"next", nullptr}};
  if (page.next) body["next"] = *page.next;
  return json_response(200, body);
}

/// Each frame as u32 little-endian length + bytes.
net::Response list_frames(ApiContext& context, const net::Request& request) {
  const db::RunId run = run_id(request);
  if (!context.reader.get(run)) return no_such_run(run);
  auto body = std::make_shared<std::string>();
  const auto next = context.reader.frames(
      run,
      number_of(request, "from", 0),
      limit_of(request, 1000, 5000),
      [&](std::uint64_t /*tick*/, std::span<const std::byte> frame) {
        const auto size = static_cast<std::uint32_t>(frame.size());
        for (int shift = 0; shift < 32; shift += 8) {
          body->push_back(static_cast<char>((size >> shift) & 0xFF));
        }
        body->append(reinterpret_cast<const char*>(frame.data()), frame.size());
      });
  net::Response response;
  response.content_type = "application/octet-stream";
  if (next) response.headers.push_back({"X-Next-Tick", std::to_string(*next)});
  response.body = std::move(body);
  return response;
}

net::Response export_csv(ApiContext& context, const net::Request& request) {
  const db::RunId run = run_id(request);
  if (!context.reader.get(run)) return no_such_run(run);
  auto body = std::make_shared<std::string>(db::RunReader::csv_header());
  std::optional<std::uint64_t> from = 0;
  while (from) {
    const std::uint64_t tick = *from;
    from = context.reader.csv(run, tick, 10'000, *body, csv_names());
  }
  net::Response response;
  response.content_type = "text/csv; charset=utf-8";
  response.headers.push_back(
      {"Content-Disposition", fmt::format("attachment; filename=\"run-{}.csv\"", run)});
  response.body = std::move(body);
  return response;
}

}  // namespace

void add_run_routes(net::Router& router, ApiContext& context) {
  router.add("POST",
             "/api/v1/runs",
             guarded([&context](const net::Request& request, const net::Responder& respond) {
               start_runs(context, request, respond);
             }));
  router.add("GET", "/api/v1/runs", immediate([&context](const net::Request& request) {
               return list_runs(context, request);
             }));
  router.add("GET", "/api/v1/runs/{id}", immediate([&context](const net::Request& request) {
               const auto row = context.reader.get(run_id(request));
               return row ? json_response(200, to_json(*row)) : no_such_run(run_id(request));
             }));
  router.add("DELETE",
             "/api/v1/runs/{id}",
             guarded([&context](const net::Request& request, const net::Responder& respond) {
               delete_run(context, request, respond);
             }));
  router.add("POST", "/api/v1/runs/{id}/cancel", immediate([&context](const net::Request& request) {
               const db::RunId run = run_id(request);
               if (context.experiments.cancel(run)) return json_response(202, {{"ok", true}});
               if (!context.reader.get(run)) return no_such_run(run);
               return net::problem(409, "Not running", "The run is neither queued nor running.");
             }));
  router.add("GET", "/api/v1/runs/{id}/metrics", immediate([&context](const net::Request& request) {
               const auto row = context.reader.get(run_id(request));
               if (!row) return no_such_run(run_id(request));
               return json_response(200, to_json(*row).at("metrics"));
             }));
  router.add("GET", "/api/v1/runs/{id}/ticks", immediate([&context](const net::Request& request) {
               return list_ticks(context, request);
             }));
  router.add("GET", "/api/v1/runs/{id}/frames", immediate([&context](const net::Request& request) {
               return list_frames(context, request);
             }));
  router.add("GET", "/api/v1/runs/{id}/csv", immediate([&context](const net::Request& request) {
               return export_csv(context, request);
             }));
}

}  // namespace server
