// server/serve/net/router.cpp: matches segment by segment; there are about thirty routes.
#include "server/serve/net/router.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace server::net {
namespace {

std::vector<std::string> split(std::string_view path) {
  std::vector<std::string> segments;
  path.remove_prefix(std::min<std::size_t>(1, path.size()));
  while (true) {
    const std::size_t slash = path.find('/');
    segments.emplace_back(path.substr(0, slash));
    if (slash == std::string_view::npos) return segments;
    path.remove_prefix(slash + 1);
  }
}

bool is_parameter(std::string_view segment) {
  return segment.size() > 2 && segment.front() == '{' && segment.back() == '}';
}

bool matches(const std::vector<std::string>& pattern, const std::vector<std::string>& path) {
  return std::equal(pattern.begin(),
                    pattern.end(),
                    path.begin(),
                    path.end(),
                    [](const std::string& p, const std::string& s) {
                      return is_parameter(p) ? !s.empty() : p == s;
                    });
}

/// The refusal of the first query that is not among `known`.
std::optional<std::string> unknown_query(const Request& request,
                                         const std::optional<std::vector<std::string>>& known) {
  if (!known) return std::nullopt;
  for (const auto& [name, value] : request.query) {
    if (std::ranges::count(*known, name) > 0) continue;
    return fmt::format("{} {} does not know the query '{}'; it takes {}",
                       request.method,
                       request.path,
                       name,
                       known->empty() ? "none" : fmt::format("{}", fmt::join(*known, ", ")));
  }
  return std::nullopt;
}

}  // namespace

void Router::add(std::string method, std::string pattern, Handler handler, std::size_t body_bytes) {
  if (pattern.empty() || pattern.front() != '/') {
    throw std::invalid_argument("route pattern '" + pattern + "' does not start with '/'");
  }
  for (const Route& route : routes_) {
    if (route.method == method && route.pattern == pattern) {
      throw std::invalid_argument(fmt::format("route {} {} is there already", method, pattern));
    }
  }
  const Role needed = method == "GET" ? Role::Nobody : Role::Operator;
  entries_.push_back({split(pattern), std::move(handler), body_bytes, needed});
  routes_.push_back({std::move(method), std::move(pattern)});
}

void Router::add(std::string method,
                 std::string pattern,
                 SyncHandler handler,
                 std::size_t body_bytes) {
  add(std::move(method),
      std::move(pattern),
      Handler([answer = std::move(handler)](const Request& request, const Responder& responder) {
        responder(answer(request));
      }),
      body_bytes);
}

void Router::take_queries(std::string_view method,
                          std::string_view pattern,
                          std::vector<std::string> names) {
  for (std::size_t i = 0; i < routes_.size(); ++i) {
    if (routes_[i].method == method && routes_[i].pattern == pattern) {
      entries_[i].queries = std::move(names);
      return;
    }
  }
}

void Router::need(std::string_view method, std::string_view pattern, Role role) {
  for (std::size_t i = 0; i < routes_.size(); ++i) {
    if (routes_[i].method != method || routes_[i].pattern != pattern) continue;
    entries_[i].needed = role;
    return;
  }
  throw std::invalid_argument(fmt::format("there is no route {} {}", method, pattern));
}

bool Router::knows(std::string_view path) const {
  const std::vector<std::string> segments = split(path);
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return matches(entry.segments, segments);
  });
}

std::size_t Router::body_limit(std::string_view method, std::string_view path) const {
  const std::vector<std::string> segments = split(path);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (routes_[i].method == method && matches(entries_[i].segments, segments)) {
      return entries_[i].body_bytes;
    }
  }
  return kAnyBody;
}

const Router::Entry* Router::find(Request& request, std::string& allow) const {
  const std::vector<std::string> segments = split(request.path);
  const std::string& method = request.method == "HEAD" ? "GET" : request.method;
  // A path that is itself a pattern matches no parameter: /runs/delete is not the run "delete".
  const bool literal = std::ranges::count(entries_, segments, &Entry::segments) > 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    if (literal ? entry.segments != segments : !matches(entry.segments, segments)) continue;
    if (routes_[i].method != method) {
      allow.append(allow.empty() ? "" : ", ").append(routes_[i].method);
      if (routes_[i].method == "GET") allow += ", HEAD";
      continue;
    }
    for (std::size_t s = 0; s < segments.size(); ++s) {
      const std::string& name = entry.segments[s];
      if (is_parameter(name)) request.params[name.substr(1, name.size() - 2)] = segments[s];
    }
    return &entry;
  }
  return nullptr;
}

std::string Router::dispatch(Request& request, const Responder& responder) const {
  std::string allow;
  const Entry* const entry = find(request, allow);
  if (entry == nullptr && allow.empty()) {
    responder(problem(404, "there is nothing at " + request.path));
    return {};
  }
  if (entry == nullptr) {
    Response response =
        problem(405, request.path + " does not take " + request.method + ", only " + allow);
    response.headers.push_back({"Allow", allow});
    responder(std::move(response));
    return {};
  }
  if (request.role < entry->needed) {
    responder(problem(403, role_refusal(request.role, entry->needed)));
    return {};
  }
  if (const auto stranger = unknown_query(request, entry->queries)) {
    responder(problem(400, *stranger));
    return {};
  }
  try {
    entry->handler(request, responder);
  } catch (const HttpError& error) {
    responder(problem(error.status(), error.what()));
  } catch (const std::exception& error) {
    responder(problem(500, std::string("this request failed inside the server: ") + error.what()));
    return error.what();
  } catch (...) {
    responder(problem(500, "this request failed inside the server"));
    return "an exception of unknown type";
  }
  return {};
}

}  // namespace server::net
