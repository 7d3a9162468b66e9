// server/serve/bridge_topics.cpp: what clients publish: goals, poses, edits, and the Twist of a
// driver.
#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "server/run/json_reader.hpp"
#include "server/run/request_json.hpp"
#include "server/serve/bridge.hpp"
#include "server/serve/operator_watch.hpp"
#include "server/serve/session_json.hpp"

namespace server {
namespace {

using foxglove::ClientId;
using nlohmann::json;
constexpr std::chrono::seconds kToldAgain{3};  // between two refusals of a stick

double yaw_of(const JsonReader& q) {
  const double x = q.number("x"), y = q.number("y"), z = q.number("z"), w = q.number("w");
  return std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

/// Refuses a stamped message in another frame than that of the world. Without a header or a name it
/// is taken as of that one.
void check_frame(const JsonReader& message) {
  if (!message.has("header")) return;
  const JsonReader header = message.object("header");
  const std::string frame = header.text_or("frame_id", "");
  if (frame.empty() || frame == "map" || frame == "/map") return;
  header.fail("frame_id", fmt::format("must be 'map', not '{}'", frame));
}

/// Applies the same limits as REST.
algo::Request goal_at(const JsonReader& position, std::optional<double> heading) {
  json goal = {{"type", "set_goal"}, {"x", position.number("x")}, {"y", position.number("y")}};
  if (heading) goal["heading"] = *heading;
  return request_from_json(goal);
}

/// geometry_msgs/PoseStamped.
algo::Request goal_from_pose(const json& message) {
  const JsonReader in(message, "");
  check_frame(in);
  const JsonReader pose = in.object("pose");
  std::optional<double> heading;
  if (pose.has("orientation")) heading = yaw_of(pose.object("orientation"));
  return goal_at(pose.object("position"), heading);
}

/// geometry_msgs/PoseWithCovarianceStamped. How sure the sender is does not count.
algo::Request initial_pose_from(const json& message) {
  const JsonReader in(message, "");
  check_frame(in);
  const JsonReader pose = in.object("pose").object("pose");
  const JsonReader position = pose.object("position");
  return request_from_json({{"type", "set_initial_pose"},
                            {"x", position.number("x")},
                            {"y", position.number("y")},
                            {"heading", yaw_of(pose.object("orientation"))}});
}

/// geometry_msgs/PointStamped.
algo::Request goal_from_point(const json& message) {
  const JsonReader in(message, "");
  check_frame(in);
  return goal_at(in.object("point"), std::nullopt);
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

/// A later refusal goes to the status line of the client that sent the request.
std::string Bridge::hand_over(ClientId client, algo::Request asked) {
  sign_of(client);
  const bool stick = std::holds_alternative<algo::Joystick>(asked);
  StampedRequest request{std::move(asked), {}};
  if (const auto refusal = admit(session_, sender(client), request)) {
    if (!stick) return *refusal;
    say_refusal(client, stick, *refusal);
    return {};
  }
  const bool taken = server::submit(
      session_,
      std::move(request.request),
      [this, client](const json& answer) {
        if (answer.contains("warning")) hub_.warn(client, answer["warning"].get<std::string>());
      },
      [this, client, stick](const std::string& refusal) { say_refusal(client, stick, refusal); },
      hub_.who(client).label());
  return taken ? std::string() : std::string(kBusy);
}

/// A stick is published many times a second, so its refusals are reported only at intervals.
void Bridge::say_refusal(ClientId client, bool stick, const std::string& refusal) {
  const auto now = std::chrono::steady_clock::now();
  if (stick) {
    const auto [said, first] = stick_refused_.try_emplace(client, now);
    if (!first && now - said->second < kToldAgain) return;
    said->second = now;
  }
  hub_.warn(client, refusal);
}

/// A published Twist takes free controls, and holds them while it comes.
std::string Bridge::drive(ClientId client, const json& twist) {
  const Sender from = sender(client);
  algo::Joystick stick;
  try {
    stick = stick_from_twist(twist, session_.state().robot);
  } catch (const DocumentError&) {
    session_.count_unreadable_stick();
    throw;
  }
  stick.mode = twist_mode_;
  const auto now = std::chrono::steady_clock::now();
  const bool was_free = !session_.lease().holder();
  const auto refusal = session_.lease().take_by_publishing(from.who, now);
  if (refusal) {
    say_refusal(client, true, *refusal);
    return {};
  }
  if (was_free) session_.tell();
  advise_rate(client, now);
  return hand_over(client, stick);
}

void Bridge::advise_rate(ClientId client, std::chrono::steady_clock::time_point now) {
  constexpr std::chrono::milliseconds kSlow{200}, kPause{2000};
  constexpr std::chrono::seconds kAgain{30};
  TwistRate& rate = twists_[client];
  const auto gap = now - std::exchange(rate.last, now);
  if (gap <= kSlow || gap >= kPause || now - rate.told < kAgain) return;
  rate.told = now;
  hub_.warn(
      client,
      "Your /cmd_vel comes less than 5 times a second. The robot stops when it has heard none "
      "for half a second: set the rate to 5 Hz or more.");
}

std::string Bridge::set_twist_mode(const json& value) {
  const auto mode = value.is_string() ? algo::stick_mode(value.get<std::string>()) : std::nullopt;
  if (!mode) return std::string("'") + kTwistMode + "' takes " + algo::kStickModeList + ".";
  twist_mode_ = *mode;
  hub_.parameters_changed();
  return {};
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
  hub_.on_publish("/initialpose", [this](ClientId client, const json& message) {
    return hand_over(client, initial_pose_from(message));
  });
  hub_.on_publish("/cmd_vel",
                  [this](ClientId client, const json& message) { return drive(client, message); });
  hub_.on_publish("/edits", [this](ClientId client, const json& message) {
    return hand_over(client, request_from_json(message));
  });
  hub_.on_client_came([this](ClientId client) { session_.client_came(client); });
  hub_.on_client_gone([this](ClientId client) {
    session_.client_gone(client);
    stick_refused_.erase(client);
    twists_.erase(client);
  });
  hub_.on_clients([this] { session_.count_viewers(hub_.clients()); });
  hub_.on_publisher_gone([this](ClientId client, const std::string& topic) {
    // A driver who leaves lets go of the stick; another's is not touched.
    const bool drives = !session_.lease().refusal({.client = client});
    if (topic == "/cmd_vel" && drives) session_.submit(algo::Joystick{}, {});
  });
}

}  // namespace server
