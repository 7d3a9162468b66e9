// server/serve/api/run_routes.cpp: starts runs and serves records.
#include <algorithm>
#include <cctype>
#include <deque>
#include <mutex>

#include <fmt/format.h>

#include "server/record/filtered_scans.hpp"
#include "server/record/frame_codec.hpp"
#include "server/record/run_csv.hpp"
#include "server/record/run_json.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/paths.hpp"
#include "server/run/scenario_json.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/api/reply.hpp"
#include "server/serve/api/run_reply.hpp"

namespace server {
namespace {

using nlohmann::json;
constexpr std::uint64_t kMaxRepeats = 10'000;

net::Response too_many() {
  return net::problem(
      503, "Busy", "Too many runs, or too large worlds, are queued already. Try again later.");
}

RepeatedRun repeated_run_from_json(const ApiContext& context, const json& body) {
  const JsonReader in(body, "");
  in.only({"scenario",
           "controller",
           "filter",
           "physics",
           "vehicle",
           "robot",
           "parameters",
           "seed",
           "repeats",
           "pace"});
  sim::Scenario scenario = body.contains("scenario") && body["scenario"].is_object()
                               ? scenario_from_json(body["scenario"], context.library.robots())
                               : context.library.load(in.text("scenario", 64));
  RunOverrides overrides = overrides_from_json(body);
  overrides.controllers = context.first.controllers;
  RepeatedRun asked;
  asked.spec =
      make_spec(context.library.placed(std::move(scenario)), overrides, context.library.robots());
  asked.repeats = static_cast<std::uint32_t>(in.whole_or("repeats", 1, kMaxRepeats));
  if (asked.repeats == 0) in.fail("repeats", "must be at least 1");
  try {
    overrides_from_json(
        {{"seed", asked.spec.seed + asked.repeats - 1}});  // the limit of every seed
  } catch (const DocumentError& e) {
    throw DocumentError("repeats", fmt::format("the last run's {}", e.what()));
  }
  asked.pace = pace_from_json(body, "pace", 0);
  return asked;
}

void start_runs(ApiContext& context,
                const net::Request& request,
                Worker&,
                const net::Responder& respond) {
  queue_runs(context, repeated_run_from_json(context, body_json(request)), respond);
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
    } catch (const db::DatabaseError&) {
      // A full disk must not keep a run that somebody wants to delete.
      context.recorder.post_when_well([run](db::RunStore& later) { later.delete_run(run); });
      response = json_response(
          202, {{"ok", true}, {"detail", "It goes as soon as the store takes writes again."}});
    } catch (const std::exception& e) {
      response = net::problem(503, "The record is not available", without_folders(e.what()));
    }
    context.post_to_io([respond, response = std::move(response)] { respond(response); });
  });
}

/// Runs an interrupted run again from its start, under its own number.
void resume_run(ApiContext& context,
                const net::Request& request,
                Worker& worker,
                const net::Responder& respond) {
  const db::RunId run = run_id(request);
  const auto row = worker.runs().get(run);
  if (!row) {
    respond(no_such_run(run));
    return;
  }
  const json document = parse_json(row->what.document, kOwnDocument);
  if (!document.contains("pace")) {
    respond(net::problem(409,
                         "Driven live",
                         "People drove this run, which cannot be run again by itself: load its "
                         "scenario and drive it."));
    return;
  }
  RunOverrides overrides;
  overrides.seed = row->what.seed;
  overrides.controllers = context.first.controllers;
  RunSpec spec =
      make_spec(document.value("source", "") == "replay"
                    ? context.library.load(row->what.scenario)
                    : context.library.placed(scenario_from_json(document.at("scenario"))),
                overrides);
  const bool taken =
      context.queue.resume(run,
                           std::move(spec),
                           document.at("pace").get<double>(),
                           row->what.document.size(),
                           [run, respond](const std::string& refusal) {
                             respond(refusal.empty() ? json_response(202, {{"runs", {run}}})
                                                     : net::problem(409, "Not resumed", refusal));
                           });
  if (!taken) {
    respond(too_many());
  }
}

net::Response list_ticks(ApiContext& context, const net::Request& request, Worker& worker) {
  constexpr std::size_t kRows = 250;  // rows between two checks of the room
  const db::RunId run = run_id(request);
  db::RunReader& reader = worker.runs();
  if (!reader.get(run)) return no_such_run(run);
  std::optional<std::uint64_t> next = number_of(request, "from", 0);
  std::size_t left = limit_of(request, 1000, 10'000);
  const std::size_t room = context.room.page();
  std::string list = "[";
  algo::Telemetry t;
  while (next && left > 0 && list.size() < room) {
    next = reader.frames(
        run, *next, std::min(left, kRows), [&](std::uint64_t, std::span<const std::byte> frame) {
          decode_frame(frame, t);
          append_item(list, tick_json(t));
          --left;
        });
  }
  return page_response(std::move(list), next ? json(*next) : json(nullptr));
}

/// u32 little-endian length + bytes.
void append_message(std::string& body, std::span<const std::byte> message) {
  const auto size = static_cast<std::uint32_t>(message.size());
  for (int shift = 0; shift < 32; shift += 8) {
    body.push_back(static_cast<char>((size >> shift) & 0xFF));
  }
  body.append(reinterpret_cast<const char*>(message.data()), message.size());
}

net::Response messages_response(std::string body, std::optional<std::uint64_t> next) {
  net::Response response;
  response.content_type = "application/octet-stream";
  if (next) response.headers.push_back({"X-Next-Tick", std::to_string(*next)});
  response.body = std::make_shared<const std::string>(std::move(body));
  return response;
}

/// A page of messages, one per tick: `read(from, body)` appends one and returns the tick to
/// continue with.
template <typename Read>
net::Response messages_page(ApiContext& context, const net::Request& request, const Read& read) {
  std::string body;
  std::optional<std::uint64_t> next = number_of(request, "from", 0);
  const std::size_t room = context.room.page();
  for (std::size_t left = limit_of(request, 1000, 5000); left > 0 && body.size() < room; --left) {
    next = read(*next, body);
    if (!next) break;
  }
  return messages_response(std::move(body), next);
}

net::Response list_frames(ApiContext& context, const net::Request& request, Worker& worker) {
  const db::RunId run = run_id(request);
  db::RunReader& reader = worker.runs();
  if (!reader.get(run)) return no_such_run(run);
  return messages_page(context, request, [&](std::uint64_t from, std::string& body) {
    return reader.frames(run, from, 1, [&](std::uint64_t, std::span<const std::byte> frame) {
      append_message(body, frame);
    });
  });
}

/// What a viewer marks in the time of a run.
struct Standing {
  algo::Mission mission{};
  algo::Halt halt{};
  algo::Hold hold{};
  bool collided = false;
  friend bool operator==(const Standing&, const Standing&) = default;
};

bool requests_an_edit(const algo::Telemetry& t) {
  return std::ranges::any_of(t.requests, [](const algo::Request& request) {
    return !std::holds_alternative<algo::Joystick>(request);
  });
}

/// The frames among the next `limit` ticks in which something happens: a request, or a change of
/// mission, hold, halt or contact. The first tick always counts.
net::Response list_events(ApiContext& context, const net::Request& request, Worker& worker) {
  constexpr std::size_t kRows = 250;  // rows between two checks of the room
  const db::RunId run = run_id(request);
  db::RunReader& reader = worker.runs();
  if (!reader.get(run)) return no_such_run(run);
  std::optional<std::uint64_t> next = number_of(request, "from", 0);
  std::size_t left = limit_of(request, 5000, 20'000);
  const std::size_t room = context.room.page();
  std::string body;
  algo::Telemetry t;
  std::optional<Standing> before;
  while (next && left > 0 && body.size() < room) {
    const std::size_t rows = std::min(left, kRows);
    next = reader.frames(run, *next, rows, [&](std::uint64_t, std::span<const std::byte> frame) {
      decode_frame(frame, t);
      const Standing now{
          t.mission, t.observation.halt, t.hold, t.ground_truth && t.ground_truth->collided};
      if (now != before || requests_an_edit(t)) append_message(body, frame);
      before = now;
    });
    left -= rows;
  }
  return messages_response(std::move(body), next);
}

/// Keeps readers of filtered scans, from which a next page may continue.
class FilteredPages {
 public:
  net::Response page(ApiContext& context, const net::Request& request, Worker& worker) {
    const db::RunId run = run_id(request);
    db::RunReader& reader = worker.runs();
    const auto row = reader.get(run);
    if (!row) return no_such_run(run);
    FilteredScans scans = take(*row, number_of(request, "from", 0));
    net::Response response =
        messages_page(context, request, [&](std::uint64_t from, std::string& body) {
          return scans.read(reader, from, 1, [&](std::uint64_t, std::span<const std::byte> scan) {
            append_message(body, scan);
          });
        });
    keep(std::move(scans));
    return response;
  }

 private:
  static constexpr std::size_t kMost = 4;

  FilteredScans take(const db::RunRow& row, std::uint64_t from) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(
        kept_, [&](const FilteredScans& scans) { return scans.stands_before(row, from); });
    if (found == kept_.end()) return FilteredScans(row);
    FilteredScans scans = std::move(*found);
    kept_.erase(found);
    return scans;
  }
  void keep(FilteredScans scans) {
    const std::lock_guard lock(mutex_);
    if (kept_.size() == kMost) kept_.pop_front();
    kept_.push_back(std::move(scans));
  }

  std::mutex mutex_{};
  std::deque<FilteredScans> kept_{};
};

/// `?KEY=1` or `?KEY=0`, which is also the default; throws DocumentError.
bool flag_of(const net::Request& request, const std::string& key) {
  const std::uint64_t value = number_of(request, key, 0);
  if (value > 1) throw DocumentError("?" + key, fmt::format("is {}, must be 0 or 1", value));
  return value == 1;
}

/// "run-12-case1.csv"; letters that a header or a file system may refuse become dashes.
std::string csv_name(const db::RunRow& row) {
  std::string name = fmt::format("run-{}-{}", row.id, row.what.scenario);
  for (char& c : name) {
    const bool good = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
    if (!good) c = '-';
  }
  return name + ".csv";
}

net::Response export_csv(ApiContext& context, const net::Request& request, Worker& worker) {
  constexpr std::size_t kLines = 300;  // lines of a slice: about 100 kB
  const db::RunId run = run_id(request);
  const auto row = worker.runs().get(run);
  if (!row) return no_such_run(run);
  const auto next = std::make_shared<std::optional<std::uint64_t>>(0);
  const CsvOptions options{.units = flag_of(request, "units"),
                           .arrays = flag_of(request, "arrays")};
  const auto csv = std::make_shared<const RunCsv>(worker.runs(), *row, options);
  const auto make = [csv, next](Worker& at_work) {
    std::string slice;
    if (!*next) return slice;
    const std::uint64_t from = **next;
    if (from == 0) slice = csv->header();
    const std::size_t before = slice.size();
    *next = csv->lines(at_work.runs(), from, kLines, slice);
    if (from > 0 && slice.size() == before) throw db::StoreError("The run was deleted meanwhile.");
    return slice;
  };
  net::Response response;
  response.content_type = "text/csv; charset=utf-8";
  response.headers.push_back(
      {"Content-Disposition", fmt::format("attachment; filename=\"{}\"", csv_name(*row))});
  response.stream = std::make_shared<WorkerStream>(context, make);
  return response;
}

net::Response cancel_run(ApiContext& context, const net::Request& request, Worker& worker) {
  const db::RunId run = run_id(request);
  if (context.queue.cancel(run)) return json_response(202, {{"ok", true}});
  if (!worker.runs().get(run)) return no_such_run(run);
  return net::problem(409, "Not running", "The run is neither queued nor running.");
}

net::Response get_run(ApiContext&, const net::Request& request, Worker& worker) {
  const db::RunId run = run_id(request);
  const auto row = worker.runs().get(run);
  return row ? json_response(200, to_json(*row)) : no_such_run(run);
}

net::Response get_metrics(ApiContext&, const net::Request& request, Worker& worker) {
  const db::RunId run = run_id(request);
  auto row = worker.runs().get(run);
  if (!row) return no_such_run(run);
  row->what.document.clear();
  return json_response(200, to_json(*row).at("metrics"));
}

}  // namespace

void queue_runs(ApiContext& context, RepeatedRun asked, const net::Responder& respond) {
  const auto accepted = [respond](const std::vector<db::RunId>& runs, const std::string& failure) {
    if (runs.empty()) {
      respond(net::problem(503, "The record is not available", without_folders(failure)));
      return;
    }
    net::Response response = json_response(202, {{"runs", runs}});
    response.headers.push_back({"Location", fmt::format("/api/v1/runs/{}", runs.front())});
    respond(std::move(response));
  };
  if (!context.queue.start(std::move(asked), accepted)) respond(too_many());
}

void add_run_routes(Routes& routes) {
  routes.work("POST", "/runs", start_runs);
  routes.make("GET", "/runs/{id}", get_run);
  routes.answer("DELETE", "/runs/{id}", delete_run);
  routes.make("POST", "/runs/{id}/cancel", cancel_run);
  routes.work("POST", "/runs/{id}/resume", resume_run);
  routes.make("GET", "/runs/{id}/metrics", get_metrics);
  routes.make("GET", "/runs/{id}/ticks", list_ticks);
  routes.make("GET", "/runs/{id}/frames", list_frames);
  routes.make("GET", "/runs/{id}/events", list_events);
  const auto filtered = std::make_shared<FilteredPages>();
  routes.make("GET",
              "/runs/{id}/filtered",
              [filtered](ApiContext& context, const net::Request& request, Worker& worker) {
                return filtered->page(context, request, worker);
              });
  routes.make("GET", "/runs/{id}/csv", export_csv);
}

}  // namespace server
