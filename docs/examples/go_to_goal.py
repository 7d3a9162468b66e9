"""docs/examples/go_to_goal.py: turns to the goal and drives there; slows down before an obstacle."""
import math

import tautline


def update(seen):
    if seen.goal is None:
        return 0.0, 0.0
    x, y, heading = seen.pose
    bearing = math.atan2(seen.goal[1] - y, seen.goal[0] - x)
    error = math.remainder(bearing - heading, 2 * math.pi)
    ahead = min(seen.ranges, default=seen.range_max)  # [m] nearest return of all beams
    speed = 0.3 * max(0.0, math.cos(error)) * min(1.0, max(0.2, ahead - 0.5))
    return speed, max(-1.0, min(1.0, 2 * error))


tautline.drive(update)
