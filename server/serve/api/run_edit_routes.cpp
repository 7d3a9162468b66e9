// server/serve/api/run_edit_routes.cpp: label, note and tags of runs; cancels, deletes and restores
// many at once.
#include <algorithm>
#include <chrono>
#include <span>

#include <fmt/format.h>

#include "server/record/run_json.hpp"
#include "server/run/json_reader.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/api/reply.hpp"
#include "server/serve/api/run_reply.hpp"

namespace server {
namespace {

using nlohmann::json;

constexpr std::size_t kMostLabel = 120;
constexpr std::size_t kMostNote = 4000;
constexpr std::size_t kMostTags = 16;
constexpr std::size_t kMostTag = 40;
constexpr std::size_t kMostRuns = 20'000;  // of one request
constexpr std::size_t kEditSlice = 200;    // runs changed between the frames of live runs

/// A tag is one line, so that a search can tell it from others.
std::vector<std::string> tags_from(const JsonReader& in, std::string_view key) {
  std::vector<std::string> tags;
  if (!in.has(key)) return tags;
  in.each(key, kMostTags, [&](const json& value, const std::string& path) {
    const std::string tag = value.is_string() ? value.get<std::string>() : "";
    const bool control = std::ranges::any_of(
        tag, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == ','; });
    if (tag.empty() || tag.size() > kMostTag || control) {
      throw DocumentError(
          path,
          fmt::format("must be a text of 1 to {} bytes without comma or line break", kMostTag));
    }
    if (std::ranges::find(tags, tag) == tags.end()) tags.push_back(tag);
  });
  return tags;
}

db::RunRemarks remarks_from(const json& body) {
  const JsonReader in(body, "");
  in.only({"label", "note", "tags"});
  db::RunRemarks remarks;
  if (in.has("label")) remarks.label = in.text("label", kMostLabel);
  if (in.has("note")) remarks.note = in.text("note", kMostNote);
  if (in.has("tags")) remarks.tags = tags_from(in, "tags");
  return remarks;
}

net::Response remark(ApiContext& context, const net::Request& request, Worker& worker) {
  const db::RunId run = run_id(request);
  const db::RunRemarks remarks = remarks_from(body_json(request));
  const bool found =
      context.recorder.ask([&](db::RunStore& store) { return store.remark(run, remarks); });
  const auto row = found ? worker.runs().get(run) : std::nullopt;
  return row ? json_response(200, to_json(*row)) : no_such_run(run);
}

std::vector<db::RunId> numbers(const JsonReader& in, std::string_view key) {
  std::vector<db::RunId> out;
  if (!in.has(key)) return out;
  in.each(key, kMostRuns, [&](const json& value, const std::string& path) {
    if (!value.is_number_unsigned()) throw DocumentError(path, "is not a run's number");
    out.push_back(value.get<db::RunId>());
  });
  return out;
}

/// The runs that a request names one by one or by their batch, each once.
std::vector<db::RunId> named_runs(ApiContext& context, const JsonReader& in) {
  std::vector<db::RunId> runs = numbers(in, "ids");
  const std::vector<db::RunId> batches = numbers(in, "batches");
  if (runs.empty() && batches.empty()) {
    throw DocumentError("ids", "name at least one run, or a batch in 'batches'");
  }
  for (const db::RunId batch : batches) {
    const auto of_batch =
        context.recorder.ask([&](db::RunStore& store) { return store.runs_of_batch(batch); });
    runs.insert(runs.end(), of_batch.begin(), of_batch.end());
  }
  std::ranges::sort(runs);
  const auto twice = std::ranges::unique(runs);
  runs.erase(twice.begin(), twice.end());
  return runs;
}

/// `change(store, run)` changes one run and returns why it does not, else "". Works in slices, so
/// that the frames of live runs do not wait for all of them.
template <typename Change>
net::Response change_runs(ApiContext& context, const JsonReader& in, const Change& change) {
  const std::vector<db::RunId> runs = named_runs(context, in);
  json changed = json::array();
  json refused = json::array();
  for (std::size_t from = 0; from < runs.size(); from += kEditSlice) {
    const auto slice = std::span(runs).subspan(from, std::min(kEditSlice, runs.size() - from));
    const auto refusals = context.recorder.ask([&](db::RunStore& store) {
      std::vector<std::string> out;
      for (const db::RunId run : slice) out.push_back(change(store, run));
      return out;
    });
    for (std::size_t i = 0; i < slice.size(); ++i) {
      if (refusals[i].empty()) changed.push_back(slice[i]);
      if (!refusals[i].empty()) refused.push_back({{"id", slice[i]}, {"why", refusals[i]}});
    }
  }
  return json_response(200, {{"runs", std::move(changed)}, {"refused", std::move(refused)}});
}

std::string no_run(db::RunId run) {
  return fmt::format("There is no run {}.", run);
}

net::Response trash_runs(ApiContext& context, const net::Request& request, Worker&) {
  const json body = body_json(request);
  const JsonReader in(body, "");
  in.only({"ids", "batches"});
  const std::int64_t now = std::chrono::duration_cast<std::chrono::seconds>(
                               std::chrono::system_clock::now().time_since_epoch())
                               .count();
  const auto trash = [now](db::RunStore& store, db::RunId run) -> std::string {
    switch (store.trash(run, now)) {
      case db::RunStore::Deletion::Deleted:
        return "";
      case db::RunStore::Deletion::StillRecording:
        return "Cancel or end the run first.";
      default:
        return no_run(run);
    }
  };
  return change_runs(context, in, trash);
}

net::Response restore_runs(ApiContext& context, const net::Request& request, Worker&) {
  const json body = body_json(request);
  const JsonReader in(body, "");
  in.only({"ids"});
  const auto restore = [](db::RunStore& store, db::RunId run) -> std::string {
    return store.restore(run) ? "" : fmt::format("Run {} cannot be restored any more.", run);
  };
  return change_runs(context, in, restore);
}

net::Response cancel_runs(ApiContext& context, const net::Request& request, Worker&) {
  const json body = body_json(request);
  const JsonReader in(body, "");
  in.only({"ids", "batches"});
  const auto cancel = [&context](db::RunStore&, db::RunId run) -> std::string {
    return context.queue.cancel(run) ? "" : "The run is neither queued nor running.";
  };
  return change_runs(context, in, cancel);
}

net::Response tag_runs(ApiContext& context, const net::Request& request, Worker&) {
  const json body = body_json(request);
  const JsonReader in(body, "");
  in.only({"ids", "batches", "add", "remove"});
  const auto tag = [added = tags_from(in, "add"), removed = tags_from(in, "remove")](
                       db::RunStore& store, db::RunId run) -> std::string {
    return store.change_tags(run, added, removed) ? "" : no_run(run);
  };
  return change_runs(context, in, tag);
}

}  // namespace

void add_run_edit_routes(Routes& routes) {
  routes.make("PATCH", "/runs/{id}", remark);
  routes.make("POST", "/runs/delete", trash_runs);
  routes.make("POST", "/runs/restore", restore_runs);
  routes.make("POST", "/runs/cancel", cancel_runs);
  routes.make("POST", "/runs/tag", tag_runs);
}

}  // namespace server
