// algo/full_strip/space_time.hpp: a beam search over motions in space and time, among moving
// obstacles. Driving on, waiting, giving way and stepping back are all motions of the search.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/full_strip/motion.hpp"
#include "algo/full_strip/node_strip.hpp"
#include "algo/full_strip/weighing.hpp"
#include "algo/recycled.hpp"
#include "algo/robot.hpp"
#include "algo/types.hpp"

namespace algo {

struct SpaceTimeInput {
  const LocalMap* map = nullptr;
  const HullCheck* hull = nullptr;
  const RobotSpec* spec = nullptr;
  const Recycled<Track>* tracks = nullptr;  // at the run-clock time of `state` minus `lead`
  double lead = 0;                          // [s] from the tracks' time to that of `state`
  MotionState state{};
  MotionLimits limits{};
  Vec2 carrot_W{0, 0};  // end of the straight way ahead
  double beyond = 0;    // [m] distance from there to the goal
};

/// A command is held for one level of the search; each level keeps the best few states. The answer
/// is the first command of the cheapest motion that stays clear to the end.
class SpaceTimeSearch {
 public:
  SpaceTimeSearch();

  /// True if a track may come near the robot, or near its way along `strip`, within the next
  /// seconds.
  static bool needed(const SpaceTimeInput& in, const NodeStrip& strip);
  /// The first command of a motion that stays clear to the end; if there is none, of one that stays
  /// clear with less room; else of the one with the largest least distance.
  Twist2 search(const SpaceTimeInput& in, Weighing& out);
  /// True if the last answer stays clear to the end.
  bool clear() const { return clear_; }

 private:
  struct State {
    MotionState motion{};
    double risk = 0;
    double cost = 0;
    std::uint32_t first = 0;  // index of the first command
  };
  Twist2 attempt(const SpaceTimeInput& in, double margin_share, Weighing& out);
  bool stops_clear(const SpaceTimeInput& in, const Twist2& twist, double room) const;
  Twist2 least_bad(const SpaceTimeInput& in) const;
  bool step(
      const SpaceTimeInput& in, double time, double length, const Twist2& command, State& s) const;
  /// The distance to moving obstacles in the future.
  struct Nearness {
    double room = 0;  // [m] beyond the margin
    double risk = 0;  // 0: no obstacle could turn and soon be here; 1: one is here
  };
  Nearness nearness(const SpaceTimeInput& in, double time, const MotionState& at) const;
  void keep_best();

  std::vector<State> states_, next_;
  std::vector<std::uint32_t> bins_, bin_round_;
  std::vector<std::uint32_t> order_;
  std::uint32_t round_ = 0;
  std::vector<Track> near_tracks_;
  std::vector<double> near_speeds_;  // [m/s] of near_tracks_
  double static_margin_ = 0;         // [m] for this search
  double margin_share_ = 1;          // share of the margins from moving obstacles
  std::vector<char> stops_;          // whether braking after that command avoids static obstacles
  bool clear_ = false;
};

}  // namespace algo
