// web/src/edit/handles.ts: the points by which a selected obstacle is turned and resized.
import { Point, distance, to_child, to_parent } from "../geometry";
import { Obstacle, is_ground, is_robot, outline } from "../obstacle";
import { corners_of, kLeastGround, new_polygon, new_wall, polygon_defect, speed_of, walk } from "./edits";

export interface Handle {
  at: Point;                      // in W
  kind: "corner" | "turn" | "key";
  label: string;                  // of the edit
  to(p: Point): Obstacle | null;  // the obstacle with the handle at `p`; null: not possible
}

const kLeast = 0.05;   // [m] of a side or a radius
const kAway = 0.35;    // [m] of the handle that turns, from the edge

/** The handles of `o`; a robot has none. */
export function handles_of(o: Obstacle): Handle[] {
  if (is_robot(o)) return [];
  return [...shape_handles(o), ...path_handles(o)];
}

function shape_handles(o: Obstacle): Handle[] {
  if (o.path) return []; // its place is that of this moment
  switch (o.kind) {
    case "cylinder":
      return [{
        at: { x: o.pose.x + o.radius, y: o.pose.y }, kind: "corner", label: "Resize cylinder",
        to: (p) => ({ ...o, radius: Math.max(kLeast, distance(p, o.pose)) }),
      }];
    case "wall":
      return [...wall_ends(o), turn_handle(o, o.width / 2)];
    case "box":
    case "ramp":
    case "step":
    case "trench":
      return [...box_corners(o), turn_handle(o, o.width / 2)];
    case "polygon":
      return [...polygon_corners(o), turn_handle(o, Math.max(0, ...o.points.map((p) => p.y)))];
  }
}

/** Above the middle of the obstacle, `edge` [m] of which lie in between. */
function turn_handle(o: Obstacle, edge: number): Handle {
  return {
    at: to_parent(o.pose, 0, edge + kAway), kind: "turn", label: `Turn ${o.kind}`,
    to: (p) => ({ ...o, pose: { ...o.pose, heading: Math.atan2(p.y - o.pose.y, p.x - o.pose.x) - Math.PI / 2 } }),
  };
}

function wall_ends(o: Obstacle): Handle[] {
  const a = to_parent(o.pose, -o.length / 2, 0);
  const b = to_parent(o.pose, o.length / 2, 0);
  const wall = (from: Point, to: Point) => (distance(from, to) < kLeast ? null
    : { ...o, ...pick(new_wall(from, to, o.width)) });
  return [
    { at: a, kind: "corner", label: "Move the end of a wall", to: (p) => wall(p, b) },
    { at: b, kind: "corner", label: "Move the end of a wall", to: (p) => wall(a, p) },
  ];
}

function pick(wall: Obstacle): Pick<Obstacle, "pose" | "length"> {
  return { pose: wall.pose, length: wall.length };
}

/** The opposite corner stays where it is. */
function box_corners(o: Obstacle): Handle[] {
  const least = is_ground(o) ? kLeastGround : kLeast;
  return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([sx, sy]): Handle => {
    const fixed = { x: -sx * o.length / 2, y: -sy * o.width / 2 };
    return {
      at: to_parent(o.pose, sx * o.length / 2, sy * o.width / 2), kind: "corner", label: `Resize ${o.kind}`,
      to: (p) => {
        const here = to_child(o.pose, p);
        const length = Math.max(least, sx * (here.x - fixed.x));
        const width = Math.max(least, sy * (here.y - fixed.y));
        const middle = to_parent(o.pose, fixed.x + sx * length / 2, fixed.y + sy * width / 2);
        return { ...o, pose: { ...middle, heading: o.pose.heading }, length, width };
      },
    };
  });
}

function polygon_corners(o: Obstacle): Handle[] {
  const corners = outline(o);
  return corners.map((at, i): Handle => ({
    at, kind: "corner", label: "Move a corner",
    to: (p) => {
      const moved = corners.map((c, k) => (k === i ? p : c));
      if (polygon_defect(moved)) return null;
      const { pose, points } = new_polygon(moved);
      return { ...o, pose, points };
    },
  }));
}

function path_handles(o: Obstacle): Handle[] {
  const { path } = o;
  if (!path || path.comes_and_goes) return []; // a recording has its own times
  const corners = corners_of(path);
  return corners.map((at, i): Handle => ({
    at, kind: "key", label: "Move a corner of a path",
    to: (p) => {
      const moved = corners.map((c, k) => (k === i ? p : c));
      return { ...o, path: { ...walk(moved, speed_of(path)), phase: path.phase ?? 0 } };
    },
  }));
}
