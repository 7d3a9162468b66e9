// server/lab/reproduce/reach_study.hpp: a hand brought to a pose among things in random worlds,
// beside an arm that moves its joints straight to the goal.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/lab/reproduce/reach_world.hpp"

namespace server::reproduce {

/// One world.
struct Reach {
  bool reachable =
      false;  // from some place of the base the hand is at its goal clear of everything
  bool reached = false;
  double clearance = 0;  // [m] least of all links, also from each other; below 0: a contact
  bool straight_touches = false;  // the joints' straight motion, at the place of the last reach
  double seconds = 0;             // of the drive
  double hand_error = 0;          // [m] at the end
  int plans = 0;
  std::string words{};  // at the end, as the robot says
};
Reach reach_in(const ReachWorld& world, std::uint64_t seed);

/// The worlds of one scene in which the goal is reachable.
struct ReachTrials {
  std::string scene{};
  std::size_t worlds = 0;
  std::size_t reached = 0;
  std::size_t touched = 0;
  std::size_t straight_touched = 0;
  std::size_t refused = 0;   // given up before the first motion,
  std::size_t given_up = 0;  // and later
  double clearance = 0;      // [m] least of all
  double seconds = 0;        // mean of the drives that reached the goal
  double plans = 0;          // mean
  double hand_error = 0;     // [m] largest of those
};

struct ReachStudy {
  std::vector<ReachTrials> scenes{};
  ReachTrials all{};
  /// What the robot says in worlds whose goal it does not reach, also in those that are not counted
  /// because no robot could.
  std::map<std::string, std::size_t> why{};
};

/// The row of those of `reaches` whose goal is reachable.
ReachTrials trials_of(std::string_view scene, std::span<const Reach> reaches);

/// `worlds` with a reachable goal of each scene; the same study each time, bit for bit.
ReachStudy study_reach(std::size_t worlds);

}  // namespace server::reproduce
