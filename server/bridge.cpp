// server/bridge.cpp: what goes out on which channel, and what comes in on which topic.
#include "server/bridge.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "server/json_limits.hpp"
#include "server/json_reader.hpp"
#include "server/request_json.hpp"
#include "server/scenario_json.hpp"
#include "server/session_json.hpp"
#include "server/wire/scene_json.hpp"

namespace server {
namespace {

using foxglove::ChannelId;
using foxglove::ClientId;
using foxglove::ServiceReply;
using nlohmann::json;
constexpr const char* kBusy = "The control loop has more requests than it can take. Try again.";

std::shared_ptr<const std::string> shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

double yaw_of(const JsonReader& q) {
  const double x = q.number("x"), y = q.number("y"), z = q.number("z"), w = q.number("w");
  return std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

/// The same limits as over REST.
algo::Request goal_at(const JsonReader& position, std::optional<double> heading) {
  json goal = {{"type", "set_goal"}, {"x", position.number("x")}, {"y", position.number("y")}};
  if (heading) goal["heading"] = *heading;
  return request_from_json(goal);
}

/// geometry_msgs/PoseStamped.
algo::Request goal_from_pose(const json& message) {
  const JsonReader pose = JsonReader(message, "").object("pose");
  std::optional<double> heading;
  if (pose.has("orientation")) heading = yaw_of(pose.object("orientation"));
  return goal_at(pose.object("position"), heading);
}

/// geometry_msgs/PointStamped.
algo::Request goal_from_point(const json& message) {
  return goal_at(JsonReader(message, "").object("point"), std::nullopt);
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

std::vector<foxglove::Parameter> Bridge::Gains::list() const {
  std::vector<foxglove::Parameter> out;
  for (const algo::ParameterInfo& p : algo::parameter_table()) {
    out.push_back({std::string(p.name), shown_[p.id], "float64"});
  }
  const sim::Scenario& scenario = bridge_.session_.state().spec.scenario;
  out.push_back({"controller", scenario.controller, ""});
  out.push_back({"filter", scenario.filter, ""});
  out.push_back({"scenario", scenario.name, ""});
  return out;
}

std::string Bridge::Gains::set(const std::string& name, const json& value) {
  const auto parameter = algo::find_parameter(name);
  if (!parameter) {
    const bool read_only = name == "controller" || name == "filter" || name == "scenario";
    return read_only ? "'" + name + "' is read only here: call the service /load."
                     : "There is no parameter '" + name + "'.";
  }
  if (!value.is_number()) return "'" + name + "' takes a number.";
  const double wanted = value.get<double>();
  if (const auto why = algo::refusal(shown_, *parameter, wanted)) return *why;
  ++on_their_way_;
  shown_.set(*parameter, wanted);
  const auto given = bridge_.session_.submit(
      algo::SetParameter{*parameter, wanted}, [this](const std::optional<std::string>& refusal) {
        --on_their_way_;
        follow();
        if (refusal) {
          bridge_.hub_.announce(foxglove::StatusLevel::Warning, *refusal);
          bridge_.hub_.parameters_changed();
        }
      });
  if (given) return {};
  --on_their_way_;
  follow();
  return kBusy;
}

void Bridge::Gains::follow() {
  if (on_their_way_ == 0) shown_ = bridge_.session_.state().parameters;
}

Bridge::Bridge(Session& session, std::function<void(const json&)> load)
    : session_(session), load_(std::move(load)) {
  hub_.set_parameters(gains_);
  add_channels();
  add_services();
  add_topics();
  session_.on_frame = [this](const FrameRef& frame) { publish_frame(frame); };
  session_.on_change = [this] { publish_state(); };
  session_.on_log = [this](LogLevel level, const std::string& text) {
    const double stamp = static_cast<double>(now_ns()) * 1e-9;
    hub_.publish_event(log_, now_ns(), shared(log_json(stamp, level, text)));
  };
}

std::uint64_t Bridge::now_ns() const {
  if (!session_.newest()) return 0;
  const double stamp = session_.newest()->telemetry.observation.stamp;
  return static_cast<std::uint64_t>(std::max(0.0, stamp) * 1e9);
}

void Bridge::add_channels() {
  telemetry_ = hub_.add_channel({"/telemetry", "tautline.wire.Frame", true});
  state_ = hub_.add_channel({"/state", "tautline.State", true});
  scan_ = hub_.add_channel({"/scan", "foxglove.LaserScan"});
  tf_ = hub_.add_channel({"/tf", "foxglove.FrameTransforms"});
  odom_ = hub_.add_channel({"/odom", "foxglove.Odometry"});
  strip_ = hub_.add_channel({"/strip", "foxglove.SceneUpdate"});
  forces_ = hub_.add_channel({"/forces", "foxglove.SceneUpdate"});
  obstacles_ = hub_.add_channel({"/obstacles", "foxglove.SceneUpdate", true});
  goal_ = hub_.add_channel({"/goal", "foxglove.PoseInFrame"});
  trajectory_ = hub_.add_channel({"/trajectory", "foxglove.PosesInFrame"});
  log_ = hub_.add_channel({"/log", "foxglove.Log"});
}

void Bridge::submit(algo::Request request, const ServiceReply& reply) {
  const auto id = std::make_shared<std::uint32_t>(0);
  const auto given =
      session_.submit(std::move(request), [reply, id](const std::optional<std::string>& refusal) {
        if (refusal) {
          reply.failure(*refusal);
          return;
        }
        json body = {{"ok", true}};
        if (*id != 0) body["id"] = *id;
        reply.success(body);
      });
  if (given) {
    *id = *given;
  } else {
    reply.failure(kBusy);
  }
}

void Bridge::add_services() {
  // Each throws what is wrong with its request; the hub makes that the call's failure.
  const auto add = [this](const char* name, std::function<void(const json&)> action) {
    hub_.add_service(
        name, [action = std::move(action)](ClientId, const json& body, const ServiceReply& reply) {
          action(body);
          reply.success({{"ok", true}});
        });
  };
  hub_.add_service("/request", [this](ClientId, const json& body, const ServiceReply& reply) {
    submit(request_from_json(body), reply);
  });
  add("/load", [this](const json& body) { load_(body); });
  add("/reset", [this](const json&) { session_.reset(); });
  add("/pause", [this](const json&) { session_.pause(true); });
  add("/play", [this](const json&) { session_.pause(false); });
  add("/arm", [this](const json& body) {
    const JsonReader in(body, "");
    in.only({"armed"});
    if (!in.has("armed")) in.fail("armed", "must be true or false");
    if (const auto refusal = session_.arm(in.flag_or("armed", false))) {
      throw std::runtime_error(*refusal);
    }
  });
  add("/step", [this](const json& body) {
    const JsonReader in(body, "");
    session_.single_step(static_cast<std::uint32_t>(in.whole_or("ticks", 1, 1'000'000)));
  });
  add("/speed", [this](const json& body) {
    JsonReader(body, "").number("speed");
    session_.set_speed(pace_from_json(body, "speed", 1));
  });
}

/// A refusal found out later goes to the status line of the client that asked.
std::string Bridge::hand_over(ClientId client, algo::Request request) {
  const auto given = session_.submit(std::move(request),
                                     [this, client](const std::optional<std::string>& refusal) {
                                       if (refusal) hub_.warn(client, *refusal);
                                     });
  return given ? std::string() : std::string(kBusy);
}

void Bridge::add_topics() {
  for (const char* topic : {"/goal_pose", "/move_base_simple/goal"}) {
    hub_.on_publish(topic, [this](ClientId client, const json& message) {
      return hand_over(client, goal_from_pose(message));
    });
  }
  hub_.on_publish("/clicked_point", [this](ClientId client, const json& message) {
    return hand_over(client, goal_from_point(message));
  });
  hub_.on_publish("/cmd_vel", [this](ClientId client, const json& message) {
    return hand_over(client, stick_from_twist(message, session_.state().robot));
  });
  hub_.on_publish("/edits", [this](ClientId client, const json& message) {
    return hand_over(client, request_from_json(message));
  });
  hub_.on_publisher_gone([this](ClientId, const std::string& topic) {
    // A driver who leaves lets go of the stick.
    if (topic == "/cmd_vel") session_.submit(algo::Joystick{}, {});
  });
}

void Bridge::publish_frame(const FrameRef& frame) {
  const algo::Telemetry& t = frame->telemetry;
  const std::uint64_t time_ns = now_ns();
  // Whether or not somebody watches: whoever opens the page while time stands still wants the last.
  const auto bytes = frame->bytes();
  hub_.publish(
      telemetry_, time_ns, shared({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
  const auto publish = [&](ChannelId channel, auto encode) {
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
  hub_.broadcast_time(time_ns, std::chrono::steady_clock::now());
}

void Bridge::publish_state() {
  const std::uint64_t time_ns = now_ns();
  hub_.publish(state_, time_ns, shared(dump_json(state_json(session_))));
  hub_.publish(
      obstacles_,
      time_ns,
      shared(obstacles_json(static_cast<double>(time_ns) * 1e-9, session_.state().obstacles)));
  if (told_parameters_ != session_.state().parameters) {
    told_parameters_ = session_.state().parameters;
    gains_.follow();
    hub_.parameters_changed();
  }
}

}  // namespace server
