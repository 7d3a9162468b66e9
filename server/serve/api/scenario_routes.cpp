// server/serve/api/scenario_routes.cpp: scenarios and robots by name; only the user's own can be
// changed.
#include "server/run/json_reader.hpp"
#include "server/run/robot_json.hpp"
#include "server/run/scenario_json.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/api/reply.hpp"

namespace server {
namespace {

using nlohmann::json;

json entry_json(const ScenarioEntry& entry) {
  return {{"name", entry.name},
          {"title", entry.title},
          {"description", entry.description},
          {"builtin", entry.builtin},
          {"kind", entry.is_log ? "log" : "world"}};
}

json robots_json(const RobotLibrary& robots) {
  json items = json::array();
  for (const RobotEntry& entry : robots.list()) {
    items.push_back({{"name", entry.name},
                     {"title", entry.title},
                     {"description", entry.description},
                     {"builtin", entry.builtin},
                     {"usable", entry.usable}});
    if (entry.usable) items.back()["model"] = robot_document(robots.load(entry.name));
  }
  return {{"items", std::move(items)}, {"next", nullptr}};
}

}  // namespace

sim::Scenario keep_scenario(const ApiContext& context, const sim::Scenario& scenario) {
  make_robot(
      make_spec(context.library.placed(scenario), {.controllers = context.first.controllers}));
  return context.library.save(scenario);
}

void add_scenario_routes(Routes& routes) {
  routes.make("GET", "/robots", [](ApiContext& context, const net::Request&, Worker&) {
    return json_response(200, robots_json(context.library.robots()));
  });
  routes.make("GET", "/scenarios", [](ApiContext& context, const net::Request&, Worker&) {
    json items = json::array();
    for (const ScenarioEntry& entry : context.library.list()) items.push_back(entry_json(entry));
    return json_response(200, {{"items", std::move(items)}, {"next", nullptr}});
  });
  routes.make(
      "GET", "/scenarios/{name}", [](ApiContext& context, const net::Request& request, Worker&) {
        return json_response(200, server::to_json(context.library.load(request.params.at("name"))));
      });
  routes.make(
      "PUT", "/scenarios/{name}", [](ApiContext& context, const net::Request& request, Worker&) {
        json body = body_json(request);
        const std::string name = request.params.at("name");
        if (body.is_object() && !body.contains("name")) body["name"] = name;
        const sim::Scenario scenario = scenario_from_json(body, context.library.robots());
        if (scenario.name != name) throw DocumentError("name", "differs from the name in the path");
        return json_response(200, server::to_json(keep_scenario(context, scenario)));
      });
  routes.make(
      "DELETE", "/scenarios/{name}", [](ApiContext& context, const net::Request& request, Worker&) {
        context.library.remove(request.params.at("name"));
        return net::Response{.status = 204};
      });
}

}  // namespace server
