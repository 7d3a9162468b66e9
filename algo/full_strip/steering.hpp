// algo/full_strip/steering.hpp: the course of the strip's commands, which its turns follow calmly.
#pragma once

#include "algo/full_strip/motion.hpp"
#include "algo/types.hpp"

namespace algo {

/// The last command, how fast the commands change, and the side of the last turn.
struct CommandCourse {
  Twist2 command{};
  Twist2 rate{};    // [m/s2], [rad/s2]
  double side = 0;  // 1: left, -1: right, 0: it has not turned yet
};

/// The course after `command`, given `dt` [s] after the last one.
CommandCourse followed(const CommandCourse& course, const Twist2& command, double dt);

/// `wanted` of a robot that drives, without the trembling of the strip's nodes: its turn rate
/// approaches the wanted one with a time constant, and a turn to the other side must be worth it.
Twist2 steadied(const CommandCourse& course, const Twist2& wanted, double dt);

/// `wanted` with as much of its turn as the base can have one tick of `dt` [s] after the last
/// command.
Twist2 ramped_turn(const CommandCourse& course,
                   const Twist2& wanted,
                   const MotionLimits& limits,
                   double dt);

/// `wanted` as nearly as acceleration and jerk allow `dt` [s] after the last command. The commands
/// pass it by no more than their change within a tick, jerk dt^2 / 4. Without a limit of the jerk
/// it is `wanted`.
Twist2 eased(const CommandCourse& course,
             const Twist2& wanted,
             const MotionLimits& limits,
             double dt);

/// True if `command` changes the course faster than the limits of the jerk allow.
bool is_hard(const CommandCourse& course,
             const Twist2& command,
             const MotionLimits& limits,
             double dt);

}  // namespace algo
