// web/src/draw/layers.ts: the layers of a controller from above: a drawing for each kind.
import { Point, Pose, distance } from "../geometry";
import {
  LayerKind, LayerView, arcs, arrows, cells_by_grade, circles, grid_place, kGrades, kRing, kTallest, kAlpha, lines, places,
  sectors, texts,
} from "../layer";
import { is_scaled, is_sketched, token_of } from "../state/layers";
import { Context, arrow, circle, dots, fill, stroke, trace, write } from "./marks";
import { Palette } from "./palette";
import { View } from "./view";

/** Where and how a layer is drawn. */
interface Canvas {
  g: Context;
  view: View;
  palette: Palette;
  robot: Pose;
  radius: number; // [m] of the robot's hull
  times: number;  // by which forces are drawn enlarged
}
type Draw = (c: Canvas, layer: LayerView, colour: string) => void;

const kFew = 3;      // up to so many points each is large, and a line needs no dots
const kNodeRoom = 9; // [px] between nodes that are drawn as dots

function draw_points(c: Canvas, layer: LayerView, colour: string): void {
  const { g, view, palette } = c;
  const all = places(layer, c.robot);
  const tied = layer.style === "dashed";
  if (tied) {
    g.beginPath();
    for (const p of all) trace(g, view, [c.robot, p]);
    stroke(g, colour, 1.3, [3, 4]);
  }
  const large = all.length <= kFew;
  const radius = tied ? 5 : large ? 4.5 : 2.5;
  for (const p of all) {
    circle(g, view, p, radius);
    fill(g, colour);
    stroke(g, palette.bg, tied ? 2 : large ? 1.5 : 0.75);
  }
}

/** A solid line has its nodes as dots. A dashed line is predicted, a dotted one planned. */
function draw_polyline(c: Canvas, layer: LayerView, colour: string): void {
  const { g, view } = c;
  const sketched = is_sketched(layer);
  const all = lines(layer, c.robot);
  g.lineJoin = "round";
  g.lineCap = "round";
  g.beginPath();
  for (const line of all) trace(g, view, line);
  const width = layer.style === "solid" ? 3 : sketched ? 1.8 : 2.3;
  stroke(g, colour, width, layer.style === "dashed" ? (sketched ? [2, 6] : [7, 6]) : []);
  if (layer.style === "solid") for (const line of all) draw_nodes(g, view, line, colour);
}

/** Dots on the nodes of a line that has room for them. */
function draw_nodes(g: Context, view: View, line: Point[], colour: string): void {
  let way = 0; // [m]
  for (let i = 1; i < line.length; ++i) way += distance(line[i - 1], line[i]);
  if (line.length <= kFew || (way * view.scale) / (line.length - 1) < kNodeRoom) return;
  dots(g, view, Float32Array.from(line.flatMap((p) => [p.x, p.y])), colour, 3.2);
}

function draw_arrows(c: Canvas, layer: LayerView, colour: string): void {
  const force = is_scaled(layer);
  const dash = layer.style === "dashed" ? [4, 3] : [];
  for (const { at, by } of arrows(layer, c.robot)) arrow(c.g, c.view, at, by, force ? c.times : 1, colour, force ? 3 : 2, dash);
}

function draw_circles(c: Canvas, layer: LayerView, colour: string): void {
  const { g, view } = c;
  for (const { at, radius } of circles(layer, c.robot)) {
    circle(g, view, at, radius * view.scale);
    stroke(g, colour, 2, layer.style === "dashed" ? [5, 6] : []);
  }
}

/** Muted arcs are the many candidates beside the chosen one. */
function draw_arcs(c: Canvas, layer: LayerView, colour: string): void {
  const { g, view } = c;
  const among_many = layer.style === "faint" || layer.tone === "muted";
  if (layer.tone === "muted") g.globalAlpha *= 0.4;
  g.beginPath();
  for (const line of arcs(layer, c.robot)) trace(g, view, line);
  stroke(g, colour, among_many ? 1 : 3, layer.style === "dashed" ? [5, 4] : []);
}

/**
 * Cells that are more likely occupied than free; the likelier, the darker. One outline for each
 * shade, as there are thousands of cells.
 */
function draw_grid(c: Canvas, layer: LayerView, colour: string): void {
  const place = grid_place(layer, c.robot);
  if (!place) return;
  const { g, view } = c;
  const { corner, columns } = place;
  const edge = place.cell * view.scale;
  const alpha = g.globalAlpha;
  g.save();
  g.translate(view.sx(corner.x), view.sy(corner.y));
  g.rotate(-corner.heading);
  g.fillStyle = colour;
  cells_by_grade(layer.cells).forEach((cells, grade) => {
    g.globalAlpha = (alpha * 0.5 * (grade + 1)) / kGrades;
    g.beginPath();
    // The screen's y axis points down.
    for (const at of cells) g.rect((at % columns) * edge, -(Math.floor(at / columns) + 1) * edge, edge, edge);
    g.fill();
  });
  g.restore();
}

/** Sectors about the robot; those at or above the level in the layer's colour. */
function draw_polar(c: Canvas, layer: LayerView, colour: string): void {
  const { g, view } = c;
  const x = view.sx(c.robot.x);
  const y = view.sy(c.robot.y);
  const foot = (c.radius + kRing) * view.scale;
  g.globalAlpha *= 0.6;
  for (const { from, to, height, free } of sectors(layer, c.robot)) {
    g.beginPath();
    g.arc(x, y, foot + height * kTallest * view.scale, -from, -to, true);
    g.arc(x, y, foot, -to, -from);
    g.closePath();
    fill(g, free ? c.palette.muted : colour);
  }
}

function draw_text(c: Canvas, layer: LayerView, colour: string): void {
  const { g, view } = c;
  const font = `600 12px ${c.palette.font}`;
  for (const { at, text } of texts(layer, c.robot)) write(g, text, view.sx(at.x), view.sy(at.y), colour, font);
}

const kDraw: Record<LayerKind, Draw> = {
  points: draw_points, polyline: draw_polyline, arrows: draw_arrows, circles: draw_circles, arcs: draw_arcs,
  grid: draw_grid, polar: draw_polar, text: draw_text,
};

/** Draws `layer` and leaves the context as it was. */
export function draw_layer(c: Canvas, layer: LayerView): void {
  c.g.save();
  c.g.globalAlpha = kAlpha[layer.style];
  kDraw[layer.kind](c, layer, c.palette[token_of(layer)]);
  c.g.restore();
}

/** Kinds below the robot. A strip of one step ends inside the hull, so a strip lies above it. */
const kBelow: LayerKind[] = ["grid", "polar", "circles"];
const kBelowDashed: LayerKind[] = ["polyline", "points"];
const kOrder: LayerKind[] = [...kBelow, "arcs", "polyline", "points", "arrows", "text"];

/** The layers below and above the robot, each from the lowest to the uppermost. */
export function stacked(layers: LayerView[]): { below: LayerView[]; above: LayerView[] } {
  const sorted = [...layers].sort((a, b) => kOrder.indexOf(a.kind) - kOrder.indexOf(b.kind));
  const under = (l: LayerView) => kBelow.includes(l.kind) || (l.style === "dashed" && kBelowDashed.includes(l.kind));
  return { below: sorted.filter(under), above: sorted.filter((l) => !under(l)) };
}
