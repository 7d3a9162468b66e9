// server/run/fleet_robot.cpp: a fleet and the pipelines of all its robots but the first.
#include "server/run/fleet_robot.hpp"

#include <stdexcept>
#include <utility>

namespace server {

FleetRobot::FleetRobot(const sim::Scenario& scenario,
                       std::uint64_t seed,
                       const std::vector<RobotPlan>& others,
                       sim::ForEach for_each)
    : fleet_(scenario, seed, std::move(for_each)) {
  if (others.size() + 1 != fleet_.size()) {
    throw std::invalid_argument("Each of the scenario's other robots needs a plan.");
  }
  others_.reserve(others.size());
  for (std::size_t k = 1; k < fleet_.size(); ++k) {
    const RobotPlan& plan = others[k - 1];
    const algo::ControllerCatalogue& controllers =
        plan.controllers ? *plan.controllers : algo::builtin_controllers();
    others_.push_back({plan, algo::Pipeline(plan.pipeline, fleet_.robot(k).spec(), controllers)});
  }
}

void FleetRobot::reset(algo::Observation& observation) {
  fleet_.restart();
  look(observation, true);
}

bool FleetRobot::step(const algo::Command& command, algo::Observation& observation) {
  fleet_.write(0, command);
  for (std::size_t k = 1; k < fleet_.size(); ++k) fleet_.write(k, telemetry(k).command);
  fleet_.advance();
  look(observation, false);
  return true;
}

/// Reads the sensors of all robots. The others also decide on their next command.
void FleetRobot::look(algo::Observation& observation, bool anew) {
  fleet_.each([&](std::size_t k) {
    if (k == 0) return fleet_.read(0, observation);
    Other& other = others_[k - 1];
    algo::Telemetry& t = other.t;
    fleet_.read(k, t.observation);
    t.requests.clear();
    if (anew) {
      other.pipeline.reset(t.observation.odometry.pose);
      for (const algo::Request& request : other.plan.first) t.requests.push_back(request);
    }
    other.pipeline.tick(t);
  });
}

std::optional<std::string> FleetRobot::edit(const algo::Request& request) {
  return fleet_.edit(request);
}

}  // namespace server
