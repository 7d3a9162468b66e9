// server/serve/api/load_request.cpp: begins another run of a session, by a document.
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "server/run/hardware.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/map_robot.hpp"
#include "server/run/pose_json.hpp"
#include "server/run/robot_json.hpp"
#include "server/run/scenario_json.hpp"
#include "server/serve/api/api.hpp"

namespace server {

namespace {

using nlohmann::json;

sim::Scenario scenario_to_load(const ScenarioLibrary& library,
                               const LoadRequest& asked,
                               const sim::Scenario& now) {
  if (asked.name) return library.load(*asked.name);
  const auto read = [&] { return scenario_from_json(*asked.document, library.robots()); };
  if (!asked.same_world) return read();
  if (asked.overrides.robot.is_null() || !(asked.document || library.has(now.name))) return now;
  // The scenario is read again, so that another robot gets the sensors that the scenario gives it.
  sim::Scenario anew = asked.document ? read() : library.load(now.name);
  anew.name = now.name;  // it may have been saved under another one
  anew.title = now.title;
  anew.description = now.description;
  anew.start = now.start;
  anew.goal = now.goal;
  anew.waypoints = now.waypoints;
  anew.loop = now.loop;
  anew.obstacles = now.obstacles;
  anew.controller = now.controller;
  anew.filter = now.filter;
  anew.physics = now.physics;
  anew.parameters = now.parameters;
  anew.map = now.map;
  anew.lost = now.lost;
  return anew;
}

/// A document that has the whole model of a robot names none. A name then chooses the robot of the
/// library, with its sensors, even if it has the model's name: the file may be another by now.
void choose_of_library(const RobotLibrary& robots, LoadRequest& asked) {
  json& choice = asked.overrides.robot;
  if (!choice.is_string() || !asked.same_world || !asked.document) return;
  const auto written = asked.document->find("robot");
  if (written == asked.document->end() || !written->is_object()) return;
  try {
    choice = robot_document(robots.load(choice.get<std::string>()));
  } catch (const LibraryError& e) {
    if (e.kind() != LibraryError::Kind::NotFound) throw DocumentError("robot", e.what());
  }
}

/// The document of a session's own world names its map without the folder.
bool same_map(const sim::Scenario& scenario, const RunSpec& now) {
  return now.map != nullptr && scenario.map == now.map->name;
}

}  // namespace

LoadRequest load_request(const json& body) {
  const JsonReader in(body, "");
  in.only({"scenario",
           "controller",
           "filter",
           "physics",
           "vehicle",
           "robot",
           "seed",
           "parameters",
           "begin"});
  LoadRequest out{.overrides = overrides_from_json(body)};
  if (in.has("scenario") && !body["scenario"].is_object()) out.name = in.text("scenario", 64);
  if (in.has("scenario") && body["scenario"].is_object()) {
    out.document = std::make_shared<const json>(body["scenario"]);
  }
  out.same_world = !in.has("scenario");
  if (in.has("begin")) {
    const JsonReader begin = in.object("begin");
    begin.only({"x", "y", "heading"});
    out.begin_W = pose_from_json(begin, 0);
  }
  return out;
}

RunSpec spec_to_load(const ScenarioLibrary& library, LoadRequest asked, const RunSpec& now) {
  asked.overrides.controllers = now.controllers;
  if (asked.same_world && !asked.overrides.seed) asked.overrides.seed = now.seed;
  choose_of_library(library.robots(), asked);
  sim::Scenario scenario = scenario_to_load(library, asked, now.scenario);
  if (asked.same_world || same_map(scenario, now)) asked.overrides.map = now.map;
  if (!asked.overrides.map) scenario = library.placed(std::move(scenario));
  RunSpec spec = make_spec(std::move(scenario), asked.overrides, library.robots());
  spec.begin_W = asked.begin_W;
  return spec;
}

bool load_from_json(ApiContext& context,
                    OpenSession& session,
                    const json& body,
                    SessionLoader::Done done) {
  LoadRequest asked = load_request(body);
  if (const auto& hardware = session.session().state().spec.hardware) {
    if (asked.document || (asked.name && *asked.name != hardware->scenario.name)) {
      throw DocumentError(
          "scenario",
          "cannot be loaded: this session drives real hardware. Open another for simulation");
    }
    if (asked.begin_W) throw DocumentError("begin", "cannot be chosen: this robot is real");
    RunOverrides overrides = asked.overrides;
    overrides.map = session.session().state().spec.map;
    const auto plan = [hardware, overrides] {
      return [hardware, overrides] { return hardware_spec(hardware, overrides); };
    };
    return session.loader().load(plan, std::move(done));
  }
  const auto plan = [&library = context.library, &session, asked]() mutable -> SessionLoader::Make {
    const RunSpec now = session.session().again();
    if (asked.same_world) asked.document = session.document();
    return [&library, asked, now] { return spec_to_load(library, asked, now); };
  };
  const auto loaded = [&session, asked, done = std::move(done)](const std::exception_ptr& failure) {
    if (!failure && !asked.same_world) session.set_document(asked.document);
    if (done) done(failure);
  };
  return session.loader().load(plan, loaded);
}

}  // namespace server
