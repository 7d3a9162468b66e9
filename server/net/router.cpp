// server/net/router.cpp: a linear search over a few dozen routes.
#include "server/net/router.hpp"

#include <set>
#include <string_view>
#include <utility>

namespace server::net {
namespace {

std::string_view next_segment(std::string_view& rest) {
  const std::size_t slash = rest.find('/');
  const std::string_view segment = rest.substr(0, slash);
  rest = slash == std::string_view::npos ? std::string_view{} : rest.substr(slash + 1);
  return segment;
}

bool matches(std::string_view pattern,
             std::string_view path,
             std::map<std::string, std::string>& params) {
  std::size_t slashes = 0;
  for (const char c : pattern) slashes += c == '/' ? 1 : 0;
  for (const char c : path) slashes -= c == '/' ? 1 : 0;
  if (slashes != 0) return false;
  while (!pattern.empty() || !path.empty()) {
    const std::string_view want = next_segment(pattern);
    const std::string_view have = next_segment(path);
    if (want.size() > 2 && want.front() == '{') {
      if (have.empty()) return false;
      params[std::string(want.substr(1, want.size() - 2))] = std::string(have);
    } else if (want != have) {
      return false;
    }
  }
  return true;
}

}  // namespace

void Router::add(std::string method, std::string pattern, Handler handler) {
  routes_.push_back({std::move(method), std::move(pattern), std::move(handler)});
}

void Router::dispatch(Request& request, const Responder& respond) const {
  const std::string wanted = request.method == "HEAD" ? "GET" : request.method;
  std::set<std::string> allowed;
  for (const Route& route : routes_) {
    std::map<std::string, std::string> params;
    if (!matches(route.pattern, request.path, params)) continue;
    if (route.method == wanted) {
      request.params = std::move(params);
      route.handler(request, respond);
      return;
    }
    allowed.insert(route.method);
  }
  if (allowed.empty()) {
    respond(problem(404, "Not found", "There is nothing at " + request.path + "."));
    return;
  }
  std::string allow;
  for (const std::string& method : allowed) allow += (allow.empty() ? "" : ", ") + method;
  Response response = problem(
      405, "Method not allowed", request.method + " is not possible here; " + allow + " is.");
  response.headers.emplace_back("Allow", allow);
  respond(std::move(response));
}

}  // namespace server::net
