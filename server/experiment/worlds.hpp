// server/experiment/worlds.hpp: worlds of one scenario, stepped together by actions from outside.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "algo/pipeline/pipeline.hpp"
#include "server/run/run_spec.hpp"

namespace server::experiment {

/// What one world does next: eight bytes each, as `tautline worlds` reads them.
struct WorldAction {
  double v = 0;      // [m/s]
  double omega = 0;  // [rad/s]
  double seed = -1;  // 0 or more: the world begins anew with it, and does nothing else
};

/// One world after its step, as `tautline worlds` writes it.
struct WorldState {
  double stamp = 0;                  // [s] run clock
  double x = 0, y = 0, heading = 0;  // by odometry, in W
  double v = 0, omega = 0;           // by odometry
  double goal_x = 0, goal_y = 0;     // in W; the robot's place if there is none
  double clearance = 0;              // [m] true distance of the hull to the nearest surface
  double outcome = 0;                // 0 running, 1 reached, 2 collided, 3 stuck, 4 out of time, 5
                                     // overturned, 6 fallen
};

/// The twist of an action takes the way of a controller's answer: the same limits, the same gate.
/// The same seeds and actions give the same states bit for bit. Belongs to one thread.
class Worlds {
 public:
  /// `count` worlds of `spec`, which begin with the seeds spec.seed, spec.seed + 1, ... Throws
  /// std::exception with a sentence.
  Worlds(const RunSpec& spec, std::size_t count);
  ~Worlds();
  Worlds(const Worlds&) = delete;
  Worlds& operator=(const Worlds&) = delete;

  /// One action a world. Throws std::exception with a sentence if a world breaks or an action is
  /// not finite.
  void step(std::span<const WorldAction> actions);

  std::span<const WorldState> states() const { return states_; }
  /// [m] The newest filtered scan of each world, one behind the other; range_max until its first.
  std::span<const float> ranges() const { return ranges_; }
  const algo::RobotSpec& robot() const;
  /// A scan, whose shape is that of all; empty if the robot has no scanner that looks ahead.
  const algo::LaserScan& scan() const { return scan_; }

 private:
  class World;
  static algo::LaserScan first_scan(const RunSpec& spec);
  void show(std::size_t i);

  algo::LaserScan scan_;
  std::vector<std::unique_ptr<World>> worlds_{};
  std::vector<WorldState> states_{};
  std::vector<float> ranges_{};
};

}  // namespace server::experiment
