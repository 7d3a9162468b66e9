// web/src/edit/snap.ts: pulls a point to corners of the world and to round numbers.
import { Point, distance } from "../geometry";
import { Obstacle, is_ground, outline } from "../obstacle";
import { round_cm } from "./edits";

const kGrid = 0.1; // [m]

/** The nearest corner within `reach` [m] of `p`, else the nearest point of the grid; to a centimetre
 * where snapping is off. */
export function snapped(p: Point, obstacles: Obstacle[], reach: number, on: boolean): Point {
  if (!on) return { x: round_cm(p.x), y: round_cm(p.y) };
  let best: Point | null = null;
  for (const corner of obstacles.flatMap(corners)) {
    const d = distance(corner, p);
    if (d <= reach && (!best || d < distance(best, p))) best = corner;
  }
  if (best) return { x: best.x, y: best.y };
  const round = (v: number) => round_cm(Math.round(v / kGrid) * kGrid);
  return { x: round(p.x), y: round(p.y) };
}

/** The ends of a wall's middle line, and the corners of another obstacle. Ground has both: one piece goes on at the next. */
function corners(o: Obstacle): Point[] {
  if (o.path) return [];
  const all = outline(o);
  if (o.kind !== "wall" && !is_ground(o)) return all;
  const middle = (a: Point, b: Point) => ({ x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 });
  const ends = [middle(all[0], all[3]), middle(all[1], all[2])];
  return is_ground(o) ? [...all, ...ends] : ends;
}
