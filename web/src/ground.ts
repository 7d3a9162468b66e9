// web/src/ground.ts: heights and slopes of the ground, and how the robot stands on it.
import { Point, to_child } from "./geometry";
import { Tilt } from "./link/frame";
import { Obstacle, covers, is_ground } from "./obstacle";
import type { SceneState } from "./state/scene";

/** [m] Height of the top of ground `o` at `p` (W), which lies within its outline; below 0 in a trench. */
export function top_at(o: Obstacle, p: Point): number {
  return o.kind === "trench" ? o.low : o.low + (o.height - o.low) * (to_child(o.pose, p).x / o.length + 0.5);
}

/** [rad] Rise of ground `o` along its heading; negative where it falls. */
export function slope_of(o: Obstacle): number {
  return o.kind === "ramp" ? Math.atan2(o.height - o.low, o.length) : 0;
}

/** [m] Height of the highest ground under `p` (W); that of the floor without any, below 0 in a trench alone. */
export function height_at(ground: Obstacle[], p: Point): number {
  const tops = ground.filter((o) => is_ground(o) && covers(o, p, 0)).map((o) => top_at(o, p));
  return tops.length > 0 ? Math.max(...tops) : 0;
}

/** How the robot stands: the simulator's truth, else as it measures itself; null where nothing tells. */
export function tilt_of({ frame, inclination }: SceneState): Tilt | null {
  return frame?.tilt ?? (inclination && { z: 0, ...inclination });
}

/** The steepest way down on the robot's own plane: its bearing in R, and its angle below the level [rad]. */
export function downhill({ roll, pitch }: { roll: number; pitch: number }): { bearing: number; angle: number } {
  const [x, y] = [Math.sin(pitch), -Math.sin(roll) * Math.cos(pitch)]; // of gravity, in R
  return { bearing: Math.atan2(y, x), angle: Math.acos(Math.min(1, Math.max(-1, Math.cos(roll) * Math.cos(pitch)))) };
}
