// server/bridge.cpp: what goes out on which channel, and what comes in on which topic.
#include "server/bridge.hpp"

#include <cmath>
#include <random>
#include <utility>

#include "server/foxglove/embedded_schemas.hpp"
#include "server/json_limits.hpp"
#include "server/json_reader.hpp"
#include "server/scenario_json.hpp"
#include "server/session_json.hpp"
#include "server/wire/scene_json.hpp"

namespace server {
namespace {

using foxglove::Hub;
using nlohmann::json;
constexpr double kTimePeriod = 0.1;  // [s] of the run clock between time messages

std::shared_ptr<const std::string> shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

std::string random_session_id() {
  std::random_device device;
  return std::to_string(device()) + "-" + std::to_string(device());
}

double yaw_of(const JsonReader& q) {
  const double x = q.number("x"), y = q.number("y"), z = q.number("z"), w = q.number("w");
  return std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

/// geometry_msgs/PoseStamped.
algo::SetGoal goal_from_pose(const json& message) {
  const JsonReader pose = JsonReader(message, "").object("pose");
  const JsonReader position = pose.object("position");
  algo::SetGoal goal;
  goal.position_W = {position.number("x"), position.number("y")};
  if (pose.has("orientation")) goal.heading = yaw_of(pose.object("orientation"));
  return goal;
}

/// geometry_msgs/PointStamped.
algo::SetGoal goal_from_point(const json& message) {
  const JsonReader point = JsonReader(message, "").object("point");
  return {.position_W = {point.number("x"), point.number("y")}, .heading = std::nullopt};
}

/// geometry_msgs/Twist in m/s and rad/s, as a share of the robot's limits.
algo::Joystick stick_from_twist(const json& message, const algo::RobotSpec& robot) {
  const JsonReader in(message, "");
  const double v = in.object("linear").number("x");
  const double omega = in.object("angular").number("z");
  const auto share = [](double value, double limit) {
    return limit > 0 ? std::clamp(value / limit, -1.0, 1.0) : 0.0;
  };
  return {share(v, robot.max_v), share(omega, robot.max_omega)};
}

}  // namespace

json Bridge::Gains::list() const {
  json out = json::array();
  for (const algo::ParameterInfo& p : algo::parameter_table()) {
    out.push_back({{"name", p.name},
                   {"value", session_.state().parameters[p.id]},
                   {"type", "float64"}});
  }
  const sim::Scenario& scenario = session_.state().spec.scenario;
  out.push_back({{"name", "controller"}, {"value", scenario.controller}});
  out.push_back({{"name", "filter"}, {"value", scenario.filter}});
  out.push_back({{"name", "scenario"}, {"value", scenario.name}});
  return out;
}

void Bridge::Gains::set(const std::string& name,
                        const json& value,
                        std::function<void(const std::optional<std::string>&)> done) {
  const auto parameter = algo::find_parameter(name);
  if (!parameter) {
    const bool read_only = name == "controller" || name == "filter" || name == "scenario";
    done(read_only ? "'" + name + "' is read only here: call the service /load."
                   : "There is no parameter '" + name + "'.");
  } else if (!value.is_number()) {
    done("'" + name + "' takes a number.");
  } else if (!session_.submit(algo::SetParameter{*parameter, value.get<double>()}, done)) {
    done("The control loop has more requests than it can take. Try again.");
  }
}

Bridge::Bridge(Session& session, std::function<void(const json&)> load)
    : session_(session),
      load_(std::move(load)),
      gains_(session),
      hub_(random_session_id(), gains_) {
  add_channels();
  add_services();
  add_topics();
  session_.on_frame = [this](const FrameRef& frame) { publish_frame(frame); };
  session_.on_change = [this] { publish_state(); };
  session_.on_log = [this](LogLevel level, const std::string& text) {
    const double stamp =
        session_.newest() ? session_.newest()->telemetry.observation.stamp : 0.0;
    hub_.publish_event(log_, now_ns(), log_json(stamp, level, text));
  };
}

std::uint64_t Bridge::now_ns() const {
  if (!session_.newest()) return 0;
  const double stamp = session_.newest()->telemetry.observation.stamp;
  return static_cast<std::uint64_t>(std::max(0.0, stamp) * 1e9);
}

Hub::ChannelId Bridge::add_json(const char* topic, const char* schema_name, bool latched) {
  return hub_.add_channel({.topic = topic,
                           .encoding = "json",
                           .schema_name = schema_name,
                           .schema = std::string(foxglove_schema(schema_name)),
                           .schema_encoding = "jsonschema"},
                          latched);
}

void Bridge::add_channels() {
  telemetry_ = hub_.add_channel({.topic = "/telemetry",
                                 .encoding = "flatbuffer",
                                 .schema_name = "tautline.wire.Frame",
                                 .schema = std::string(telemetry_bfbs_base64()),
                                 .schema_encoding = "flatbuffer"},
                                true);
  state_ = hub_.add_channel({.topic = "/state",
                             .encoding = "json",
                             .schema_name = "tautline.State",
                             .schema = std::string(state_schema()),
                             .schema_encoding = "jsonschema"},
                            true);
  scan_ = add_json("/scan", "foxglove.LaserScan", false);
  tf_ = add_json("/tf", "foxglove.FrameTransforms", false);
  odom_ = add_json("/odom", "foxglove.Odometry", false);
  strip_ = add_json("/strip", "foxglove.SceneUpdate", false);
  forces_ = add_json("/forces", "foxglove.SceneUpdate", false);
  obstacles_ = add_json("/obstacles", "foxglove.SceneUpdate", true);
  goal_ = add_json("/goal", "foxglove.PoseInFrame", true);
  trajectory_ = add_json("/trajectory", "foxglove.PosesInFrame", true);
  log_ = add_json("/log", "foxglove.Log", false);
}

void Bridge::submit(algo::Request request, const Hub::Reply& reply) {
  const auto id = std::make_shared<std::uint32_t>(0);
  const auto given =
      session_.submit(std::move(request), [reply, id](const std::optional<std::string>& refusal) {
        if (refusal) {
          reply.fail(*refusal);
          return;
        }
        json body = {{"ok", true}};
        if (*id != 0) body["id"] = *id;
        reply.ok(body);
      });
  if (!given) {
    reply.fail("The control loop has more requests than it can take. Try again.");
    return;
  }
  *id = *given;
}

void Bridge::add_services() {
  const auto ok = [](const Hub::Reply& reply) { reply.ok({{"ok", true}}); };
  hub_.add_service("/request", "tautline.Request", [this](const json& body, const Hub::Reply& reply) {
    submit(request_from_json(body), reply);
  });
  hub_.add_service("/load", "tautline.Load", [this, ok](const json& body, const Hub::Reply& reply) {
    load_(body);
    ok(reply);
  });
  hub_.add_service("/reset", "tautline.Empty", [this, ok](const json&, const Hub::Reply& reply) {
    session_.reset();
    ok(reply);
  });
  hub_.add_service("/pause", "tautline.Empty", [this, ok](const json&, const Hub::Reply& reply) {
    session_.pause(true);
    ok(reply);
  });
  hub_.add_service("/play", "tautline.Empty", [this, ok](const json&, const Hub::Reply& reply) {
    session_.pause(false);
    ok(reply);
  });
  hub_.add_service("/step", "tautline.Step", [this, ok](const json& body, const Hub::Reply& reply) {
    const JsonReader in(body, "");
    session_.single_step(static_cast<std::uint32_t>(in.whole_or("ticks", 1, 1'000'000)));
    ok(reply);
  });
  hub_.add_service("/speed", "tautline.Speed", [this, ok](const json& body, const Hub::Reply& reply) {
    session_.set_speed(JsonReader(body, "").number("speed", {0, 1000}));
    ok(reply);
  });
}

void Bridge::add_topics() {
  using Complain = std::function<void(const std::string&)>;
  const auto hand_over = [this](algo::Request request, const Complain& complain) {
    const auto given = session_.submit(
        std::move(request), [complain](const std::optional<std::string>& refusal) {
          if (refusal) complain(*refusal);
        });
    if (!given) complain("The control loop has more requests than it can take.");
  };
  for (const char* topic : {"/goal_pose", "/move_base_simple/goal"}) {
    hub_.add_topic(topic, [hand_over](const json& message, const Complain& complain) {
      hand_over(goal_from_pose(message), complain);
    });
  }
  hub_.add_topic("/clicked_point", [hand_over](const json& message, const Complain& complain) {
    hand_over(goal_from_point(message), complain);
  });
  hub_.add_topic("/cmd_vel", [this, hand_over](const json& message, const Complain& complain) {
    hand_over(stick_from_twist(message, session_.state().robot), complain);
  });
  hub_.add_topic("/edits", [hand_over](const json& message, const Complain& complain) {
    hand_over(request_from_json(message), complain);
  });
  hub_.on_publisher_gone([this](const std::string& topic) {
    // A driver who leaves lets go of the stick.
    if (topic == "/cmd_vel") session_.submit(algo::Joystick{}, {});
  });
}

void Bridge::publish_frame(const FrameRef& frame) {
  const algo::Telemetry& t = frame->telemetry;
  const std::uint64_t time_ns = now_ns();
  if (hub_.wanted(telemetry_)) {
    const auto bytes = frame->bytes();
    hub_.publish(telemetry_,
                 time_ns,
                 shared({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
  }
  const auto publish = [&](Hub::ChannelId channel, auto encode) {
    if (hub_.wanted(channel)) hub_.publish(channel, time_ns, shared(encode()));
  };
  if (t.scene.fresh) publish(scan_, [&] { return laser_scan_json(t); });
  publish(tf_, [&] { return transforms_json(t); });
  publish(odom_, [&] { return odometry_json(t); });
  publish(strip_, [&] { return strip_json(t); });
  publish(forces_, [&] { return forces_json(t); });
  publish(goal_, [&] { return goal_json(t); });
  if (session_.path().size() != path_published_) {
    path_published_ = session_.path().size();
    publish(trajectory_, [&] { return trajectory_json(t.observation.stamp, session_.path()); });
  }
  const double stamp = t.observation.stamp;
  if (stamp < time_published_ || stamp - time_published_ >= kTimePeriod) {
    time_published_ = stamp;
    hub_.publish_time(time_ns);
  }
}

void Bridge::publish_state() {
  const std::uint64_t time_ns = now_ns();
  hub_.publish(state_, time_ns, shared(dump_json(state_json(session_))));
  hub_.publish(obstacles_,
               time_ns,
               shared(obstacles_json(static_cast<double>(time_ns) * 1e-9,
                                     session_.state().obstacles)));
  if (told_parameters_ != session_.state().parameters) {
    told_parameters_ = session_.state().parameters;
    hub_.parameters_changed();
  }
}

}  // namespace server
