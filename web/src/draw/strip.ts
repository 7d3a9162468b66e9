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

/** The strip from the robot to the goal. It ends where its last node is; a thin dashed line goes
 * on to the goal, which the robot has in mind but has not planned to yet. */
export function draw_strip(g: Context, view: View, palette: Palette, f: Frame): void {
  const points = f.strip.map((n) => view.to_screen(n.position));
  if (points.length < 2) return;
  const last = points[points.length - 1];
  if (f.goal) {
    const goal = view.to_screen(f.goal);
    g.strokeStyle = palette.accent;
    g.globalAlpha = 0.5;
    g.lineWidth = 1.5;
    g.setLineDash([2, 6]);
    g.beginPath();
    g.moveTo(last.x, last.y);
    g.lineTo(goal.x, goal.y);
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
  for (let i = 1; i < points.length - 1; ++i) {
    // Smooth through the middles: a strip bends, it has no corners.
    const mx = (points[i].x + points[i + 1].x) / 2;
    const my = (points[i].y + points[i + 1].y) / 2;
    g.quadraticCurveTo(points[i].x, points[i].y, mx, my);
  }
  g.lineTo(last.x, last.y);
  g.stroke();
  g.fillStyle = palette.accent;
  for (const p of points.slice(1, -1)) {
    g.beginPath();
    g.arc(p.x, p.y, 4, 0, 2 * Math.PI);
    g.fill();
  }
}

/** Forces are displacements in metres, so they are drawn as lengths, `times` enlarged. */
export function draw_forces(g: Context, view: View, palette: Palette, f: Frame,
  times: number): void {
  const nodes = f.strip.slice(1, -1).length > 0 ? f.strip.slice(1, -1) : f.strip.slice(1);
  const shown = nodes.length > 24 ? nodes.filter((_, i) => i % 2 === 0) : nodes;
  for (const n of shown) {
    arrow(g, view, n.position, n.external, times, palette.external);
    arrow(g, view, n.position, n.internal, times, palette.internal);
  }
  if (!f.pass) return;
  const magnitude = Math.hypot(f.elastic.x, f.elastic.y);
  if (magnitude > 0) arrow(g, view, f.pass, f.elastic, times, palette.elastic);
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
