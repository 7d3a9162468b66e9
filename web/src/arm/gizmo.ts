// web/src/arm/gizmo.ts: the handles by which the goal of a hand is moved and turned in 3D, as geometry: three axes, the
// floor's plane, and three rings, which turn the angles that a person types.
import type { HandGoalJson } from "../contract";
import { Point, distance, least, to_segment, wrap_angle } from "../geometry";
import { axes_of, moved, place_of, turned } from "./pose";
import { Vec3, add, cross, dot, kUnit, length, minus, scaled } from "./vector";

export type HandleName = "x" | "y" | "z" | "level" | "bearing" | "pitch" | "turn";
/** `line`: as it is drawn, in W. `axis`: along which it moves, or about which it turns. */
export interface Handle { name: HandleName; axis: Vec3; line: Vec3[] }
/** A pointer's line of sight; `along` is a unit vector. */
export interface Ray { from: Vec3; along: Vec3 }

export const kRing = 0.66; // of the size of the gizmo
const kFrom = 0.2;         // where an axis begins, of the size
const kRingPoints = 48;
const kEdgeOn = 0.25;      // cosine of the sight to a ring's axis below which its plane is no help
const kShort = 14;         // [px] of an axis that cannot be held
const kArrowFirst = 5;     // [px] by which an axis goes before a ring

export const is_axis = ({ name }: Handle): boolean => name === "x" || name === "y" || name === "z";

/** Handles about `goal`, `size` [m] long. */
export function handles_of(goal: HandGoalJson, size: number): Handle[] {
  const at = place_of(goal);
  const out: Handle[] = (["x", "y", "z"] as const).map((name, k) =>
    ({ name, axis: kUnit[k], line: [add(at, scaled(kUnit[k], kFrom * size)), add(at, scaled(kUnit[k], size))] }));
  out.push({ name: "level", axis: kUnit[2], line: [at, at] });
  for (const [name, axis] of ring_axes(goal)) out.push({ name, axis, line: ring(at, axis, kRing * size) });
  return out;
}

/** The axes of bearing, pitch and turn. */
function ring_axes(goal: HandGoalJson): ["bearing" | "pitch" | "turn", Vec3][] {
  const [x, , z] = axes_of(goal);
  const level = cross(z, kUnit[2]); // up is positive about it
  const upright = length(level) < 1e-3;
  const pitch: Vec3 = upright ? [-x[1], x[0], 0] : level;
  return [["bearing", kUnit[2]], ["pitch", scaled(pitch, 1 / (length(pitch) || 1))], ["turn", z]];
}

function ring(at: Vec3, axis: Vec3, radius: number): Vec3[] {
  const [u, v] = basis(axis);
  return Array.from({ length: kRingPoints + 1 }, (_, k) => {
    const angle = (2 * Math.PI * k) / kRingPoints;
    return add(at, scaled(u, radius * Math.cos(angle)), scaled(v, radius * Math.sin(angle)));
  });
}

/** Two unit vectors normal to `axis` and to each other. */
function basis(axis: Vec3): [Vec3, Vec3] {
  const side = Math.abs(axis[2]) < 0.9 ? cross(kUnit[2], axis) : cross(kUnit[0], axis);
  const u = scaled(side, 1 / length(side));
  return [u, cross(axis, u)];
}

/** The handle within `slack` pixels of `px`; `to_screen` projects. */
export function handle_at(handles: Handle[], px: Point, slack: number, to_screen: (p: Vec3) => Point | null): Handle | null {
  const gap = (handle: Handle): number => {
    const line = handle.line.map(to_screen);
    const ends = [line[0], line[line.length - 1]];
    if (is_axis(handle) && !(ends[0] && ends[1] && distance(ends[0], ends[1]) >= kShort)) return Infinity; // it points at the eye
    let best = Infinity;
    for (let i = 1; i < line.length; ++i) {
      const [a, b] = [line[i - 1], line[i]];
      if (a && b) best = Math.min(best, to_segment(px, a, b));
    }
    return best - (handle.line.length === 2 ? kArrowFirst : 0);
  };
  const found = least(handles, gap);
  return found && gap(found) <= slack ? found : null;
}

/** How far along its axis [m], or about it [rad], a ray holds a handle about `at`; a place of the level plane has two
 * numbers. Null where the ray says nothing. */
function grip(handle: Handle, at: Vec3, ray: Ray): number[] | null {
  const { name, axis } = handle;
  const across = dot(ray.along, axis);
  const from = minus(ray.from, at);
  if (name === "level") {
    const way = -from[2] / ray.along[2];
    return Math.abs(ray.along[2]) > 1e-3 && way > 0 ? [from[0] + way * ray.along[0], from[1] + way * ray.along[1]] : null;
  }
  if (is_axis(handle)) { // nearest to the ray
    const bend = 1 - across * across;
    return bend > 1e-4 ? [(dot(from, axis) - across * dot(from, ray.along)) / bend] : null;
  }
  const [u, v] = basis(axis);
  if (Math.abs(across) > kEdgeOn) {
    const hit = add(from, scaled(ray.along, -dot(from, axis) / across));
    return [Math.atan2(dot(hit, v), dot(hit, u))];
  }
  // From its edge a ring is a line: its near half is turned like a wheel.
  const near = minus(scaled(ray.along, -1), scaled(axis, -across));
  const ahead = scaled(near, 1 / length(near));
  const aside = cross(axis, ahead);
  const closest = minus(from, scaled(ray.along, dot(from, ray.along)));
  const radius = distance3(handle.line[0], at);
  const angle = Math.asin(Math.max(-1, Math.min(1, dot(closest, aside) / radius)));
  return [angle + Math.atan2(dot(ahead, v), dot(ahead, u))];
}

const distance3 = (a: Vec3, b: Vec3) => length(minus(a, b));

/** A handle in the hand: the goal while the pointer is on another ray. */
export function begin_drag(handle: Handle, goal: HandGoalJson, start: Ray): (ray: Ray) => HandGoalJson {
  const at = place_of(goal);
  const first = grip(handle, at, start);
  let last = goal;
  return (ray) => {
    const now = grip(handle, at, ray);
    if (!first || !now) return last;
    const by = now[0] - first[0];
    if (handle.name === "level") last = moved(goal, [whole_cm(by), whole_cm(now[1] - first[1]), 0]);
    else if (is_axis(handle)) last = moved(goal, scaled(handle.axis, whole_cm(by)));
    else last = turned(goal, handle.axis, whole_degrees(wrap_angle(by)));
    return last;
  };
}

/** Hands are exact to a centimetre and a degree at best. */
const kDegree = Math.PI / 180;
const whole_cm = (v: number) => Math.round(v * 100) / 100;
const whole_degrees = (angle: number) => Math.round(angle / kDegree) * kDegree;
