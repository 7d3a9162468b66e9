// web/src/draw/strip.ts: the elastic strip, its forces, and the travelled path.
import { Point } from "../geometry";
import { Frame } from "../link/frame";
import { Columns } from "../state/columns";
import { Palette } from "./palette";
import { View } from "./view";

type Context = CanvasRenderingContext2D;
const kMostPathPoints = 3000;

/** Rows [from, to) of the path. Long paths are drawn with fewer corners. */
export function draw_path(g: Context, view: View, columns: Columns, from: number, to: number,
  colour: string, width: number, alpha = 1): void {
  if (to - from < 2) return;
  const xs = columns.get("x");
  const ys = columns.get("y");
  const step = Math.max(1, Math.floor((to - from) / kMostPathPoints));
  g.strokeStyle = colour;
  g.lineWidth = width;
  g.lineJoin = "round";
  g.lineCap = "round";
  g.globalAlpha = alpha;
  g.beginPath();
  g.moveTo(view.sx(xs[from]), view.sy(ys[from]));
  for (let i = from + step; i < to; i += step) g.lineTo(view.sx(xs[i]), view.sy(ys[i]));
  g.lineTo(view.sx(xs[to - 1]), view.sy(ys[to - 1]));
  g.stroke();
  g.globalAlpha = 1;
}

/**
 * The strip: solid through its nodes. Where it ends short of the goal a dashed line goes on as a
 * string would that leaves in the direction of the pass point: not computed, only drawn, so that
 * one sees from afar how far the strip is bent off the line.
 */
export function draw_strip(g: Context, view: View, palette: Palette, f: Frame): void {
  const points = f.strip.map((n) => view.to_screen(n.position));
  if (points.length < 2) return;
  const last = points[points.length - 1];
  const [start, pass] = points;
  if (f.goal) {
    const goal = view.to_screen(f.goal);
    const from = points.length === 3 ? pass : last;
    const ahead = Math.hypot(pass.x - start.x, pass.y - start.y) || 1;
    const reach = 0.4 * Math.hypot(goal.x - from.x, goal.y - from.y);
    g.strokeStyle = palette.accent;
    g.globalAlpha = 0.75;
    g.lineWidth = 2.2;
    g.setLineDash([7, 6]);
    g.beginPath();
    g.moveTo(from.x, from.y);
    if (points.length === 3) {
      g.quadraticCurveTo(from.x + (reach * (pass.x - start.x)) / ahead,
        from.y + (reach * (pass.y - start.y)) / ahead, goal.x, goal.y);
    } else {
      g.lineTo(goal.x, goal.y);
    }
    g.stroke();
    g.setLineDash([]);
    g.globalAlpha = 1;
  }
  g.strokeStyle = palette.accent;
  g.lineWidth = 3;
  g.lineJoin = "round";
  g.lineCap = "round";
  g.beginPath();
  g.moveTo(points[0].x, points[0].y);
  if (points.length === 3) g.lineTo(pass.x, pass.y); // the end is where it was before the forces
  for (let i = 1; i < points.length - 1 && points.length > 3; ++i) {
    // Smooth through the middles: a strip bends, it has no corners.
    const mx = (points[i].x + points[i + 1].x) / 2;
    const my = (points[i].y + points[i + 1].y) / 2;
    g.quadraticCurveTo(points[i].x, points[i].y, mx, my);
  }
  if (points.length !== 3) g.lineTo(last.x, last.y);
  g.stroke();
  g.fillStyle = palette.accent;
  g.strokeStyle = palette.bg;
  g.lineWidth = points.length > 3 ? 0.75 : 1.5;
  for (const p of points.slice(1, -1)) {
    g.beginPath();
    g.arc(p.x, p.y, points.length > 3 ? 2.5 : 4.5, 0, 2 * Math.PI);
    g.fill();
    g.stroke();
  }
}

/** One arrow to be drawn: where it begins and the force it is. */
export interface ForceArrow { at: Point; force: Point; colour: "external" | "internal" | "elastic" }

/**
 * The forces of a frame as arrows. The elastic force is what moved the pass point, so its arrow
 * ends there. A strip of three nodes (start, pass, end) is pushed at its end: the forces of both
 * sides begin there and the elastic force is their sum. In a longer one every node has its own.
 */
export function force_arrows(f: Frame): ForceArrow[] {
  const arrows: ForceArrow[] = [];
  const base = f.pass && { x: f.pass.x - f.elastic.x, y: f.pass.y - f.elastic.y };
  const inner = f.strip.slice(1, -1);
  if (inner.length === 1 && base) {
    arrows.push({ at: base, force: f.external_left, colour: "external" },
      { at: base, force: f.external_right, colour: "external" },
      { at: base, force: inner[0].internal, colour: "internal" });
  } else {
    for (const n of inner) {
      arrows.push({ at: n.position, force: n.external, colour: "external" },
        { at: n.position, force: n.internal, colour: "internal" });
    }
  }
  if (base) arrows.push({ at: base, force: f.elastic, colour: "elastic" });
  return arrows;
}

/** Forces are displacements in metres, so they are drawn as lengths, `times` enlarged. */
export function draw_forces(g: Context, view: View, palette: Palette, f: Frame,
  times: number): void {
  for (const a of force_arrows(f)) arrow(g, view, a.at, a.force, times, palette[a.colour]);
}

/** An arrow of `v` metres from `at`; too short ones are left out, very long ones are cut at 2 m. */
export function arrow(g: Context, view: View, at: Point, v: Point, times: number, colour: string,
  width = 3): void {
  const metres = Math.hypot(v.x, v.y) * times;
  const length = Math.min(2, metres) * view.scale;
  if (!(length >= 5)) return;
  const head = Math.min(11, length * 0.6);
  const angle = Math.atan2(-v.y, v.x);
  g.save();
  g.translate(view.sx(at.x), view.sy(at.y));
  g.rotate(angle);
  g.strokeStyle = colour;
  g.fillStyle = colour;
  g.lineWidth = Math.min(width, length / 3);
  g.lineCap = "round";
  g.beginPath();
  g.moveTo(0, 0);
  g.lineTo(Math.max(0, length - head + 2), 0);
  g.stroke();
  g.beginPath();
  g.moveTo(length, 0);
  g.lineTo(length - head, -head * 0.46);
  g.lineTo(length - head, head * 0.46);
  g.fill();
  g.restore();
}
