// web/src/obstacle.ts: obstacles and pieces of ground as the page holds them: a shape about a pose in W. In JSON,
// polygons and walls have their coordinates in W; here every kind has a pose.
import { Bounds, Point, Pose, distance, include, to_child, to_parent } from "./geometry";

export type ObstacleKind = "cylinder" | "box" | "polygon" | "wall" | GroundKind;
/** Pieces of ground, over which a robot drives. A step is a ramp of one height. */
export type GroundKind = "ramp" | "step" | "trench";

export interface Obstacle {
  id: number;
  kind: ObstacleKind;
  pose: Pose;        // in W
  radius: number;    // [m] cylinder
  length: number;    // [m] box, wall, ground: along its x axis
  width: number;     // [m] box, ground; a wall's thickness
  points: Point[];   // polygon, in its own frame
  height: number;    // [m]; of a ramp at x = length / 2; of a trench 0
  bottom: number;    // [m] above the floor: there is room below it
  low: number;       // [m] top of the ground at x = -length / 2; below 0 in a trench
  path: PathJson | null; // of its reference point, if it moves by itself
  away: boolean;     // it comes and goes, and no frame has told that it is there now
  /** Optional fields of the JSON, as undo returns them; absent ones are undefined. */
  extra: Pick<ObstacleJson, "reflectivity" | "specular" | "height">;
}

/**
 * Keys [t, x, y] in seconds and metres of W, linear in between, repeated each `period`. One that comes and goes is there
 * from its first key to its last only.
 */
export interface PathJson { period: number; phase?: number; comes_and_goes?: boolean; keys: [number, number, number][] }

/** The JSON form, as in scenario files. */
export interface ObstacleJson {
  id?: number;
  type: ObstacleKind;
  x?: number;
  y?: number;
  heading?: number;
  radius?: number;
  length?: number;
  width?: number;
  thickness?: number;
  points?: [number, number][];
  from?: [number, number];
  to?: [number, number];
  height?: number;
  bottom?: number;
  low?: number;
  depth?: number;
  reflectivity?: number;
  specular?: boolean;
  path?: PathJson;
}

export function obstacle_from_json(json: ObstacleJson): Obstacle {
  const { reflectivity, specular, height } = json;
  const out: Obstacle = {
    id: json.id ?? 0,
    kind: json.type,
    pose: { x: json.x ?? 0, y: json.y ?? 0, heading: json.heading ?? 0 },
    radius: json.radius ?? 0,
    length: json.length ?? 0,
    width: json.width ?? json.thickness ?? 0,
    points: [],
    height: json.type === "trench" ? 0 : height ?? 1,
    low: json.type === "trench" ? -(json.depth ?? 0) : json.type === "step" ? height ?? 0 : json.low ?? 0,
    bottom: json.bottom ?? 0,
    path: json.path ?? null,
    away: !!json.path?.comes_and_goes,
    extra: { reflectivity, specular, height },
  };
  if (json.type === "wall" && json.from && json.to) {
    const [ax, ay] = json.from;
    const [bx, by] = json.to;
    out.pose = { x: (ax + bx) / 2, y: (ay + by) / 2, heading: Math.atan2(by - ay, bx - ax) };
    out.length = Math.hypot(bx - ax, by - ay);
  }
  if (json.type === "polygon") {
    const world = (json.points ?? []).map(([x, y]) => ({ x, y }));
    if (json.x === undefined) out.pose = { ...centroid(world), heading: 0 };
    out.points = json.x === undefined ? world.map((p) => to_child(out.pose, p)) : world;
  }
  return out;
}

/** Of `obstacles` those that are there now. */
export function present(obstacles: Obstacle[]): Obstacle[] {
  return obstacles.filter((o) => !o.away);
}

/** The JSON that adds this obstacle again, without its id. */
export function obstacle_to_json(o: Obstacle): ObstacleJson {
  return { ...o.extra, ...shape_to_json(o), ...(o.bottom > 0 && { bottom: o.bottom }), ...(o.path && { path: o.path }) };
}

function shape_to_json(o: Obstacle): ObstacleJson {
  const { x, y, heading } = o.pose;
  const { kind: type, length, width, low, height } = o;
  switch (type) {
    case "cylinder":
      return { type, x, y, radius: o.radius };
    case "box":
      return { type, x, y, heading, length, width };
    case "trench":
      return { type, x, y, heading, length, width, depth: -low };
    case "ramp":
    case "step": // as its heights say
      return low === height ? { type: "step", x, y, heading, length, width, height }
        : { type: "ramp", x, y, heading, length, width, low, height };
    case "wall": {
      const a = to_parent(o.pose, -o.length / 2, 0);
      const b = to_parent(o.pose, o.length / 2, 0);
      return { type, from: [a.x, a.y], to: [b.x, b.y], thickness: width };
    }
    case "polygon":
      return { type, points: outline(o).map((p) => [p.x, p.y]) };
  }
}

/** The mean of the corners: the reference point of a polygon. */
function centroid(points: Point[]): Point {
  const mean = (values: number[]) => values.reduce((sum, v) => sum + v, 0) / Math.max(1, values.length);
  return { x: mean(points.map((p) => p.x)), y: mean(points.map((p) => p.y)) };
}

/** Corners in W, counter-clockwise; empty for a cylinder. */
export function outline(o: Obstacle): Point[] {
  if (o.kind === "cylinder") return [];
  if (o.kind === "polygon") return o.points.map((p) => to_parent(o.pose, p.x, p.y));
  const a = o.length / 2;
  const b = o.width / 2;
  return [to_parent(o.pose, -a, -b), to_parent(o.pose, a, -b), to_parent(o.pose, a, b),
    to_parent(o.pose, -a, b)];
}

/** Whether `p` (W) lies on the obstacle or within `slack` [m] of it. */
export function covers(o: Obstacle, p: Point, slack: number): boolean {
  if (o.kind === "cylinder") {
    return distance(p, o.pose) <= o.radius + slack;
  }
  const corners = outline(o);
  let inside = true;
  for (let i = 0; i < corners.length; ++i) {
    const a = corners[i];
    const b = corners[(i + 1) % corners.length];
    const edge = distance(a, b);
    if (edge === 0) continue;
    const left = ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / edge;
    if (left < -slack) inside = false;
  }
  return inside && corners.length > 2;
}

/** The obstacle under `p` (W) on top: the last one drawn, and ground only where nothing stands on it. */
export function topmost(obstacles: Obstacle[], p: Point, slack: number): Obstacle | null {
  const hits = present(obstacles).filter((o) => covers(o, p, slack));
  return hits.filter((o) => !is_ground(o)).at(-1) ?? hits.at(-1) ?? null;
}

/** True for ground: ramps, steps and trenches. */
export function is_ground(o: Obstacle): boolean {
  return o.kind === "ramp" || o.kind === "step" || o.kind === "trench";
}

/** Of one that moves by itself the whole way. */
export function include_obstacle(bounds: Bounds, o: Obstacle): void {
  for (const [, x, y] of o.path?.keys ?? []) include(bounds, x, y, o.radius);
  if (o.kind === "cylinder") include(bounds, o.pose.x, o.pose.y, o.radius);
  for (const p of outline(o)) include(bounds, p.x, p.y);
}

/** Robot n of a world, counted from 1, has the id kRobotIds + n among its obstacles. */
const kRobotIds = 1_000_000_000;

/** True for another robot of the world, which people cannot move. */
export function is_robot(o: Obstacle): boolean {
  return o.id > kRobotIds;
}

/** "Cylinder 3", "Robot 2". */
export function obstacle_title(o: Obstacle): string {
  return is_robot(o) ? `Robot ${o.id - kRobotIds}` : `${obstacle_name(o)} ${o.id}`;
}

export function obstacle_name(o: Obstacle): string {
  return o.kind[0].toUpperCase() + o.kind.slice(1);
}
