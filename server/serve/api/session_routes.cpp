// server/serve/api/session_routes.cpp: a session: goal, obstacles, parameters, control.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "algo/pipeline/parameter_table.hpp"
#include "server/run/arm_json.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/map_robot.hpp"
#include "server/run/obstacle_json.hpp"
#include "server/run/request_json.hpp"
#include "server/run/scenario_json.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/api/reply.hpp"
#include "server/serve/driving.hpp"
#include "server/serve/session_json.hpp"

namespace server {
namespace {

using nlohmann::json;
/// The key of a lease, in each request of a script that drives.
constexpr std::string_view kLeaseHeader = "X-Tautline-Lease";

void busy(const net::Responder& respond) {
  net::Response response =
      net::problem(503, "Busy", "More is waiting to be done than this robot can take. Try again.");
  response.headers.push_back({"Retry-After", "1"});
  respond(std::move(response));
}

/// Answers with the session after the load, or with the reason why the current run goes on.
SessionLoader::Done answer_when_loaded(OpenSession& open, const net::Responder& respond) {
  return [&open, respond](const std::exception_ptr& failure) {
    if (failure) {
      respond(problem_of(failure));
    } else {
      respond(json_response(200, state_json(open.session())));
    }
  };
}

Sender sender(const net::Request& from) {
  return {{Party::kNoClient, from.visitor().label(), from.role},
          std::string(from.header(kLeaseHeader))};
}

/// Throws the 409 that says why not.
void heed(const std::optional<std::string>& refusal) {
  if (refusal) throw net::HttpError(409, *refusal);
}

/// Submits a request. Answers after the control thread has, or at once for a Stop: `status`, or 409
/// with the reason.
void submit_and_reply(Session& session,
                      StampedRequest request,
                      const net::Request& from,
                      const net::Responder& respond,
                      int status = 200) {
  require(from, needed_for(request.request));
  heed(admit(session, sender(from), request));
  const bool taken = submit(
      session,
      std::move(request.request),
      [respond, status](const json& body) { respond(json_response(status, body)); },
      [respond](const std::string& refusal) { respond(net::problem(409, refusal)); },
      from.visitor().label());
  if (!taken) busy(respond);
}

std::uint32_t obstacle_id(const net::Request& request) {
  const std::string& text = request.params.at("id");
  const std::uint64_t id = whole_number(text, 10).value_or(kMaxStandingId + 1);
  if (id > kMaxStandingId) {
    throw DocumentError("id", fmt::format("'{}' is not an obstacle's number", text));
  }
  return static_cast<std::uint32_t>(id);
}

json obstacle_list(const Session& session) {
  json items = json::array();
  for (const algo::Obstacle& o : session.obstacles()) items.push_back(to_json(o));
  return {{"items", std::move(items)}, {"next", nullptr}};
}

/// The values of `body` in an order that keeps the parameters valid after each step; empty if there
/// is no such order.
std::vector<algo::SetParameter> in_safe_order(const json& body, algo::Parameters now) {
  std::vector<algo::SetParameter> left;
  for (const auto& [name, value] : body.items()) {
    if (const auto* p = algo::find_parameter(name)) left.push_back({p, value.get<double>()});
  }
  std::vector<algo::SetParameter> order;
  while (!left.empty()) {
    const auto next = std::find_if(left.begin(), left.end(), [&](const auto& set) {
      return !algo::refusal(now, *set.parameter, set.value);
    });
    if (next == left.end()) return {};
    now.set(*next->parameter, next->value);
    order.push_back(*next);
    left.erase(next);
  }
  return order;
}

/// All values are checked together before the first is submitted.
void patch_parameters(Session& session, const net::Request& from, const net::Responder& respond) {
  heed(admit_deed(session, sender(from)));
  const json body = body_json(from);
  const algo::Parameters& now = session.state().asked.parameters;
  parameters_from_json(body, "", now);
  const std::vector<algo::SetParameter> order = in_safe_order(body, now);
  if (order.empty()) {
    if (!body.empty()) throw net::HttpError(409, "Change these one at a time.");
    respond(json_response(200, to_json(now)));
    return;
  }
  const auto left = std::make_shared<std::size_t>(order.size());
  const auto refused = std::make_shared<std::string>();
  for (const algo::SetParameter& set : order) {
    const auto given = session.submit(
        set, [&session, respond, left, refused](const std::optional<std::string>& refusal) {
          if (refusal) *refused = *refusal;
          if (--*left > 0) return;
          respond(refused->empty() ? json_response(200, to_json(session.state().asked.parameters))
                                   : net::problem(409, *refused));
        });
    if (!given) {
      busy(respond);
      return;
    }
  }
}

void control(ApiContext& context,
             OpenSession& open,
             const net::Request& from,
             const net::Responder& respond) {
  const json body = body_json(from);
  const JsonReader in(body, "");
  const std::string action = in.text("action", 32);
  const std::string who = from.visitor().label();
  require(from, action == "stop" ? net::Role::Viewer : net::Role::Operator);
  Session& session = open.session();
  if (action != "stop") heed(admit_deed(session, sender(from)));
  if (action == "pause" || action == "step" || action == "speed") {
    heed(session.pace_refusal());
  }
  if (action == "load") {
    json load = body;
    load.erase("action");
    if (!load_from_json(context, open, load, answer_when_loaded(open, respond))) {
      return busy(respond);
    }
    tell_deed(session, who, "loads another run");
    return;
  } else if (action == "step") {
    in.only({"action", "ticks"});
    if (!session.state().pace.paused) session.credits.pause = who;
    session.single_step(static_cast<std::uint32_t>(in.whole_or("ticks", 1, 1'000'000)));
  } else if (action == "speed") {
    in.only({"action", "speed"});
    in.number("speed");
    session.set_speed(pace_from_json(body, "speed", 1));
  } else if (action == "stop" || action == "release") {
    in.only({"action"});
    submit_and_reply(session, {algo::Stop{action == "stop"}, {}}, from, respond);
    return;
  } else if (action == "arm" || action == "disarm") {
    in.only({"action"});
    heed(session.arm(action == "arm", who));
  } else if (action == "play" || action == "pause") {
    in.only({"action"});
    pause(session, action == "pause", who);
  } else if (action == "reset") {
    in.only({"action"});
    if (!open.loader().reset(answer_when_loaded(open, respond))) return busy(respond);
    tell_deed(session, who, "resets the run");
    return;
  } else {
    in.fail("action",
            fmt::format("'{}' is unknown; known are play, pause, step, speed, reset, stop, "
                        "release, arm, disarm, load",
                        action));
  }
  respond(json_response(200, state_json(session)));
}

void save_scenario(ApiContext& context,
                   OpenSession& open,
                   const json& body,
                   const net::Responder& respond) {
  const Session& session = open.session();
  const JsonReader in(body, "");
  in.only({"name", "title"});
  const std::string name = in.text("name", 64);
  if (!session.state().spec.scenario.log.empty()) {
    throw net::HttpError(409, "A recorded log is playing: there is no world to save.");
  }
  sim::Scenario scenario = session.as_scenario();
  scenario.name = name;
  scenario.title = in.text_or("title", name);
  answer_from_worker(context, respond, [&context, scenario, id = open.id()](Worker&) {
    const sim::Scenario kept = keep_scenario(context, scenario);
    context.post_to_io([&context, scenario, id] {
      if (OpenSession* const still = context.sessions.find(id)) still->session().saved(scenario);
    });
    net::Response response = json_response(201, to_json(kept));
    response.headers.push_back({"Location", "/api/v1/scenarios/" + kept.name});
    return response;
  });
}

/// A pose moves obstacle `id`; a whole obstacle replaces it.
algo::Request edit_of(json body, std::uint32_t id) {
  if (body.is_object() && body.contains("type")) {
    body["id"] = id;
    return request_from_json({{"type", "change_obstacle"}, {"obstacle", std::move(body)}});
  }
  JsonReader(body, "").only({"x", "y", "heading"});
  body["type"] = "move_obstacle";
  body["id"] = id;
  return request_from_json(body);
}

std::vector<algo::LinePixel> pixels_from_json(const JsonReader& line) {
  constexpr NumberRange kWithinAFloat{-1e6, 1e6};
  std::vector<algo::LinePixel> pixels;
  for (const json& point : line.array("pixels", SIZE_MAX)) {
    if (!point.is_array() || point.size() != 2) line.fail("pixels", "must be pairs of numbers");
    const auto coordinate = [&](std::size_t i) {
      return static_cast<float>(finite_number(point[i], "line.pixels", kWithinAFloat));
    };
    pixels.push_back({coordinate(0), coordinate(1)});
  }
  return pixels;
}

/// {"inclinometer": {"roll", "pitch", "age"?}, "line": {"pixels": [[u, v], ...], "age"?}}, one of
/// them at least. The robot knows the limits.
void publish(Session& session, const json& body, const net::Responder& respond) {
  const JsonReader in(body, "");
  in.only({"inclinometer", "line"});
  if (body.empty()) in.fail("inclinometer", "is missing, and so is 'line'");
  algo::Publishing* const robot = session.publishing();
  if (robot == nullptr) {
    throw net::HttpError(409,
                         "This robot takes no published readings: only one of real devices does, "
                         "if its file says so.");
  }
  std::optional<std::string> refusal;
  if (in.has("inclinometer")) {
    const JsonReader tilt = in.object("inclinometer");
    tilt.only({"roll", "pitch", "age"});
    refusal =
        robot->publish_tilt(tilt.number("roll"), tilt.number("pitch"), tilt.number_or("age", 0));
  }
  if (in.has("line") && !refusal) {
    const JsonReader line = in.object("line");
    line.only({"pixels", "age"});
    refusal = robot->publish_line(pixels_from_json(line), line.number_or("age", 0));
  }
  heed(refusal);
  respond(json_response(200, {{"ok", true}}));
}

using SessionHandler =
    std::function<void(OpenSession&, const net::Request&, const net::Responder&)>;

/// A route whose body is a request of `type`, with these fields.
SessionHandler request_route(const char* type, std::vector<std::string_view> fields) {
  return [type, fields = std::move(fields)](
             OpenSession& open, const net::Request& request, const net::Responder& respond) {
    json body = body_json(request);
    JsonReader(body, "").only(fields);
    body["type"] = type;
    submit_and_reply(open.session(), {request_from_json(body), {}}, request, respond);
  };
}

/// Adds each route twice: for the session `main`, and for any session by its id.
class SessionRoutes {
 public:
  SessionRoutes(net::Router& router, ApiContext& context) : router_(router), context_(context) {}

  /// A script that only reads may be a cron job; one that sends a request shows that an operator is
  /// there.
  enum class Sign : std::uint8_t { OfLife, None };

  void add(const std::string& method,
           const std::string& path,
           const SessionHandler& handler,
           Sign sign = Sign::OfLife) {
    for (const char* prefix : kPrefixes) {
      router_.add(method,
                  prefix + path,
                  guarded([&context = context_, handler, sign](const net::Request& request,
                                                               const net::Responder& respond) {
                    OpenSession& open = asked_for(context, request);
                    if (sign == Sign::OfLife && request.role >= net::Role::Operator) {
                      open.session().watch().script_sign(OperatorWatch::Clock::now());
                    }
                    handler(open, request, respond);
                  }),
                  kRequestBytes);
    }
  }
  void need(const std::string& method, const std::string& path, net::Role role) {
    for (const char* prefix : kPrefixes) router_.need(method, prefix + path, role);
  }
  void get(const std::string& path, json (*document)(const Session&)) {
    add(
        "GET",
        path,
        [document](OpenSession& open, const net::Request&, const net::Responder& respond) {
          respond(json_response(200, document(open.session())));
        },
        Sign::None);
  }

 private:
  static constexpr std::array<const char*, 2> kPrefixes{"/api/v1/session",
                                                        "/api/v1/sessions/{session}"};

  static OpenSession& asked_for(ApiContext& context, const net::Request& request) {
    const auto id = request.params.find("session");
    if (id == request.params.end()) return context.sessions.main();
    OpenSession* const found = context.sessions.find(id->second);
    if (found == nullptr) throw net::HttpError(404, std::string(SessionRegistry::kGone));
    return *found;
  }

  net::Router& router_;
  ApiContext& context_;
};

json scenario_document(const Session& session) {
  return to_json(session.as_scenario());
}

json parameters_document(const Session& session) {
  return to_json(session.state().asked.parameters);
}

}  // namespace

void add_session_routes(net::Router& router, ApiContext& context) {
  using Sign = SessionRoutes::Sign;
  using net::Request;
  using net::Responder;
  SessionRoutes routes(router, context);
  routes.get("", session_json);
  routes.get("/obstacles", obstacle_list);
  routes.get("/parameters", parameters_document);
  routes.get("/scenario", scenario_document);
  routes.add("POST", "/watch", [](OpenSession&, const Request& request, const Responder& respond) {
    if (!request.body.empty()) JsonReader(body_json(request), "").only({});
    respond(json_response(200, {{"ok", true}}));
  });
  // No sign of life: a process beside the robot cannot see whether it should stop.
  routes.add(
      "POST",
      "/published",
      [](OpenSession& open, const Request& request, const Responder& respond) {
        publish(open.session(), body_json(request), respond);
      },
      Sign::None);
  routes.add(
      "POST", "/lease", [](OpenSession& open, const Request& request, const Responder& respond) {
        try {
          respond(json_response(200,
                                lease_action(open.session(), sender(request), body_json(request))));
        } catch (const LeaseRefusal& refusal) {
          throw net::HttpError(409, refusal.what());
        }
      });
  routes.add(
      "GET",
      "/clock",
      [](OpenSession&, const Request&, const Responder& respond) {
        respond(json_response(200, {{"now", clock_seconds(StickWatch::Clock::now())}}));
      },
      Sign::None);
  routes.add(
      "POST",
      "/goal/check",
      [](OpenSession& open, const Request& request, const Responder& respond) {
        if (open.session().may_look_at_goals()) {
          respond(json_response(200, goal_check_json(open.session(), body_json(request))));
        } else {
          busy(respond);
        }
      },
      Sign::None);
  routes.add(
      "POST", "/requests", [](OpenSession& open, const Request& request, const Responder& respond) {
        submit_and_reply(open.session(),
                         stamped_request_from_json(open.session(), body_json(request)),
                         request,
                         respond);
      });
  routes.add("PUT", "/goal", request_route("set_goal", {"x", "y", "heading"}));
  routes.add("POST", "/goal", request_route("add_goal", {"x", "y", "heading"}));
  routes.add("PUT",
             "/hand_goal",
             request_route("set_hand_goal", {kHandGoalFields.begin() + 1, kHandGoalFields.end()}));
  routes.add("PUT", "/pose", request_route("set_initial_pose", {"x", "y", "heading"}));
  routes.add(
      "DELETE", "/pose", [](OpenSession& open, const Request& request, const Responder& respond) {
        submit_and_reply(open.session(), {algo::SetInitialPose{}, {}}, request, respond);
      });
  routes.add(
      "GET",
      "/map",
      [](OpenSession& open, const Request&, const Responder& respond) {
        const auto& map = open.session().state().spec.map;
        if (map == nullptr) throw net::HttpError(404, "The robot of this session knows no map.");
        respond(net::json_response(200, map->document));
      },
      Sign::None);
  routes.add("PUT", "/joints", request_route("set_joints", {"position"}));
  routes.add(
      "DELETE", "/goal", [](OpenSession& open, const Request& request, const Responder& respond) {
        submit_and_reply(open.session(), {algo::ClearGoal{}, {}}, request, respond);
      });
  routes.add("POST",
             "/obstacles",
             [](OpenSession& open, const Request& request, const Responder& respond) {
               algo::AddObstacle add{obstacle_from_json(body_json(request), "")};
               submit_and_reply(open.session(), {std::move(add), {}}, request, respond, 201);
             });
  routes.add(
      "PUT",
      "/obstacles/{id}",
      [](OpenSession& open, const Request& request, const Responder& respond) {
        json body = body_json(request);
        submit_and_reply(
            open.session(), {edit_of(std::move(body), obstacle_id(request)), {}}, request, respond);
      });
  routes.add("PUT", "/goals", request_route("set_goals", {"goals", "next", "loop"}));
  routes.add(
      "PUT", "/start", [](OpenSession& open, const Request& request, const Responder& respond) {
        heed(admit_deed(open.session(), sender(request)));
        heed(set_start(open.session(), body_json(request)));
        respond(json_response(200, {{"ok", true}}));
      });
  routes.add("DELETE",
             "/obstacles/{id}",
             [](OpenSession& open, const Request& request, const Responder& respond) {
               const algo::RemoveObstacle remove{obstacle_id(request)};
               submit_and_reply(open.session(), {remove, {}}, request, respond);
             });
  routes.add("PATCH",
             "/parameters",
             [](OpenSession& open, const Request& request, const Responder& respond) {
               patch_parameters(open.session(), request, respond);
             });
  routes.add("POST",
             "/control",
             [&context](OpenSession& open, const Request& request, const Responder& respond) {
               control(context, open, request, respond);
             });
  routes.need("POST", "/control", net::Role::Viewer);  // for Stop; the handlers look closer
  routes.need("POST", "/requests", net::Role::Viewer);
  routes.add("POST",
             "/scenario",
             [&context](OpenSession& open, const Request& request, const Responder& respond) {
               save_scenario(context, open, body_json(request), respond);
             });
}

}  // namespace server
