// server/lab/buildings/tour_goals.hpp: a building for a tour of many goals, and the goals in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/lab/buildings/building_world.hpp"
#include "server/lab/buildings/grid_oracle.hpp"
#include "sim/random.hpp"

namespace server::buildings {

struct TourBuilding {
  Building building{};
  std::vector<algo::Vec2> shut_W{};  // free places inside that no way leads to
};
/// The building of the seed without its goal and without a door that moves. Where there is room,
/// pens stand in it, without an opening.
TourBuilding tour_building_of(std::uint64_t seed, const std::string& controller);

struct TourGoal {
  GoalPlace place = GoalPlace::Near;
  algo::Vec2 position_W{0, 0};
  Truth truth{};  // from the place where the robot was told
};

/// Draws goals: near ones (35 %), far ones (45 %), those shut in (10 %), which lie in a pen or
/// outside the building, and those inside a thing (10 %). Near and far ones are free of things. The
/// same seed and places give the same goals.
class TourGoals {
 public:
  TourGoals(const TourBuilding& tour, std::uint64_t seed);

  /// The next goal of a robot at `robot_W`.
  TourGoal next(const algo::Vec2& robot_W);
  /// What is true of the way between two places.
  Truth between(const algo::Vec2& from_W, const algo::Vec2& to_W) {
    return truth_between(oracle_, door_width_, from_W, to_W);
  }
  const GridOracle& oracle() const { return oracle_; }

 private:
  algo::Vec2 anywhere();
  algo::Vec2 near(const algo::Vec2& robot_W);
  algo::Vec2 far(const algo::Vec2& robot_W);
  algo::Vec2 shut_in();
  algo::Vec2 inside();

  GridOracle oracle_;
  double door_width_ = 0;  // [m]
  std::vector<algo::Obstacle> obstacles_{};
  algo::Vec2 low_W_{0, 0};  // corners of the building
  algo::Vec2 high_W_{0, 0};
  std::vector<algo::Vec2> shut_W_{};
  sim::Random random_;
};

}  // namespace server::buildings
