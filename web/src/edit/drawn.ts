// web/src/edit/drawn.ts: what a drag or a row of taps on the scene makes, by tool.
import { Point, Pose, distance, to_parent } from "../geometry";
import { Goal } from "../link/frame";
import { GroundKind, Obstacle } from "../obstacle";
import {
  kLeastGround, kThickness, kUsualGround, kUsualRadius, kUsualSide, kWalkSpeed, kWalkerRadius, new_box, new_cylinder,
  new_ground, new_polygon, new_wall, new_walker, polygon_defect, round_cm,
} from "./edits";

/** `pan` moves the view, and a press selects. */
export type Tool = "pan" | "goal" | "hand" | "start" | "pose" | "wall" | "box" | "cylinder" | "polygon" | "mover" | "measure" | GroundKind;
/** Tools that make an obstacle of one drag, and those that take a point at a time. */
export type DragTool = "wall" | "box" | "cylinder" | GroundKind;
export type SketchTool = "wall" | "polygon" | "mover";

const kMeets = 1e-3;   // [m] between the ends of two pieces of ground that meet
const kLeast = 0.05;   // [m] least radius, half side or length of a drawn obstacle

export function is_sketch(tool: Tool): tool is SketchTool {
  return tool === "wall" || tool === "polygon" || tool === "mover";
}

export function is_ground_tool(tool: Tool): tool is GroundKind {
  return tool in kUsualGround;
}

/** [m] Of the ramp or step whose end lies at `p`; null without one. */
function end_height(ground: Obstacle[], p: Point): number | null {
  for (const o of ground.filter((o) => o.kind === "ramp" || o.kind === "step")) {
    if (distance(to_parent(o.pose, -o.length / 2, 0), p) < kMeets) return o.low;
    if (distance(to_parent(o.pose, o.length / 2, 0), p) < kMeets) return o.height;
  }
  return null;
}

/** `o`, drawn from `at` to `to`, as high as the ground that it meets there. */
function joined(o: Obstacle, at: Point, to: Point, ground: Obstacle[]): Obstacle {
  const [low, high] = [end_height(ground, at), end_height(ground, to)];
  if (o.kind === "ramp") return { ...o, low: low ?? 0, height: high ?? (low ?? 0) + o.height };
  const height = low ?? high ?? o.height;
  return o.kind === "step" ? { ...o, low: height, height } : o;
}

export function dragged_goal(at: Point, to: Point, with_heading: boolean): Goal {
  return { x: round_cm(at.x), y: round_cm(at.y), heading: with_heading ? direction(at, to) : null };
}

/** The start at `at`, turned towards `to`; without a drag its heading stays. */
export function dragged_start(at: Point, to: Point, turned: boolean, before: Pose | null): Pose {
  return { x: round_cm(at.x), y: round_cm(at.y), heading: turned ? direction(at, to) : before?.heading ?? 0 };
}

function direction(from: Point, to: Point): number {
  return Math.atan2(to.y - from.y, to.x - from.x);
}

/** A click makes an obstacle of usual size; a drag from the centre makes it as large as drawn. A wall
 * goes from end to end; a click is its first end. Ground is drawn the way over it, a ramp uphill, and
 * goes on at the height of other `ground` where their ends meet. */
export function dragged_obstacle(kind: DragTool, at: Point, to: Point, dragged: boolean, ground: Obstacle[] = []): Obstacle | null {
  const x = round_cm(at.x);
  const y = round_cm(at.y);
  if (kind === "wall") return dragged && distance(at, to) >= kLeast ? new_wall(at, to, kThickness) : null;
  if (kind === "cylinder") {
    const radius = dragged ? Math.max(kLeast, distance(at, to)) : kUsualRadius;
    return new_cylinder(x, y, round_cm(radius));
  }
  if (is_ground_tool(kind)) {
    if (!dragged) return new_ground(kind, { x, y, heading: 0 });
    const middle = { x: (at.x + to.x) / 2, y: (at.y + to.y) / 2, heading: direction(at, to) };
    return joined(new_ground(kind, middle, Math.max(kLeastGround, distance(at, to))), at, to, ground);
  }
  const length = dragged ? Math.max(kLeast, Math.abs(to.x - at.x)) * 2 : kUsualSide;
  const width = dragged ? Math.max(kLeast, Math.abs(to.y - at.y)) * 2 : kUsualSide;
  return new_box(x, y, round_cm(length), round_cm(width));
}

/** The effect of one more point of a sketch. */
export type Sketched =
  | { points: Point[] }         // it goes on with these
  | { obstacle: Obstacle }      // it is complete
  | { refusal: string };        // the point is not taken

/** Adds `p` to `points`. A second point ends a wall. A press on the first or the last corner ends a polygon. A press
 * on the last point ends a path. Points within `reach` [m] are the same. */
export function sketched(tool: SketchTool, points: Point[], p: Point, reach: number): Sketched {
  const last = points.at(-1);
  const again = last !== undefined && distance(last, p) <= reach;
  if (tool === "wall") {
    if (!last) return { points: [p] };
    return again ? { refusal: "A wall needs two ends." } : { obstacle: new_wall(last, p, kThickness) };
  }
  const closes = tool === "polygon" && points.length > 2 && distance(points[0], p) <= reach;
  if (again || closes) return finished(tool, points);
  return { points: [...points, p] };
}

/** The obstacle that `points` make. */
export function finished(tool: SketchTool, points: Point[]): Sketched {
  if (tool === "polygon") {
    const defect = polygon_defect(points);
    return defect ? { refusal: defect } : { obstacle: new_polygon(points) };
  }
  if (points.length < 2) return { refusal: tool === "wall" ? "A wall needs two ends." : "A path needs two points at least." };
  return { obstacle: tool === "wall" ? new_wall(points[0], points[1], kThickness)
    : new_walker(points, kWalkerRadius, kWalkSpeed) };
}
