// web/src/edit/edits.ts: the edits of people, each as one value with its undo.
import { GoalJson, RequestJson } from "../contract";
import { Point, Pose, distance } from "../geometry";
import { Goal } from "../link/frame";
import {
  GroundKind, Obstacle, ObstacleJson, PathJson, obstacle_from_json, obstacle_name, obstacle_title, obstacle_to_json,
} from "../obstacle";
import { Route } from "../state/goals";
import { Edit } from "./history";

/** One step of an edit: a request, or a change of the run. */
export type Step = RequestJson
  | { type: "load"; body: Record<string, unknown> }
  | { type: "start"; pose: Pose };

export function goal_json({ x, y, heading }: Goal): { x: number; y: number; heading?: number } {
  return heading === null ? { x, y } : { x, y, heading };
}

export function goal_request(goal: Goal | null): RequestJson {
  return goal ? { type: "set_goal", ...goal_json(goal) } : { type: "clear_goal" };
}

export function route_request({ goals, next, loop }: Route): RequestJson {
  return { type: "set_goals", goals: goals.map((g): GoalJson => goal_json(g)), next, loop };
}

/** A change of the goals, which undo takes back as a whole. */
export function route_edit(label: string, from: Route, to: Route): Edit {
  return { label, forward: route_request(to), backward: route_request(from) };
}

/** `route` without the goal at `index`. */
export function without_goal({ goals, next, loop }: Route, index: number): Route {
  const left = goals.filter((_, i) => i !== index);
  const at = index < next ? next - 1 : next;
  return { goals: left, next: Math.max(0, Math.min(at, left.length - 1)), loop: loop && left.length > 1 };
}

/** `route` with the goal at `index` moved `by` places. The robot still drives to the same goal. */
export function reordered({ goals, next, loop }: Route, index: number, by: number): Route {
  const order = goals.map((_, i) => i);
  order.splice(index, 1);
  order.splice(index + by, 0, index);
  return { goals: order.map((i) => goals[i]), next: order.indexOf(next), loop };
}

export function add_edit(obstacle: Obstacle): Edit {
  return {
    label: `Add ${obstacle_name(obstacle).toLowerCase()}`,
    forward: { type: "add_obstacle", obstacle: obstacle_to_json(obstacle) },
    backward: null, // the history adds it once the server has answered with the id
  };
}

/** The JSON of an obstacle that the world has. */
function standing(o: Obstacle): ObstacleJson {
  return { ...obstacle_to_json(o), id: o.id };
}

/** A change of shape, size or path. */
export function change_edit(label: string, from: Obstacle, to: Obstacle): Edit {
  return {
    label,
    forward: { type: "change_obstacle", obstacle: standing(to) },
    backward: { type: "change_obstacle", obstacle: standing(from) },
  };
}

export function start_edit(from: Pose, to: Pose): Edit {
  return { label: "Move start", forward: { type: "start", pose: to }, backward: { type: "start", pose: from } };
}

export function move_request(id: number, pose: Pose): RequestJson {
  return { type: "move_obstacle", id, x: pose.x, y: pose.y, heading: pose.heading };
}

export function move_edit(o: Obstacle, from: Pose, to: Pose): Edit {
  return {
    label: `Move ${obstacle_title(o).toLowerCase()}`,
    forward: move_request(o.id, to), backward: move_request(o.id, from),
  };
}

export function remove_edit(obstacle: Obstacle): Edit {
  return {
    label: `Remove ${obstacle_title(obstacle).toLowerCase()}`,
    forward: { type: "remove_obstacle", id: obstacle.id },
    backward: { type: "add_obstacle", obstacle: standing(obstacle) },
  };
}

/** Obstacles that are not drawn to size: [m] radius of a cylinder, sides of a box. */
export const kUsualRadius = 0.3;
export const kUsualSide = 0.6;
export const kThickness = 0.1;  // [m] of a wall
/** [m] Of a side of ground: a trench may be narrow. */
export const kLeastGround = 0.005;
/** [m] Ground that is not drawn to size: along and across the way over it, its height or depth. */
export const kUsualGround: Record<GroundKind, { length: number; width: number; rise: number }> = {
  ramp: { length: 1.5, width: 1.5, rise: 0.15 }, step: { length: 1, width: 1.5, rise: 0.02 },
  trench: { length: 0.1, width: 1.5, rise: 0.1 },
};
export const kWalkerRadius = 0.25; // [m] of a person
export const kWalkSpeed = 0.8;     // [m/s]

/** Hands are exact to a centimetre at best, and round values read better. */
export function round_cm(v: number): number {
  return Math.round(v * 100) / 100;
}

const kBlank = { id: 0, radius: 0, length: 0, width: 0, points: [], height: 1, low: 0, bottom: 0, path: null, away: false, extra: {} };

export function new_cylinder(x: number, y: number, radius: number): Obstacle {
  return { ...kBlank, kind: "cylinder", pose: { x, y, heading: 0 }, radius };
}

export function new_box(x: number, y: number, length: number, width: number, heading = 0): Obstacle {
  return { ...kBlank, kind: "box", pose: { x, y, heading }, length, width };
}

/** Ground about `pose` of the usual width and height; a ramp rises along the heading. */
export function new_ground(kind: GroundKind, pose: Pose, length = kUsualGround[kind].length): Obstacle {
  const { width, rise } = kUsualGround[kind];
  const deep = kind === "trench";
  return { ...kBlank, kind, pose, length, width, height: deep ? 0 : rise, low: deep ? -rise : kind === "step" ? rise : 0 };
}

export function new_wall(from: Point, to: Point, thickness: number): Obstacle {
  const pose = { x: (from.x + to.x) / 2, y: (from.y + to.y) / 2, heading: Math.atan2(to.y - from.y, to.x - from.x) };
  return { ...kBlank, kind: "wall", pose, length: distance(from, to), width: thickness };
}

export function new_polygon(corners: Point[]): Obstacle {
  return obstacle_from_json({ type: "polygon", points: corners.map((p) => [p.x, p.y]) });
}

/** A person who walks along `points` and back at `speed` [m/s]. */
export function new_walker(points: Point[], radius: number, speed: number): Obstacle {
  const { x, y } = points[0];
  return { ...new_cylinder(x, y, radius), path: walk(points, speed) };
}

/** There and back along `points` at `speed`. */
export function walk(points: Point[], speed: number): PathJson {
  const keys: PathJson["keys"] = [];
  const way = [...points, ...points.slice(0, -1).reverse()];
  let t = 0;
  way.forEach((p, i) => {
    if (i > 0) t += Math.max(0.01, distance(way[i - 1], p) / speed);
    keys.push([t, p.x, p.y]);
  });
  return { period: Math.max(0.1, t), keys };
}

/** The corners of a path there and back; of any other path all its keys. */
export function corners_of(path: PathJson): Point[] {
  const all = path.keys.map(([, x, y]) => ({ x, y }));
  const n = all.length;
  const back = n % 2 === 1 && all.every((p, i) => distance(p, all[n - 1 - i]) < 1e-6);
  return back ? all.slice(0, (n + 1) / 2) : all;
}

/** [m/s] of a path from its first key to its last. */
export function speed_of(path: PathJson): number {
  const way = path.keys.slice(1).reduce((sum, [, x, y], i) => sum + Math.hypot(x - path.keys[i][1], y - path.keys[i][2]), 0);
  const time = path.keys.at(-1)![0] - path.keys[0][0];
  return time > 0 ? way / time : 0;
}

/** `o` shifted with its path. */
export function shifted(o: Obstacle, dx: number, dy: number): Obstacle {
  const keys = o.path?.keys.map(([t, x, y]) => [t, x + dx, y + dy] as [number, number, number]);
  return {
    ...o, pose: { ...o.pose, x: o.pose.x + dx, y: o.pose.y + dy },
    path: o.path && keys ? { ...o.path, keys } : null,
  };
}

const kBeside = 0.5; // [m] from an obstacle to its duplicate

export function duplicate(o: Obstacle): Obstacle {
  return shifted({ ...o, id: 0 }, kBeside, -kBeside);
}

/** Why the corners make no obstacle, as a sentence; null if they make one. */
export function polygon_defect(corners: Point[]): string | null {
  if (corners.length < 3) return "A polygon needs three corners at least.";
  const turns = corners.map((p, i) => {
    const a = corners[(i + 1) % corners.length];
    const b = corners[(i + 2) % corners.length];
    return Math.sign((a.x - p.x) * (b.y - a.y) - (a.y - p.y) * (b.x - a.x));
  });
  const convex = turns.every((t) => t >= 0) || turns.every((t) => t <= 0);
  return convex ? null : "A polygon must be convex. Draw an inward corner as two polygons.";
}
