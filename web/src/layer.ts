// web/src/layer.ts: the layers of a controller: values of a kind, and these values as shapes in W.
import { Pose, to_parent, wrap_angle } from "./geometry";

export const kLayerKinds =
  ["points", "polyline", "arrows", "circles", "arcs", "grid", "polar", "text"] as const;
export type LayerKind = (typeof kLayerKinds)[number];
/** The meaning of a colour. */
export const kTones = ["accent", "internal", "external", "elastic", "plan", "moving", "muted", "refused", "good"] as const;
export type Tone = (typeof kTones)[number];
export const kLayerStyles = ["solid", "dashed", "faint"] as const;
export type LayerStyle = (typeof kLayerStyles)[number];

/** One layer; telemetry.fbs says what its `values` are, by kind. */
export interface LayerView {
  name: string;    // key of its switch
  label: string;   // for people
  unit: string;    // of the values other than positions
  kind: LayerKind;
  robot: boolean;  // values are in R, else in W
  tone: Tone;
  style: LayerStyle;
  axes: number;    // coordinates of a position
  level: number;   // of a polar: below it a sector is free
  values: Float32Array;
  cells: Uint8Array; // of a grid: 0 free .. 254 occupied, kUnknownCell
  text: string[];    // a line a position
}

/** The byte of an unknown cell. */
export const kUnknownCell = 255;

/** A position in W; z is null where the layer gives no height. */
export interface Place { x: number; y: number; z: number | null }

/** The frame of the layer's values: the robot's pose, or the origin of W. */
function base_of(layer: LayerView, robot: Pose): Pose {
  return layer.robot ? robot : { x: 0, y: 0, heading: 0 };
}

/** Calls `each` with every position and its index; `more` other values follow a position. */
function each_place(layer: LayerView, robot: Pose, more: number, each: (p: Place, at: number) => void): void {
  const base = base_of(layer, robot);
  const c = Math.cos(base.heading);
  const s = Math.sin(base.heading);
  const { values, axes } = layer;
  for (let at = 0; at + axes + more <= values.length; at += axes + more) {
    const [x, y] = [values[at], values[at + 1]];
    each({ x: base.x + c * x - s * y, y: base.y + s * x + c * y, z: axes > 2 ? values[at + 2] : null }, at);
  }
}

/** The positions of points and of text. */
export function places(layer: LayerView, robot: Pose): Place[] {
  const out: Place[] = [];
  each_place(layer, robot, 0, (p) => out.push(p));
  return out;
}

/** The lines of a polyline: a position that is not a number begins a new one. */
export function lines(layer: LayerView, robot: Pose): Place[][] {
  const out: Place[][] = [[]];
  for (const p of places(layer, robot)) {
    if (Number.isFinite(p.x) && Number.isFinite(p.y)) out[out.length - 1].push(p);
    else out.push([]);
  }
  return out.filter((line) => line.length > 1);
}

/** Arrows: from a place, by a vector in W. */
export function arrows(layer: LayerView, robot: Pose): { at: Place; by: Place }[] {
  const out: { at: Place; by: Place }[] = [];
  const turn = { x: 0, y: 0, heading: base_of(layer, robot).heading };
  const { values, axes } = layer;
  each_place(layer, robot, axes, (at, i) => {
    const by = to_parent(turn, values[i + axes], values[i + axes + 1]);
    out.push({ at, by: { ...by, z: axes > 2 ? values[i + axes + 2] : 0 } });
  });
  return out;
}

export function circles(layer: LayerView, robot: Pose): { at: Place; radius: number }[] {
  const out: { at: Place; radius: number }[] = [];
  each_place(layer, robot, 1, (at, i) => out.push({ at, radius: layer.values[i + layer.axes] }));
  return out;
}

const kAtRobot = 0.01; // [m] from its origin

/** The texts with their places. One at the robot itself belongs to no place of the world: cards show it. */
export function texts(layer: LayerView, robot: Pose): { at: Place; text: string }[] {
  return places(layer, robot).map((at, i) => ({ at, text: layer.text[i] ?? "" }))
    .filter(({ at, text }) => text !== "" && Math.hypot(at.x - robot.x, at.y - robot.y) > kAtRobot);
}

/** Sizes that both views draw alike. */
export const kRing = 0.1;    // [m] from the hull to the foot of a polar
export const kTallest = 0.5; // [m] of a sector at twice the level and above
export const kAlpha: Record<LayerStyle, number> = { solid: 1, dashed: 1, faint: 0.4 };

export const kScanHeight = 0.3;     // [m] of the scan plane in 3D
export const kStripHeight = 0.36;   // [m] above the hull, which covers a strip of one step
export const kGround = 0.01;        // [m] of drawings on the floor

const kArcPoints = 8; // corners of an arc

/** Motions of constant curvature from the robot's pose, as lines. */
export function arcs(layer: LayerView, robot: Pose): Place[][] {
  const out: Place[][] = [];
  for (let at = 0; at + 2 <= layer.values.length; at += 2) {
    const [length, turn] = [layer.values[at], layer.values[at + 1]];
    const line: Place[] = [];
    for (let k = 0; k <= kArcPoints; ++k) {
      const half = (turn * k) / kArcPoints / 2;
      // The chord of an arc: its length sinc(turn / 2) along the middle heading.
      const chord = ((length * k) / kArcPoints) * (Math.abs(half) < 1e-6 ? 1 : Math.sin(half) / half);
      line.push({ x: robot.x + chord * Math.cos(robot.heading + half), y: robot.y + chord * Math.sin(robot.heading + half), z: null });
    }
    out.push(line);
  }
  return out;
}

/** A grid in W: outer corner of its first cell, heading of its rows, edge of a cell [m]. */
export function grid_place(layer: LayerView, robot: Pose):
  { corner: Pose; cell: number; columns: number } | null {
  const [x, y, cell, columns] = layer.values;
  if (!(cell > 0) || !(columns >= 1)) return null;
  const base = base_of(layer, robot);
  return { corner: { ...to_parent(base, x, y), heading: base.heading }, cell, columns };
}

const kEven = 127;        // the byte of a cell that is as likely free as occupied
export const kGrades = 6; // shades of occupied cells

/** 0 .. kGrades - 1: the shade of a cell that is likely occupied; -1 for the others. */
export function grade_of(cell: number): number {
  if (cell === kUnknownCell || cell <= kEven) return -1;
  return Math.floor(((cell - kEven) * kGrades) / (kUnknownCell - kEven));
}

const graded = new WeakMap<Uint8Array, number[][]>();

/** The indices of the cells of each grade. Found once for a grid, which holds for many frames. */
export function cells_by_grade(cells: Uint8Array): number[][] {
  let found = graded.get(cells);
  if (!found) {
    found = Array.from({ length: kGrades }, () => []);
    for (let at = 0; at < cells.length; ++at) {
      const grade = grade_of(cells[at]);
      if (grade >= 0) found[grade].push(at);
    }
    graded.set(cells, found);
  }
  return found;
}

/** A sector of a polar with a density above 0: bearings in W, height 0 .. 1. */
interface Sector { index: number; from: number; to: number; height: number; free: boolean }
export function sectors(layer: LayerView, robot: Pose): Sector[] {
  const { values, level } = layer;
  if (!(level > 0)) return [];
  const width = (2 * Math.PI) / values.length;
  const zero = base_of(layer, robot).heading;
  const out: Sector[] = [];
  values.forEach((density, k) => {
    if (!(density > 0)) return;
    const from = wrap_angle(zero + k * width);
    out.push({ index: k, from, to: from + width, height: Math.min(1, density / (2 * level)), free: density < level });
  });
  return out;
}
