// web/src/three/layers.ts: the layers of a controller in 3D: a drawing for each kind. A layer
// without heights lies at the height of its kind.
import * as THREE from "three";
import { Palette } from "../draw/palette";
import { Pose } from "../geometry";
import {
  LayerKind, LayerView, Place, arcs, arrows, cells_by_grade, circles, grid_place, kAlpha, kGrades, kGround, kRing, kScanHeight,
  kStripHeight, kTallest, lines, places, sectors, texts,
} from "../layer";
import { is_scaled, is_sketched, token_of } from "../state/layers";
import { dot, flat, placed, push_arrow, ribbon, tube, vertices } from "./shapes";

/** Where and how a layer is drawn. */
export interface Stage {
  group: THREE.Group;
  palette: Palette;
  robot: Pose;
  radius: number; // [m] of the robot's hull
  times: number;  // by which forces are drawn enlarged
}
type Build = (stage: Stage, layer: LayerView, colour: string) => void;

const kRound = 0.008;             // [m] of a line with heights, to its sides
const kDash = 0.12;               // [m] of a dash, and of the gap after it

/** Gives every material of `object` the opacity `alpha`. */
function faded<T extends THREE.Object3D>(object: T, alpha: number): T {
  object.traverse((o) => {
    const material = (o as THREE.Mesh).material as THREE.Material | undefined;
    if (material && alpha < 1) Object.assign(material, { transparent: true, opacity: alpha });
  });
  return object;
}

/** Every second piece of length `kDash` along `line`, across its corners. */
export function dashes(line: Place[]): Place[][] {
  const out: Place[][] = [];
  let way = 0; // [m] along the line up to the present corner
  for (let i = 1; i < line.length; ++i) {
    const [a, b] = [line[i - 1], line[i]];
    const length = Math.hypot(b.x - a.x, b.y - a.y);
    const at = (s: number): Place => ({ x: a.x + ((b.x - a.x) * s) / length, y: a.y + ((b.y - a.y) * s) / length, z: a.z });
    for (let s = 0; s < length;) {
      const piece = Math.floor((way + s) / kDash + 1e-6);
      const next = Math.min(length, (piece + 1) * kDash - way);
      if (piece % 2 === 0) out.push([at(s), at(next)]);
      s = next;
    }
    way += length;
  }
  return out;
}

function band(stage: Stage, layer: LayerView, line: Place[], width: number, height: number, colour: string): void {
  const pieces = layer.style === "dashed" ? dashes(line) : [line];
  for (const piece of pieces) {
    stage.group.add(faded(ribbon(piece, width, piece[0].z ?? height, colour), kAlpha[layer.style]));
  }
}

function build_points(stage: Stage, layer: LayerView, colour: string): void {
  const tied = layer.style === "dashed";
  const height = tied ? kScanHeight : kStripHeight;
  for (const p of places(layer, stage.robot)) {
    stage.group.add(faded(dot(p, 0.05, p.z ?? height, colour), kAlpha[layer.style]));
    if (tied) band(stage, layer, [{ ...stage.robot, z: p.z }, p], 0.012, height, colour);
  }
}

function build_polyline(stage: Stage, layer: LayerView, colour: string): void {
  const planned = is_sketched(layer);
  for (const line of lines(layer, stage.robot)) {
    if (layer.axes > 2) stage.group.add(tube(line.map((p) => [p.x, p.y, p.z ?? 0] as const), kRound, colour));
    else band(stage, layer, line, layer.style === "solid" ? 0.06 : 0.02, planned ? kGround : kStripHeight, colour);
  }
}

function build_arrows(stage: Stage, layer: LayerView, colour: string): void {
  const force = is_scaled(layer);
  for (const { at, by } of arrows(layer, stage.robot)) {
    push_arrow(stage.group, at, by, force ? stage.times : 1, colour, at.z ?? (force ? kStripHeight + 0.02 : kScanHeight));
  }
}

function build_circles(stage: Stage, layer: LayerView, colour: string): void {
  for (const { at, radius } of circles(layer, stage.robot)) {
    const torus = placed(new THREE.TorusGeometry(radius, 0.02, 8, 48), flat(colour), at, at.z ?? kScanHeight);
    stage.group.add(faded(torus, kAlpha[layer.style]));
  }
}

/** Candidates are one object together, as there are hundreds. */
function build_arcs(stage: Stage, layer: LayerView, colour: string): void {
  const among_many = layer.style === "faint" || layer.tone === "muted";
  const found = arcs(layer, stage.robot);
  if (!among_many) {
    for (const line of found) band(stage, layer, line, 0.04, kStripHeight, colour);
    return;
  }
  const xyz: number[] = [];
  for (const line of found) {
    for (let i = 1; i < line.length; ++i) {
      xyz.push(line[i - 1].x, line[i - 1].y, kGround, line[i].x, line[i].y, kGround);
    }
  }
  const material = new THREE.LineBasicMaterial({ color: colour, transparent: true, opacity: kAlpha.faint });
  const object = new THREE.LineSegments(vertices(xyz), material);
  object.frustumCulled = false;
  stage.group.add(object);
}

/** Tiles on the floor; one object for each shade. */
function build_grid(stage: Stage, layer: LayerView, colour: string): void {
  const place = grid_place(layer, stage.robot);
  if (!place) return;
  const { corner, cell, columns } = place;
  const c = Math.cos(corner.heading) * cell;
  const s = Math.sin(corner.heading) * cell;
  const tile = (at: number): number[] => {
    const [i, j] = [at % columns, Math.floor(at / columns)];
    const corner_at = (di: number, dj: number) =>
      [corner.x + c * (i + di) - s * (j + dj), corner.y + s * (i + di) + c * (j + dj), kGround];
    const [a, b, d, e] = [corner_at(0, 0), corner_at(1, 0), corner_at(1, 1), corner_at(0, 1)];
    return [...a, ...b, ...d, ...a, ...d, ...e];
  };
  cells_by_grade(layer.cells).forEach((cells, grade) =>
    fill(stage, cells.flatMap(tile), colour, (0.7 * (grade + 1)) / kGrades));
}

/** Sectors on the floor about the robot. */
function build_polar(stage: Stage, layer: LayerView, colour: string): void {
  const foot = stage.radius + kRing;
  const free: number[] = [];
  const taken: number[] = [];
  for (const sector of sectors(layer, stage.robot)) {
    const at = (bearing: number, r: number) =>
      [stage.robot.x + r * Math.cos(bearing), stage.robot.y + r * Math.sin(bearing), kGround];
    const top = foot + sector.height * kTallest;
    const [a, b, d, e] = [at(sector.from, foot), at(sector.from, top), at(sector.to, top), at(sector.to, foot)];
    (sector.free ? free : taken).push(...a, ...b, ...d, ...a, ...d, ...e);
  }
  fill(stage, free, stage.palette.muted, 0.6);
  fill(stage, taken, colour, 0.6);
}

function fill(stage: Stage, xyz: number[], colour: string, alpha: number): void {
  if (xyz.length === 0) return;
  const material = Object.assign(flat(colour), { transparent: true, opacity: alpha, depthWrite: false });
  stage.group.add(new THREE.Mesh(vertices(xyz), material));
}

/** Lines of text that face the eye. */
function build_text(stage: Stage, layer: LayerView, colour: string): void {
  for (const { at, text } of texts(layer, stage.robot)) {
    stage.group.add(label(text, at, at.z ?? kStripHeight + 0.2, colour, stage.palette.font));
  }
}

export function label(text: string, at: Place, z: number, colour: string, font: string): THREE.Sprite {
  const canvas = document.createElement("canvas");
  const height = 48; // [px]
  const g = canvas.getContext("2d")!;
  g.font = `600 ${height * 0.75}px ${font}`;
  canvas.width = Math.ceil(g.measureText(text).width) + 8;
  canvas.height = height;
  g.font = `600 ${height * 0.75}px ${font}`; // a new size forgets it
  g.textBaseline = "middle";
  g.fillStyle = colour;
  g.fillText(text, 4, height / 2);
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas), depthTest: false }));
  sprite.scale.set((0.2 * canvas.width) / height, 0.2, 1);
  sprite.position.set(at.x, at.y, z);
  return sprite;
}

const kBuild: Record<LayerKind, Build> = {
  points: build_points, polyline: build_polyline, arrows: build_arrows, circles: build_circles, arcs: build_arcs,
  grid: build_grid, polar: build_polar, text: build_text,
};

export function build_layer(stage: Stage, layer: LayerView): void {
  kBuild[layer.kind](stage, layer, stage.palette[token_of(layer)]);
}
