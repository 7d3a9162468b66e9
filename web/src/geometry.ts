// web/src/geometry.ts: poses, angles and obstacle outlines; metres and radians, ccw positive.

export interface Point { x: number; y: number }
export interface Pose { x: number; y: number; heading: number }

/** `angle` wrapped to (-pi, pi]. */
export function wrap_angle(angle: number): number {
  const turns = angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
  return turns <= -Math.PI ? turns + 2 * Math.PI : turns;
}

export function degrees(angle: number): number {
  return (angle * 180) / Math.PI;
}

export function radians(angle_deg: number): number {
  return (angle_deg * Math.PI) / 180;
}

/** A point of the child frame expressed in the parent of `pose`. */
export function to_parent(pose: Pose, x: number, y: number): Point {
  const c = Math.cos(pose.heading);
  const s = Math.sin(pose.heading);
  return { x: pose.x + c * x - s * y, y: pose.y + s * x + c * y };
}

/** A point of the parent frame expressed in the frame of `pose`. */
export function to_child(pose: Pose, p: Point): Point {
  const c = Math.cos(pose.heading);
  const s = Math.sin(pose.heading);
  const dx = p.x - pose.x;
  const dy = p.y - pose.y;
  return { x: c * dx + s * dy, y: -s * dx + c * dy };
}

export function compose(outer: Pose, inner: Pose): Pose {
  const p = to_parent(outer, inner.x, inner.y);
  return { x: p.x, y: p.y, heading: wrap_angle(outer.heading + inner.heading) };
}

export function distance(a: Point, b: Point): number {
  return Math.hypot(a.x - b.x, a.y - b.y);
}

/** From `p` to the segment from `a` to `b`. */
export function to_segment(p: Point, a: Point, b: Point): number {
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  const share = Math.max(0, Math.min(1, ((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy || 1)));
  return distance(p, { x: a.x + share * dx, y: a.y + share * dy });
}

/** A rectangle of W; empty if min > max. */
export interface Bounds { min_x: number; min_y: number; max_x: number; max_y: number }

export function empty_bounds(): Bounds {
  return { min_x: Infinity, min_y: Infinity, max_x: -Infinity, max_y: -Infinity };
}

export function include(bounds: Bounds, x: number, y: number, margin = 0): void {
  if (!Number.isFinite(x) || !Number.isFinite(y)) return;
  bounds.min_x = Math.min(bounds.min_x, x - margin);
  bounds.min_y = Math.min(bounds.min_y, y - margin);
  bounds.max_x = Math.max(bounds.max_x, x + margin);
  bounds.max_y = Math.max(bounds.max_y, y + margin);
}

/** The one of `all` with the least `measure`; null if there is none. */
export function least<T>(all: readonly T[], measure: (one: T) => number): T | null {
  return all.reduce<T | null>((best, one) => (best === null || measure(one) < measure(best) ? one : best), null);
}
