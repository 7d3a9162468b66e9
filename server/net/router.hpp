// server/net/router.hpp: method and pattern to handler.
#pragma once

#include <string>
#include <vector>

#include "server/net/http.hpp"

namespace server::net {

class Router {
 public:
  /// `pattern`: "/api/v1/runs/{id}"; a parameter is one path segment.
  void add(std::string method, std::string pattern, Handler handler);

  /// Calls the matching handler; 404, or 405 with Allow, when there is none. HEAD is served as GET.
  void dispatch(Request& request, const Responder& respond) const;

  struct Route {
    std::string method{};
    std::string pattern{};
    Handler handler{};
  };
  const std::vector<Route>& routes() const { return routes_; }

 private:
  std::vector<Route> routes_{};
};

}  // namespace server::net
