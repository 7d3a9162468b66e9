// web/src/state/driven.ts: what a scene tells of a robot that somebody drives by hand: the force on the stick, the sectors
// that the laws hear, the followed wall. Live or of a stored run.
import { Point, Pose, degrees, to_parent, wrap_angle } from "../geometry";
import { fixed } from "../words";
import { LayerKey, kOwn } from "./layers";
import type { SceneState } from "./scene";
import { kRing, kWall } from "./stick";

const kSectors = 8;                // of the half circle ahead, from right to left
const kHalfSector = Math.PI / 12;  // [rad] half the cone of a sonar of the ring; cones overlap
const kDrawnHalf = Math.PI / 2 / (kSectors - 1); // [rad] up to the middle between two axes
const kAhead = 3;      // [s] for which the ways of stick and robot are drawn
const kShortest = 0.05; // [m] of such a way

export function measure(scene: SceneState, name: string): number | null {
  const value = scene.frame?.measures.find((m) => m.name === name)?.value;
  return value === undefined || !Number.isFinite(value) ? null : value;
}

/** The force that the laws reflect, of full force: ahead and left are positive. */
export function force_of(scene: SceneState): { forward: number; left: number } {
  return { forward: measure(scene, "teleop.force_forward") ?? 0, left: measure(scene, "teleop.force_left") ?? 0 };
}

/** [m/s, rad/s] What full stick asks for. */
export function full_stick(scene: SceneState): { v: number; omega: number } {
  const { parameters: p, top } = scene;
  const v = Math.min(top.v, p["teleop.v_max"] ?? Infinity), omega = Math.min(top.omega, p["teleop.w_max"] ?? Infinity);
  return { v: Number.isFinite(v) ? v : 1, omega: Number.isFinite(omega) ? omega : 1 };
}

/** The nearest thing in a sector of the ring. `bearing` of the sector's axis in W; `limits`: it slows the robot. */
export interface Sector { bearing: number; range: number; echo: boolean; limits: boolean }

/** The sectors that the laws hear, of the shown instant. */
export function ring_sectors(scene: SceneState): Sector[] {
  const layer = scene.layers.get(kRing), f = scene.frame;
  if (!layer || !f) return [];
  const reach = scene.parameters["teleop.d_max"] ?? Infinity;
  const found: { axis: number; range: number }[] = [];
  let next = 0; // sectors without a reading are left out, the others are in order
  for (let i = 0; i + 3 < layer.values.length; i += 4) {
    const [, , x, y] = layer.values.subarray(i, i + 4);
    const bearing = wrap_angle(Math.atan2(y, x) - f.pose.heading);
    while (next < kSectors - 1 && bearing - axis_of(next) > kHalfSector + kRounding) ++next;
    found.push({ axis: axis_of(next), range: Math.hypot(x, y) });
    next = Math.min(kSectors - 1, next + 1);
  }
  const nearest = Math.min(...found.map((s) => s.range));
  const slows = f.limit === "crowded" || f.limit === "obstacle_ahead";
  return found.map(({ axis, range }) => ({
    bearing: wrap_angle(f.pose.heading + axis), range, echo: range < reach - kRounding, limits: slows && range === nearest,
  }));
}

const kRounding = 0.01; // [m], [rad] of values on the wire

/** [rad] in R. */
function axis_of(sector: number): number {
  return (sector / (kSectors - 1) - 0.5) * Math.PI;
}

/** The outline of a sector's far side in W. */
export function sector_arc(pose: Pose, s: Sector, points = 9): Point[] {
  return Array.from({ length: points }, (_, i) => {
    const bearing = s.bearing + (2 * i / (points - 1) - 1) * kDrawnHalf;
    return { x: pose.x + s.range * Math.cos(bearing), y: pose.y + s.range * Math.sin(bearing) };
  });
}

const kAlong = 0.8; // [m] from the foot of the wall to its words, ahead

/** The followed wall: the distance [m] and the bearing [rad] of its foot from the robot, and the place of its words in W;
 * null without one. */
export function wall_of(scene: SceneState): { words: Point; rho: number; theta: number } | null {
  const rho = measure(scene, "teleop.wall_rho"), theta = measure(scene, "teleop.wall_theta"), pose = scene.frame?.pose;
  if (rho === null || theta === null || !pose || !scene.layers.has(kWall)) return null;
  const words = to_parent(pose, rho * Math.cos(theta) + kAlong * Math.abs(Math.sin(theta)),
    rho * Math.sin(theta) - kAlong * Math.cos(theta) * (theta < 0 ? -1 : 1));
  return { words, rho, theta };
}

/** Where the robot is in `kAhead` seconds at v [m/s], omega [rad/s], as a line from `pose`. */
export function way_of(pose: Pose, v: number, omega: number, points = 25): Point[] {
  return Array.from({ length: points }, (_, i) => {
    const t = (kAhead * i) / (points - 1), half = (omega * t) / 2;
    const chord = v * t * (Math.abs(half) < 1e-6 ? 1 : Math.sin(half) / half);
    return { x: pose.x + chord * Math.cos(pose.heading + half), y: pose.y + chord * Math.sin(pose.heading + half) };
  });
}

/** "Wall 0.75 m, −77°": its distance and its bearing from the robot's nose, left positive. */
export function wall_words(wall: { rho: number; theta: number }): string {
  return `Wall ${fixed(wall.rho, 2)} m, ${fixed(degrees(wall.theta), 0)}°`;
}

/** The ways of the next `kAhead` seconds that are not `hidden`: as the stick asks, and as the robot moves now. */
export function ways_ahead(scene: SceneState, hidden: ReadonlySet<string>): { key: LayerKey; line: Point[] }[] {
  const { stick, frame } = scene;
  if (!stick || !frame) return [];
  const full = full_stick(scene);
  const all = [
    { key: kOwn.wanted, v: stick.forward * full.v, omega: stick.turn * full.omega },
    { key: kOwn.executed, v: frame.twist.v, omega: frame.twist.omega },
  ];
  return all.filter(({ key, v }) => !hidden.has(key.name) && Math.abs(v) * kAhead >= kShortest)
    .map(({ key, v, omega }) => ({ key, line: way_of(frame.pose, v, omega) }));
}
