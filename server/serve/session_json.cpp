// server/serve/session_json.cpp: documents about a session.
#include "server/serve/session_json.hpp"

#include "algo/filter/filter.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/pipeline/parameter_table.hpp"
#include "server/run/arm_json.hpp"
#include "server/run/hardware.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/map_robot.hpp"
#include "server/run/paths.hpp"
#include "server/run/pose_json.hpp"
#include "server/run/request_json.hpp"
#include "server/run/scenario_json.hpp"
#include "server/serve/driving.hpp"

namespace server {

using nlohmann::json;

json state_json(const Session& session) {
  const SessionState& s = session.state();
  json obstacles = json::array();
  for (const algo::Obstacle& o : session.obstacles()) obstacles.push_back(to_json(o));
  json out = {
      {"run",
       {{"id", session.run_id()},
        {"status", s.running ? "recording" : "finished"},
        {"outcome", algo::name(s.outcome)}}},
      {"source", source_of(s.spec)},
      {"scenario", to_json(s.spec.scenario)},
      {"controller", s.spec.scenario.controller},
      {"filter", s.spec.scenario.filter},
      {"physics", physics_of(s.spec)},
      {"vehicle", physics_of(s.spec)},  // its old name
      {"seed", s.spec.seed},
      {"robot", to_json(s.robot)},
      {"pace", {{"paused", s.pace.paused}, {"speed", s.pace.speed}}},
      {"stop", s.asked.stop},
      {"goal", nullptr},
      {"goals_ahead", json::array()},
      {"goals_behind", json::array()},
      {"loop", s.asked.loop},
      {"edited", s.edited},
      {"obstacles", std::move(obstacles)},
      {"parameters", to_json(s.asked.parameters)},
      {"lost_ticks", s.lost_ticks},
      {"missed_periods", s.missed_periods},
      {"problem", nullptr},
      {"record", to_json(s.record)},
      {"hardware", nullptr},
      {"watchers", s.watchers.pages + (s.watchers.scripts ? 1U : 0U)},
      {"watched_by_script", s.watchers.scripts},
      {"viewers", s.viewers},
      {"by", by_json(session)},
      {"driving", driving_json(session)},
      {"map", s.spec.map ? json(s.spec.map->name) : json(nullptr)},
      {"emulated", s.spec.hardware && s.spec.hardware->emulated},
  };
  if (s.asked.goal) out["goal"] = to_json(*s.asked.goal);
  for (const algo::SetGoal& goal : s.asked.goals_ahead) out["goals_ahead"].push_back(to_json(goal));
  for (const algo::SetGoal& goal : s.asked.goals_behind) {
    out["goals_behind"].push_back(to_json(goal));
  }
  if (s.robot.arm) {
    out["hand_goal"] = s.asked.hand_goal ? to_json(*s.asked.hand_goal) : json(nullptr);
    out["carry_goal"] = s.asked.carry_goal ? to_json(*s.asked.carry_goal) : json(nullptr);
    out["joint_goal"] = s.asked.joint_goal ? json(s.asked.joint_goal->position) : json(nullptr);
  }
  out["robot"]["editable"] = s.editable;
  out["robot"]["paceable"] = !s.spec.hardware;
  if (s.problem) out["problem"] = without_folders(*s.problem);
  if (s.hardware) {
    out["hardware"] = to_json(*s.hardware);
    out["hardware"]["disarmed"] = nullptr;
    if (s.disarming) {
      out["hardware"]["disarmed"] = {{"why", without_folders(s.disarming->why)},
                                     {"at", s.disarming->at}};
    }
  }
  return out;
}

namespace {

json to_json(const algo::MapPose& at) {
  return {{"state", algo::name(at.fix)},
          {"why", algo::sentence(at.fix)},
          {"places", at.places},
          {"epoch", at.epoch},
          {"xx", at.xx},
          {"xy", at.xy},
          {"yy", at.yy},
          {"turn", at.turn},
          {"fit", at.fit}};
}

}  // namespace

json session_json(const Session& session) {
  json out = state_json(session);
  if (!session.newest()) return out;
  const algo::Telemetry& t = session.newest()->telemetry;
  const algo::Pose2& pose = t.observation.odometry.pose;
  out["tick"] = t.tick;
  out["stamp"] = t.observation.stamp;
  out["pose"] = {{"x", pose.x}, {"y", pose.y}, {"heading", pose.heading}};
  if (const auto& at = t.observation.map_pose) out["fix"] = to_json(*at);
  out["command"] = {{"v", t.command.base.v}, {"omega", t.command.base.omega}};
  out["clearance"] = t.clearance;
  out["mission"] = algo::name(t.mission);
  out["hold"] = algo::name(t.hold);
  out["behaviour"] = t.behaviour.view();
  if (t.observation.joints) out["joints"] = t.observation.joints->position;
  if (t.arm.present) out["arm"] = name(t.arm.state);
  out["what"] = t.words.what;
  out["why"] = t.words.why;
  return out;
}

net::Role needed_for(const algo::Request& request) {
  return is_stop(request) ? net::Role::Viewer : net::Role::Operator;
}

void pause(Session& session, bool paused, const std::string& who) {
  session.credits.pause = who;  // first: pause() tells the clients
  session.pause(paused);
  tell_deed(session, who, paused ? "paused the world" : "lets the world go on");
}

json goal_check_json(Session& session, const json& goal) {
  const JsonReader in(goal, "");
  in.only({"x", "y", "heading"});
  json out = {{"ok", true}, {"trouble", nullptr}};
  if (const auto trouble = session.trouble_with(goal_from_json(in))) out["trouble"] = *trouble;
  return out;
}

std::optional<std::string> set_start(Session& session, const json& start) {
  const JsonReader in(start, "");
  in.only({"x", "y", "heading"});
  return session.set_start(pose_from_json(in, session.state().spec.scenario.start.heading));
}

bool submit(Session& session,
            algo::Request request,
            std::function<void(const json&)> accepted,
            std::function<void(const std::string&)> refused,
            const std::string& who) {
  const auto id = std::make_shared<std::uint32_t>(0);
  const bool stop = is_stop(request);
  const bool again = stop && session.state().asked.stop;  // a Stop of somebody holds already
  const auto answer = [&session,
                       id,
                       stop,
                       again,
                       who,
                       request,
                       trouble = session.trouble_with(request),
                       accepted = std::move(accepted),
                       refused = std::move(refused)](const std::optional<std::string>& refusal) {
    if (refusal) return refused(*refusal);
    if (!again) credit(session, request, who);
    json body = {{"ok", true}};
    if (stop) body["stop"] = session.standing() ? "standing" : "commanded";
    if (*id != 0) body["id"] = *id;
    if (trouble) body["warning"] = *trouble;
    accepted(body);
  };
  const auto given = session.submit(std::move(request), answer);
  if (given) *id = *given;
  return given.has_value();
}

json catalog_json(const algo::ControllerCatalogue& catalogue) {
  const auto keys = [](algo::ParameterList list) {
    json names = json::array();
    for (const algo::ParameterInfo* p : list) names.push_back(p->key());
    return names;
  };
  json controllers = json::array();
  for (const algo::ControllerInfo& c : catalogue.entries()) {
    controllers.push_back({{"name", c.name},
                           {"label", c.label},
                           {"help", c.help},
                           {"outside", c.outside},
                           {"parameters", keys(c.parameters)}});
  }
  json filters = json::array();
  for (const algo::FilterInfo& f : algo::filter_table()) {
    filters.push_back({{"name", f.name}, {"label", f.label}, {"help", f.help}});
  }
  json parameters = json::array();
  for (const algo::ParameterInfo* p : algo::parameter_table()) {
    parameters.push_back({{"name", p->key()},
                          {"full_name", p->name},
                          {"label", p->label},
                          {"unit", p->unit},
                          {"min", p->min},
                          {"max", p->max},
                          {"step", p->step},
                          {"initial", p->initial},
                          {"help", p->help}});
  }
  json physics = json::array();
  physics.push_back({{"name", "bullet"},
                     {"label", "Bullet"},
                     {"help", "Rigid-body physics with wheel slip and acceleration limits."}});
  physics.push_back({{"name", "kinematic"},
                     {"label", "Kinematic"},
                     {"help", "Goes exactly as told: fast, and the paper's conditions."}});
  return {{"controllers", std::move(controllers)},
          {"filters", std::move(filters)},
          {"physics", physics},
          {"vehicles", std::move(physics)},  // their old name
          {"common_parameters", keys(algo::common_parameters())},
          {"parameters", std::move(parameters)}};
}

}  // namespace server
