// server/run/fleet_robot.hpp: presents a fleet as the one robot that a run drives.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algo/pipeline/pipeline.hpp"
#include "algo/robot.hpp"
#include "algo/telemetry.hpp"
#include "sim/fleet.hpp"

namespace server {

/// The pipeline of one robot and its first requests.
struct RobotPlan {
  algo::PipelineConfig pipeline{};
  std::vector<algo::Request> first{};
  /// As in RunSpec.
  std::shared_ptr<const algo::ControllerCatalogue> controllers{};
};

/// The port to the first robot of a fleet. Each step() also drives the other robots. Each of them
/// has its own pipeline and its own sensors, and takes no requests during the run.
///
/// The same scenario, seed, plans, commands and edits give the same observations bit for bit.
/// Belongs to one thread.
class FleetRobot final : public algo::Robot, public algo::Editing {
 public:
  /// `others`: a plan for each of the scenario's `robots`. Throws std::invalid_argument with a
  /// sentence for people.
  FleetRobot(const sim::Scenario& scenario,
             std::uint64_t seed,
             const std::vector<RobotPlan>& others,
             sim::ForEach for_each = {});

  const algo::RobotSpec& spec() const override { return first().spec(); }
  void reset(algo::Observation& observation) override;
  bool step(const algo::Command& command, algo::Observation& observation) override;
  /// Stops the first robot only.
  void stop() noexcept override { fleet_.robot(0).stop(); }
  algo::Editing* editing() override { return this; }
  std::optional<std::string> edit(const algo::Request& request) override;
  std::optional<algo::GroundTruth> ground_truth() const override { return first().ground_truth(); }
  void find_moved(algo::Recycled<algo::Moved>& moved) const override { fleet_.find_moved(moved); }

  const sim::Fleet& fleet() const { return fleet_; }
  /// The newest tick of robot `k`, counted from 1.
  const algo::Telemetry& telemetry(std::size_t k) const { return others_[k - 1].t; }

 private:
  struct Other {
    RobotPlan plan{};
    algo::Pipeline pipeline;
    algo::Telemetry t{};
  };
  const sim::World& first() const { return fleet_.robot(0); }
  void look(algo::Observation& observation, bool anew);

  sim::Fleet fleet_;
  std::vector<Other> others_{};
};

}  // namespace server
