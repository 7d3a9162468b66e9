// algo/full_strip/space_time.hpp: a beam search over motions in space and time, among moving
// obstacles. Driving on, waiting, giving way and stepping back are all motions of the search.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
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
  const Recycled<Track>* tracks = nullptr;    // at the run-clock time of `state` minus `lead`
  const Recycled<Track>* standing = nullptr;  // bodies that stand and may begin to walk
  double lead = 0;                            // [s] from the tracks' time to that of `state`
  double stamp = 0;                           // [s] run clock
  MotionState state{};
  MotionLimits limits{};
  Vec2 carrot_W{0, 0};      // end of the straight way ahead
  double beyond = 0;        // [m] distance from there to the goal
  bool looks_back = false;  // a scanner looks at the area behind the robot
};

/// A command is held for one level of the search; each level keeps the best few states. The answer
/// is the first command of the cheapest motion that stays clear to the end. That motion is kept as
/// long as it stays clear, until another one is better by a margin.
class SpaceTimeSearch {
 public:
  SpaceTimeSearch();
  void reset();

  /// True if a track may come near the robot, or near its way along `strip`, within the next
  /// seconds. A search that has begun goes on until the tracks are a little farther away.
  bool needed(const SpaceTimeInput& in, const NodeStrip& strip) const;
  /// The present command of a motion that stays clear to the end; if there is none, of one that
  /// stays clear with less room or is touched only at rest; else the command after which the robot
  /// is slowest when it is touched.
  Twist2 search(const SpaceTimeInput& in, Weighing& out);
  /// True if the last answer stays clear to the end.
  bool clear() const { return clear_; }

 private:
  static constexpr std::size_t kLevelCount = 11;
  static constexpr double kNoPlan = -1;
  using Way = std::array<std::uint8_t, kLevelCount>;  // the index of each level's command
  struct State {
    MotionState motion{};
    double risk = 0;
    double cost = 0;
    Way way{};
    bool touched = false;  // at rest
  };
  /// A moving obstacle near the robot.
  struct Mover {
    Vec2 position_W{0, 0};  // at the time of SpaceTimeInput::state
    Vec2 velocity_W{0, 0};
    double radius = 0;
    double speed = 0;  // [m/s]
    double turns = 0;  // [m/s] its velocity may soon differ by this much
    double off = 0;    // [m] its position may differ by this much
  };
  bool goes_on(const SpaceTimeInput& in) const;
  void gather(const SpaceTimeInput& in);
  bool attempt(const SpaceTimeInput& in, bool strict, Weighing& out);
  void expand(const SpaceTimeInput& in, std::size_t level, double time, const State& from);
  std::optional<State> follow_plan(const SpaceTimeInput& in) const;
  Twist2 planned(const SpaceTimeInput& in) const;
  double cost(const SpaceTimeInput& in, const State& s) const;
  bool stops_clear(const SpaceTimeInput& in, const Twist2& twist) const;
  double lacking(const SpaceTimeInput& in, const Twist2& twist) const;
  Twist2 least_bad(const SpaceTimeInput& in);
  bool step(
      const SpaceTimeInput& in, double time, double length, const Twist2& twist, State& s) const;
  /// The distance to moving obstacles in the future.
  struct Nearness {
    double room = 0;  // [m] beyond the margin
    double risk = 0;  // [s/s] cost; 0: no obstacle could turn and soon be here
  };
  Nearness nearness(const SpaceTimeInput& in, double time, const MotionState& at) const;
  void keep_best();

  std::vector<State> states_, next_;
  std::vector<std::uint32_t> bins_, bin_round_;
  std::vector<std::uint32_t> order_;
  std::uint32_t round_ = 0;
  std::vector<Mover> movers_;     // those that move, then those that stand
  std::size_t moving_ = 0;        // of movers_
  double static_margin_ = 0;      // [m] from static obstacles in this search,
  double static_room_ = 0;        // [m] and on the way to rest
  double margin_share_ = 1;       // share of the margins from moving obstacles
  bool may_rest_ = false;         // a robot at rest may be touched, at a cost
  std::vector<char> stops_;       // whether braking after that command avoids static obstacles
  std::vector<double> lacks_;     // [m] of room to moving obstacles, braking after that command
  Way plan_{};                    // the motion that it follows
  double plan_since_ = kNoPlan;   // [s] run clock
  double searched_at_ = kNoPlan;  // [s] run clock
  bool clear_ = false;
};

}  // namespace algo
