// server/serve/net/router.hpp: maps method and path pattern to a handler; answers 404 and 405
// itself.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/serve/net/http.hpp"

namespace server::net {

using Handler = std::function<void(const Request&, Responder)>;
using SyncHandler = std::function<Response(const Request&)>;

class Router {
 public:
  struct Route {
    std::string method{};
    std::string pattern{};  // "/api/v1/runs/{id}"; a {name} matches one non-empty segment
  };

  /// Routes are tried in the order added. A body of more than `body_bytes`, or more than the
  /// server's own limit, gets 413. Throws std::invalid_argument on a pattern that does not start
  /// with '/' or on a route added twice.
  void add(std::string method,
           std::string pattern,
           Handler handler,
           std::size_t body_bytes = kAnyBody);
  /// Adds a route whose handler answers at once.
  void add(std::string method,
           std::string pattern,
           SyncHandler handler,
           std::size_t body_bytes = kAnyBody);
  /// From now on a request of this route that names another query than `names` gets 400. No effect
  /// on a route that does not exist.
  void take_queries(std::string_view method,
                    std::string_view pattern,
                    std::vector<std::string> names);
  static constexpr std::size_t kAnyBody = std::numeric_limits<std::size_t>::max();
  /// Sets who may use a route; without this, everybody who is let in may read (GET) and operators
  /// may do the rest. Throws std::invalid_argument if there is no such route.
  void need(std::string_view method, std::string_view pattern, Role role);

  /// True if a pattern of any method matches `path`.
  bool knows(std::string_view path) const;
  /// Largest body for this method and path [bytes].
  std::size_t body_limit(std::string_view method, std::string_view path) const;
  /// Calls the handler with request.params filled; answers 404, or 405 with Allow, if there is
  /// none, 403 if the request's role may not. HEAD runs the handler of GET. An HttpError becomes
  /// its problem, any other exception 500.
  /// @return what() of an exception that became 500, else empty
  std::string dispatch(Request& request, const Responder& responder) const;

  /// All routes in the order added, for the test that compares them with the OpenAPI file.
  const std::vector<Route>& routes() const { return routes_; }

 private:
  struct Entry {
    std::vector<std::string> segments{};
    Handler handler{};
    std::size_t body_bytes = kAnyBody;
    Role needed = Role::Nobody;
    std::optional<std::vector<std::string>> queries{};  // unset: any
  };
  const Entry* find(Request& request, std::string& allow) const;

  std::vector<Route> routes_{};
  std::vector<Entry> entries_{};  // same order as routes_
};

}  // namespace server::net
