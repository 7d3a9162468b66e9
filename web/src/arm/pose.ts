// web/src/arm/pose.ts: a pose of the hand: as a unit quaternion, as axes, and as a person says it: the direction in
// which the hand points, and its turn about itself.
import type { HandGoalJson } from "../contract";
import { wrap_angle } from "../geometry";
import type { ArmPlace } from "./chain";
import { Axes, Vec3, add, scaled } from "./vector";

export type Quaternion = Pick<HandGoalJson, "qw" | "qx" | "qy" | "qz">;

/** [rad] `bearing`: of the direction, from W's x to the left. `pitch`: of the direction, above the level. `turn`: of
 * the hand about its own axis. */
export interface Pointing { bearing: number; pitch: number; turn: number }

/** The turn by `angle` [rad] about a unit `axis`. */
export function about(axis: Vec3, angle: number): Quaternion {
  const s = Math.sin(angle / 2);
  return { qw: Math.cos(angle / 2), qx: s * axis[0], qy: s * axis[1], qz: s * axis[2] };
}

/** First `b`, then `a`. */
export function product(a: Quaternion, b: Quaternion): Quaternion {
  const q = {
    qw: a.qw * b.qw - a.qx * b.qx - a.qy * b.qy - a.qz * b.qz,
    qx: a.qw * b.qx + a.qx * b.qw + a.qy * b.qz - a.qz * b.qy,
    qy: a.qw * b.qy - a.qx * b.qz + a.qy * b.qw + a.qz * b.qx,
    qz: a.qw * b.qz + a.qx * b.qy - a.qy * b.qx + a.qz * b.qw,
  };
  const size = Math.hypot(q.qw, q.qx, q.qy, q.qz);
  return { qw: q.qw / size, qx: q.qx / size, qy: q.qy / size, qz: q.qz / size };
}

/** The axes of the frame that is turned by `q`. */
export function axes_of({ qw: w, qx: x, qy: y, qz: z }: Quaternion): Axes {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ];
}

/** The quaternion of a frame with these axes, by the largest of its four parts. */
export function quaternion_of([x, y, z]: Axes): Quaternion {
  const trace = x[0] + y[1] + z[2];
  const parts = [trace, x[0], y[1], z[2]];
  const largest = parts.indexOf(Math.max(...parts));
  const s = 2 * Math.sqrt(1 + 2 * parts[largest] - trace);
  const [wx, wy, wz] = [y[2] - z[1], z[0] - x[2], x[1] - y[0]];
  const [xy, xz, yz] = [y[0] + x[1], z[0] + x[2], z[1] + y[2]];
  switch (largest) {
    case 0: return { qw: s / 4, qx: wx / s, qy: wy / s, qz: wz / s };
    case 1: return { qw: wx / s, qx: s / 4, qy: xy / s, qz: xz / s };
    case 2: return { qw: wy / s, qx: xy / s, qy: s / 4, qz: yz / s };
    default: return { qw: wz / s, qx: xz / s, qy: yz / s, qz: s / 4 };
  }
}

/** Rz(bearing) Ry(90 degrees - pitch) Rz(turn). */
export function quaternion_to({ bearing, pitch, turn }: Pointing): Quaternion {
  return product(product(about([0, 0, 1], bearing), about([0, 1, 0], Math.PI / 2 - pitch)), about([0, 0, 1], turn));
}

const kUpright = 1e-6; // part of a unit vector: then bearing and turn are one, and it is the turn that is 0

export function pointing_of(q: Quaternion): Pointing {
  const [x, y, z] = axes_of(q);
  const pitch = Math.asin(Math.max(-1, Math.min(1, z[2])));
  if (Math.hypot(z[0], z[1]) < kUpright) {
    return { bearing: wrap_angle(Math.atan2(y[1], y[0]) - Math.PI / 2), pitch, turn: 0 };
  }
  return { bearing: Math.atan2(z[1], z[0]), pitch, turn: wrap_angle(Math.atan2(y[2], -x[2])) };
}

/** Where the hand is now, as a goal. */
export function goal_at({ hand: { at, axes } }: ArmPlace): HandGoalJson {
  return { x: at[0], y: at[1], z: at[2], ...quaternion_of(axes) };
}

export const place_of = ({ x, y, z }: HandGoalJson): Vec3 => [x, y, z];

/** The wrist of a hand of `length` [m] at `goal`. */
export function wrist_of(goal: HandGoalJson, length: number): Vec3 {
  return add(place_of(goal), scaled(axes_of(goal)[2], -length));
}

/** `goal` moved by `by` [m] in W. */
export function moved(goal: HandGoalJson, by: Vec3): HandGoalJson {
  return { ...goal, x: goal.x + by[0], y: goal.y + by[1], z: goal.z + by[2] };
}

/** `goal` turned by `angle` [rad] about an axis of W through it. */
export function turned(goal: HandGoalJson, axis: Vec3, angle: number): HandGoalJson {
  return { ...goal, ...product(about(axis, angle), goal) };
}
