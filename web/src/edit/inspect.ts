// web/src/edit/inspect.ts: finds the thing of the scene under a pointer, in the view from above and
// in 3D alike. A thing is named so that later frames can find it again.
import type { Link } from "../arm/chain";
import { arm_at, plan_at } from "../arm/inspect";
import { Point, Pose, distance, to_child, to_segment, wrap_angle, least } from "../geometry";
import {
  LayerView, arcs, arrows, circles, grade_of, grid_place, kGround, kRing, kScanHeight, kStripHeight, kTallest, kUnknownCell,
  lines, places, sectors,
} from "../layer";
import { is_ground, topmost } from "../obstacle";
import { is_scaled, is_sensed, is_sketched, kOwn, visible_layers } from "../state/layers";
import { SceneState, robot_pose } from "../state/scene";
import { PlacedSweep, sweep_points } from "../state/sweeps";

export type Thing =
  | { kind: "beam"; scanner: number; beam: number }
  | { kind: "echo"; key: string }                    // of sonar or infrared
  | { kind: "mark"; layer: string; index: number }   // a point, node, arrow, circle or arc of a layer
  | { kind: "cell"; layer: string; at: Point }       // of a grid, by a place in it
  | { kind: "sector"; layer: string; index: number } // of a polar, by its place in `values`
  | { kind: "path"; t: number }                      // where the robot was at that time
  | { kind: "goal"; index: number }                  // 0: the present one
  | { kind: "obstacle"; id: number }
  | { kind: "ground"; id: number; at: Point }        // a ramp, step or trench, at a place on it
  | { kind: "link"; link: Link }                     // of an arm
  | { kind: "hand_goal" }
  | { kind: "planned"; index: number }               // a place of the arm's plan
  | { kind: "robot" };

/** How a pointer sees the scene. */
export interface Eye {
  px: Point;         // [px] the pointer
  slack: number;     // [px] within which it hits small things
  at: Point | null;  // the place of W under it, on the floor
  /** Pixels of a place in W at `height` [m]; null behind the eye. */
  to_screen(p: Point, height: number): Point | null;
  scale?: number;    // [px/m] of a view from above
  /** The body under the pointer, in a view that is not from above. */
  body?(): Thing | null;
}

/** What a page shows of the scene. */
export interface Shown { hidden: ReadonlySet<string>; force_scale: number }

const kOnRobot = 5; // [px] within which small things on the robot are hit: elsewhere on it is the robot

interface Hit { thing: Thing; px: number }

/** The thing under the pointer: small ones before bodies, bodies before lines, lines before the ground. */
export function thing_at(scene: SceneState, shown: Shown, eye: Eye): Thing | null {
  const layers = visible_layers(scene, shown.hidden);
  const from_above = eye.at && eye.scale !== undefined ? body_at(scene, eye.at, eye.slack / eye.scale) : null;
  const body = eye.body ? eye.body() : from_above;
  const arm = arm_at(scene, eye);
  const robot = arm ?? (body?.kind === "robot" || body?.kind === "link" ? body : null);
  const small = [...beam_hits(scene, shown, eye), ...mark_hits(scene, layers, shown, eye)];
  return nearest(small, robot ? Math.min(kOnRobot, eye.slack) : eye.slack)
    ?? goal_at(scene, eye) ?? robot
    ?? plan_at(scene, shown, eye) ?? nearest([...line_hits(scene, layers, eye), ...path_hits(scene, shown, eye)], eye.slack)
    ?? circle_at(scene, layers, eye) ?? body ?? (eye.at && ground_at(scene, layers, eye.at));
}

/** The body under `at` as seen from above. */
function body_at(scene: SceneState, at: Point, slack: number): Thing | null {
  const pose = robot_pose(scene);
  if (pose && on_hull(scene, to_child(pose, at))) return { kind: "robot" };
  const hit = topmost(scene.obstacles, at, slack);
  if (hit && is_ground(hit)) return { kind: "ground", id: hit.id, at };
  return hit ? { kind: "obstacle", id: hit.id } : null;
}

function on_hull({ hull, radius }: SceneState, p: Point): boolean {
  return hull ? Math.abs(p.x) <= hull.half_length && Math.abs(p.y) <= hull.half_width : Math.hypot(p.x, p.y) <= radius;
}

function nearest(hits: Hit[], slack: number): Thing | null {
  const hit = least(hits, (h) => h.px);
  return hit && hit.px <= slack ? hit.thing : null;
}

const gap = (eye: Eye, p: Point, height: number): number => {
  const at = eye.to_screen(p, height);
  return at ? distance(at, eye.px) : Infinity;
};

/** Pixels from the pointer to the line from `a` to `b`. */
function line_gap(eye: Eye, a: Point, b: Point, height: number): number {
  const [p, q] = [eye.to_screen(a, height), eye.to_screen(b, height)];
  return p && q ? to_segment(eye.px, p, q) : Infinity;
}

/** The sweep by which scanner `k` is drawn: the filtered one where it is shown. */
export function drawn_sweep(scene: SceneState, hidden: ReadonlySet<string>, k: number): PlacedSweep | null {
  const raw = scene.sweeps.at(k) ?? null;
  const filtered = hidden.has(kOwn.filtered.name) ? null : filtered_of(scene, k);
  return filtered ?? (hidden.has(kOwn.scan.name) ? null : raw);
}

/** The filtered scan of scanner `k`: only the front scanner has one. */
export function filtered_of(scene: SceneState, k: number): PlacedSweep | null {
  const filtered = scene.filtered.shown;
  const mount = scene.sweeps.at(k)?.sweep.mount;
  const same = filtered && mount && mount.x === filtered.sweep.mount.x && mount.y === filtered.sweep.mount.y &&
    mount.heading === filtered.sweep.mount.heading;
  return same ? filtered : null;
}

function beam_hits(scene: SceneState, shown: Shown, eye: Eye): Hit[] {
  const out: Hit[] = [];
  scene.sweeps.forEach((_, scanner) => {
    const sweep = drawn_sweep(scene, shown.hidden, scanner);
    const end = sweep ? sweep_points(sweep).end : new Float32Array(0);
    for (let i = 0; i < end.length; i += 2) {
      if (Number.isNaN(end[i])) continue;
      out.push({ thing: { kind: "beam", scanner, beam: i / 2 }, px: gap(eye, { x: end[i], y: end[i + 1] }, kScanHeight) });
    }
  });
  if (shown.hidden.has(kOwn.ranging.name)) return out;
  for (const [key, r] of scene.readings) {
    const tip = { x: r.origin.x + r.range * Math.cos(r.origin.heading), y: r.origin.y + r.range * Math.sin(r.origin.heading) };
    if (r.hit) out.push({ thing: { kind: "echo", key }, px: gap(eye, tip, kScanHeight) });
  }
  return out;
}

const kBias = 2; // [px] by which a point goes before an arrow that begins in it

/** Points, nodes and arrows. A nearest return is a beam where there is a scan. */
function mark_hits(scene: SceneState, layers: LayerView[], shown: Shown, eye: Eye): Hit[] {
  const robot = scene.frame?.pose;
  if (!robot) return [];
  return layers.flatMap((layer) => {
    const hit = (index: number, px: number): Hit => ({ thing: { kind: "mark", layer: layer.name, index }, px });
    if (layer.kind === "points" || layer.kind === "polyline") {
      if (is_sensed(layer.name) && scene.sweeps.length > 0) return [];
      return places(layer, robot).map((p, i) => hit(i, gap(eye, p, p.z ?? layer_height(layer))))
        .filter((_, i) => i > 0 || layer.kind === "points"); // a line begins in the robot or at another's end
    }
    if (layer.kind !== "arrows") return [];
    const times = is_scaled(layer) ? shown.force_scale : 1;
    return arrows(layer, robot).map(({ at, by }, i) =>
      hit(i, kBias + line_gap(eye, at, { x: at.x + times * by.x, y: at.y + times * by.y }, at.z ?? layer_height(layer))));
  });
}

/** The height at which 3D draws a layer that has no heights of its own. */
function layer_height(layer: LayerView): number {
  if (layer.kind === "polyline") return is_sketched(layer) ? kGround : kStripHeight;
  return layer.kind === "points" && layer.style !== "dashed" ? kStripHeight : kScanHeight;
}

/** Lines between nodes, and candidate motions. */
function line_hits(scene: SceneState, layers: LayerView[], eye: Eye): Hit[] {
  const robot = scene.frame?.pose;
  if (!robot) return [];
  const out: Hit[] = [];
  for (const layer of layers) {
    const thing = (index: number): Thing => ({ kind: "mark", layer: layer.name, index });
    if (layer.kind === "arcs") {
      arcs(layer, robot).forEach((line, k) => {
        for (let i = 1; i < line.length; ++i) out.push({ thing: thing(k), px: line_gap(eye, line[i - 1], line[i], kGround) });
      });
    }
    if (layer.kind !== "polyline") continue;
    const all = places(layer, robot);
    for (const line of lines(layer, robot)) {
      const first = all.findIndex((p) => p.x === line[0].x && p.y === line[0].y);
      for (let i = 1; i < line.length; ++i) {
        const px = line_gap(eye, line[i - 1], line[i], layer_height(layer));
        const near = gap(eye, line[i - 1], layer_height(layer)) < gap(eye, line[i], layer_height(layer)) ? i - 1 : i;
        out.push({ thing: thing(first + near), px });
      }
    }
  }
  return out;
}

const kMostPath = 2000;

function path_hits(scene: SceneState, shown: Shown, eye: Eye): Hit[] {
  if (shown.hidden.has(kOwn.path.name) || !eye.at) return [];
  const { columns } = scene;
  const rows = Math.min(scene.rows, columns.length);
  const [x, y, t] = ["x", "y", "t"].map((name) => columns.get(name));
  const step = Math.max(1, Math.floor(rows / kMostPath));
  const out: Hit[] = [];
  for (let i = 0; i < rows; i += step) out.push({ thing: { kind: "path", t: t[i] }, px: gap(eye, { x: x[i], y: y[i] }, kGround) });
  return out;
}

const kGoalRadius = 0.22; // [m]
const kGoalPixels = 12;

function goal_at(scene: SceneState, eye: Eye): Thing | null {
  const all = scene.goal ? [scene.goal, ...scene.goals_ahead] : [];
  const index = all.findIndex((g) =>
    gap(eye, g, 0) <= kGoalPixels || (eye.at !== null && distance(g, eye.at) <= kGoalRadius));
  return index < 0 ? null : { kind: "goal", index };
}

function circle_at(scene: SceneState, layers: LayerView[], eye: Eye): Thing | null {
  const { at } = eye;
  const robot = scene.frame?.pose;
  if (!at || !robot) return null;
  for (const layer of layers) {
    if (layer.kind !== "circles") continue;
    const index = circles(layer, robot).findIndex((c) => distance(c.at, at) <= c.radius);
    if (index >= 0) return { kind: "mark", layer: layer.name, index };
  }
  return null;
}

/** A sector or a cell. */
function ground_at(scene: SceneState, layers: LayerView[], at: Point): Thing | null {
  const robot = scene.frame?.pose;
  if (!robot) return null;
  for (const layer of layers.filter((l) => l.kind === "polar")) {
    const r = distance(at, robot) - scene.radius - kRing;
    const bearing = Math.atan2(at.y - robot.y, at.x - robot.x);
    const hit = sectors(layer, robot).find((s) => r >= 0 && r <= s.height * kTallest && turns_between(s.from, bearing) < s.to - s.from);
    if (hit) return { kind: "sector", layer: layer.name, index: hit.index };
  }
  const grid = layers.find((l) => l.kind === "grid" && (cell_at(l, robot, at)?.drawn ?? false));
  return grid ? { kind: "cell", layer: grid.name, at } : null;
}

/** [rad] 0 .. 2 pi from `from` counter-clockwise to `to`. */
function turns_between(from: number, to: number): number {
  const turn = wrap_angle(to - from);
  return turn < 0 ? turn + 2 * Math.PI : turn;
}

/** The cell of a grid that holds `at`; `drawn` if it is dark enough to be seen. */
export function cell_at(layer: LayerView, robot: Pose, at: Point):
  { byte: number; column: number; row: number; cell: number; middle: Point; drawn: boolean; known: boolean } | null {
  const place = grid_place(layer, robot);
  if (!place) return null;
  const { corner, cell, columns } = place;
  const p = to_child(corner, at);
  const [column, row] = [Math.floor(p.x / cell), Math.floor(p.y / cell)];
  const byte = column >= 0 && column < columns && row >= 0 ? layer.cells.at(row * columns + column) : undefined;
  if (byte === undefined) return null;
  const [c, s] = [Math.cos(corner.heading), Math.sin(corner.heading)];
  const [mx, my] = [(column + 0.5) * cell, (row + 0.5) * cell];
  const middle = { x: corner.x + c * mx - s * my, y: corner.y + s * mx + c * my };
  return { byte, column, row, cell, middle, drawn: grade_of(byte) >= 0, known: byte !== kUnknownCell };
}

interface Box { left: number; top: number; right: number; bottom: number }

const kApart = 14; // [px] from a thing to its card

/**
 * The upper left corner of a card of `size` beside `thing`, inside `room`; all in pixels of the scene.
 * Of right, left, above and below, the first that covers least of the thing.
 */
export function card_place(thing: Box, size: { w: number; h: number }, room: Box): Point {
  const fits = (v: number, least: number, most: number) => Math.max(least, Math.min(most, v));
  const middle = { x: (thing.left + thing.right - size.w) / 2, y: (thing.top + thing.bottom - size.h) / 2 };
  const corners = [
    { x: thing.right + kApart, y: middle.y }, { x: thing.left - kApart - size.w, y: middle.y },
    { x: middle.x, y: thing.top - kApart - size.h }, { x: middle.x, y: thing.bottom + kApart },
  ].map((p) => ({ x: fits(p.x, room.left, room.right - size.w), y: fits(p.y, room.top, room.bottom - size.h) }));
  const covered = (p: Point) =>
    Math.max(0, Math.min(p.x + size.w, thing.right) - Math.max(p.x, thing.left)) *
    Math.max(0, Math.min(p.y + size.h, thing.bottom) - Math.max(p.y, thing.top));
  return corners.reduce((best, p) => (covered(p) < covered(best) ? p : best));
}
