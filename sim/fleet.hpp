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

/// Calls `call` with each of 0 to count - 1, in any order and on any threads; returns when all
/// calls have.
using ForEach =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& call)>;

/// The robots of a scenario, the first and its `robots`, in one world.
///
/// Each has a World of its own, with its own physics, sensors and noise, in which the others are
/// obstacles at their poses of the tick. A robot meets another as a thing that does not yield:
/// nobody is pushed. In a sweep of a scanner the others stand where the sweep's tick ends.
///
/// A period has two phases: all robots drive among the others as they stood, then all are placed
/// anew. Within a phase no robot reads a value that another one writes. The result is therefore the
/// same bit for bit with any number of threads.
class Fleet {
 public:
  /// Robot 0 has the noise that it would have alone. Throws std::invalid_argument with a sentence
  /// when the scenario cannot be run.
  Fleet(const Scenario& scenario, std::uint64_t seed, ForEach for_each = {});

  std::size_t size() const { return worlds_.size(); }
  /// Robot `k`, from 0; for its spec and its truth.
  World& robot(std::size_t k) { return *worlds_[k]; }
  const World& robot(std::size_t k) const { return *worlds_[k]; }

  /// The scenario anew.
  void restart();
  /// What robot `k` drives under in the next period.
  void write(std::size_t k, const algo::Command& command) { worlds_[k]->write(command); }
  /// One period of all robots.
  void advance();
  /// What robot `k` senses now. Once after each restart() and advance(); different robots on
  /// different threads at will.
  void read(std::size_t k, algo::Observation& observation) { worlds_[k]->read(observation); }

  /// Edits the obstacles of all robots, or of none and says why as a sentence.
  std::optional<std::string> edit(const algo::Request& request);
  /// Obstacles that move by themselves, the robots but the first among them.
  void find_moved(algo::Recycled<algo::Moved>& moved) const;

  /// Calls `call(k)` for all robots as the constructor was told to.
  void each(const std::function<void(std::size_t)>& call) const;

 private:
  void meet();
  void check_starts() const;

  ForEach for_each_{};
  std::vector<std::unique_ptr<World>> worlds_{};
  std::vector<algo::Obstacle> bodies_{};  // one a robot, at its start
  std::vector<Peer> peers_{};             // the same where they are
};

/// The scenario's other robots as obstacles at their starts, as people see them. Throws
/// std::invalid_argument on a robot that there is not.
std::vector<algo::Obstacle> other_robots(const Scenario& scenario);

}  // namespace sim
