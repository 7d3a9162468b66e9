// sim/fleet.hpp: several robots in one world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algo/robot.hpp"
#include "sim/scenario.hpp"
#include "sim/world.hpp"

namespace sim {

/// Calls `call` with each of 0 to count - 1, in any order and on any threads. Returns after all
/// calls.
using ForEach =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& call)>;

/// The robots of a scenario, the first and its `robots`, in one world.
///
/// Each has its own World with its own physics, sensors and noise. In it the others are obstacles
/// at their poses of the tick. Robots do not yield to each other: none is pushed. During a
/// scanner's sweep the others stand where they are at the end of the tick.
///
/// A period has two phases. First all robots drive among the others' old poses, then all are placed
/// anew. Within a phase no robot reads a value that another one writes, so the result is the same
/// bit for bit with any number of threads.
class Fleet {
 public:
  /// Robot 0 has the same noise as it would have alone. Throws std::invalid_argument with a
  /// sentence if the scenario cannot be run.
  Fleet(const Scenario& scenario, std::uint64_t seed, ForEach for_each = {});

  std::size_t size() const { return worlds_.size(); }
  /// Robot `k`, from 0; for its spec and its ground truth.
  World& robot(std::size_t k) { return *worlds_[k]; }
  const World& robot(std::size_t k) const { return *worlds_[k]; }

  /// Restarts the scenario.
  void restart();
  /// Sets the command of robot `k` for the next period.
  void write(std::size_t k, const algo::Command& command) { worlds_[k]->write(command); }
  /// Advances all robots by one period.
  void advance();
  /// Reads the sensors of robot `k` now. Call once after each restart() and advance(); different
  /// robots may be read on different threads.
  void read(std::size_t k, algo::Observation& observation) { worlds_[k]->read(observation); }

  /// Edits the obstacles of all robots, or of none and returns the reason as a sentence.
  std::optional<std::string> edit(const algo::Request& request);
  /// Lists the obstacles that move by themselves, and all robots but the first.
  void find_moved(algo::Recycled<algo::Moved>& moved) const;

  /// Calls `call(k)` for all robots, by the constructor's `for_each`.
  void each(const std::function<void(std::size_t)>& call) const;

 private:
  void meet();
  void check_starts() const;

  ForEach for_each_{};
  std::vector<std::unique_ptr<World>> worlds_{};
  std::vector<algo::Obstacle> bodies_{};  // one per robot, at its start
  std::vector<Peer> peers_{};             // the same at their present poses
};

/// The scenario's other robots as obstacles at their starts, for display. Throws
/// std::invalid_argument for an unknown robot.
std::vector<algo::Obstacle> other_robots(const Scenario& scenario);

}  // namespace sim
