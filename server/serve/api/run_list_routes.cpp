// server/serve/api/run_list_routes.cpp: the list of runs: search, order, pages, counts.
#include <algorithm>
#include <cctype>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "server/record/run_json.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/json_reader.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/api/reply.hpp"
#include "server/serve/api/run_reply.hpp"

namespace server {

using nlohmann::json;

db::RunId run_id(const net::Request& request) {
  const std::string& text = request.params.at("id");
  const auto number = whole_number(text);
  if (!number) throw DocumentError("id", fmt::format("'{}' is not a run's number", text));
  return static_cast<db::RunId>(*number);
}

net::Response no_such_run(db::RunId run) {
  return net::problem(404, "Not found", fmt::format("There is no run {}.", run));
}

void append_item(std::string& list, const json& item) {
  if (list.size() > 1) list += ',';
  list += dump_json(item);
}

net::Response page_response(std::string list, const json& next, const std::string& more) {
  return net::json_response(
      200, "{\"items\":" + std::move(list) + "],\"next\":" + next.dump() + more + '}');
}

namespace {

constexpr std::size_t kMostWords = 10;

/// A query that is there and not empty.
std::optional<std::string> query_of(const net::Request& request, const std::string& name) {
  const auto it = request.query.find(name);
  if (it == request.query.end() || it->second.empty()) return std::nullopt;
  return it->second;
}

[[noreturn]] void refuse(const std::string& name,
                         const std::string& value,
                         const std::string& known) {
  throw DocumentError("?" + name, fmt::format("'{}' is unknown; known are {}", value, known));
}

/// The words of the search in lower case, as the store compares them.
std::vector<std::string> words_of(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) {
    return static_cast<char>(c < 0x80 ? std::tolower(c) : c);
  });
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  if (words.size() > kMostWords) {
    throw DocumentError("?q", fmt::format("has more than {} words", kMostWords));
  }
  return words;
}

db::RunFilter filter_of(const net::Request& request) {
  db::RunFilter filter;
  filter.scenario = query_of(request, "scenario");
  filter.controller = query_of(request, "controller");
  filter.outcome = query_of(request, "outcome");
  filter.result = query_of(request, "result");
  filter.tag = query_of(request, "tag");
  if (const auto status = query_of(request, "status")) {
    filter.status = db::find_status(*status);
    if (!filter.status) {
      refuse("status", *status, "queued, recording, finished, interrupted, cancelled, failed");
    }
  }
  if (const auto kind = query_of(request, "kind")) {
    filter.kind = db::find_kind(*kind);
    if (!filter.kind) refuse("kind", *kind, "session, background");
  }
  if (query_of(request, "seed")) filter.seed = number_of(request, "seed", 0);
  if (query_of(request, "batch")) {
    filter.batch = static_cast<db::RunId>(number_of(request, "batch", 0));
  }
  filter.words = words_of(query_of(request, "q").value_or(""));
  return filter;
}

db::RunOrder order_of(const net::Request& request) {
  db::RunOrder order;
  order.by = query_of(request, "sort").value_or("id");
  const auto names = db::sort_names();
  if (std::ranges::find(names, order.by) == names.end()) {
    refuse("sort", order.by, fmt::format("{}", fmt::join(names, ", ")));
  }
  const std::string direction = query_of(request, "order").value_or("desc");
  if (direction != "asc" && direction != "desc") refuse("order", direction, "asc, desc");
  order.descending = direction == "desc";
  const auto group = query_of(request, "group");
  if (group && *group != "batch") refuse("group", *group, "batch");
  order.grouped = group.has_value();
  return order;
}

net::Response list_runs(ApiContext& context, const net::Request& request, Worker& worker) {
  const db::RunFilter filter = filter_of(request);
  const db::RunOrder order = order_of(request);
  const auto cursor = query_of(request, "cursor");
  const std::size_t limit = limit_of(request, 50, 500);
  db::RunReader& reader = worker.runs();
  db::RunPage page;
  try {
    page = reader.list(filter, limit, cursor, order, context.room.page());
  } catch (const std::invalid_argument& error) {
    throw DocumentError("?cursor", error.what());
  }
  std::string list = "[";
  for (const db::RunRow& row : page.runs) append_item(list, to_json(row));
  std::string more;
  if (!cursor) {
    more = fmt::format(",\"total\":{},\"results\":{}",
                       reader.count(filter, order.grouped),
                       json(reader.results(filter)).dump());
  }
  return page_response(std::move(list), page.next ? json(*page.next) : json(nullptr), more);
}

}  // namespace

void add_run_list_routes(Routes& routes) {
  routes.make("GET", "/runs", list_runs);
}

}  // namespace server
