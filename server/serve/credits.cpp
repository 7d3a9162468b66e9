// server/serve/credits.cpp: takes credits from requests, and writes those that still hold.
#include "server/serve/credits.hpp"

#include <variant>

#include "server/run/request_json.hpp"
#include "server/serve/session.hpp"

namespace server {

void tell_deed(const Session& session, const std::string& who, const std::string& deed) {
  if (session.on_log) session.on_log(LogLevel::Info, who + " " + deed + ".");
}

void credit(Session& session, const algo::Request& request, const std::string& who) {
  if (const auto* stop = std::get_if<algo::Stop>(&request)) {
    session.credits.stop = who;
    tell_deed(session, who, stop->engaged ? "pressed Stop" : "released the robot");
  } else if (std::holds_alternative<algo::SetGoal>(request) ||
             std::holds_alternative<algo::SetGoals>(request) ||
             std::holds_alternative<algo::AddGoal>(request)) {
    session.credits.goal = who;
    tell_deed(session, who, "set a goal");
  } else if (std::holds_alternative<algo::ClearGoal>(request)) {
    tell_deed(session, who, "cleared the goals");
  } else if (std::holds_alternative<algo::SetInitialPose>(request)) {
    tell_deed(session, who, "gave the robot's pose on the map");
  }
}

nlohmann::json by_json(const Session& session) {
  const SessionState& state = session.state();
  const Credits& credits = session.credits;
  const auto name = [](bool holds, const std::string& who) {
    return holds && !who.empty() ? nlohmann::json(who) : nlohmann::json(nullptr);
  };
  return {{"goal", name(state.asked.goal.has_value(), credits.goal)},
          {"stop", name(state.asked.stop, credits.stop)},
          {"pause", name(state.pace.paused, credits.pause)},
          {"arming", name(state.spec.hardware != nullptr, credits.arming)}};
}

}  // namespace server
