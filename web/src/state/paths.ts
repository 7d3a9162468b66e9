// web/src/state/paths.ts: where the obstacles are that move by themselves.
import { Obstacle, ObstacleJson } from "../obstacle";

export interface ObstaclePath {
  id: number;
  period: number;                    // [s]
  phase: number;                     // [s] of the path when the run begins
  keys: [number, number, number][];  // time [s], x, y [m]; times ascend
}

/** The paths of a scenario's obstacles; an obstacle without a number has its place in the list. */
export function paths_of(obstacles: ObstacleJson[]): ObstaclePath[] {
  return obstacles.flatMap((o, i) => o.path
    ? [{ id: o.id ?? i + 1, period: o.path.period, phase: o.path.phase ?? 0, keys: o.path.keys }] : []);
}

/** The place on `path` at `stamp` [s, run clock]: linear between keys, from the last back to the first. */
export function place_on(path: ObstaclePath, stamp: number): { x: number; y: number } {
  const time = (((stamp + path.phase) % path.period) + path.period) % path.period;
  const after = path.keys.findIndex((key) => key[0] > time);
  if (after === 0) return { x: path.keys[0][1], y: path.keys[0][2] };
  if (after < 0) return { x: path.keys.at(-1)![1], y: path.keys.at(-1)![2] };
  const [t0, x0, y0] = path.keys[after - 1];
  const [t1, x1, y1] = path.keys[after];
  const part = (time - t0) / (t1 - t0);
  return { x: x0 + part * (x1 - x0), y: y0 + part * (y1 - y0) };
}

export function moved_along(obstacles: Obstacle[], paths: ObstaclePath[], stamp: number): Obstacle[] {
  return obstacles.map((o) => {
    const path = paths.find((p) => p.id === o.id);
    return path ? { ...o, pose: { ...place_on(path, stamp), heading: o.pose.heading } } : o;
  });
}
