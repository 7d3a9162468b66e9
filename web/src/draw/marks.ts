// web/src/draw/marks.ts: shapes that drawings share: lines, circles, arrows, dots, the path.
import { Point } from "../geometry";
import { Columns } from "../state/columns";
import { View } from "./view";

export type Context = CanvasRenderingContext2D;
const kMostPathPoints = 3000;

/** Rows [from, to) of the path, by odometry or `truly`. Long paths are drawn with fewer corners. */
export function draw_path(g: Context, view: View, columns: Columns, from: number, to: number,
  colour: string, width: number, alpha = 1, dash: number[] = [], truly = false): void {
  if (to - from < 2 || (truly && !columns.has("truth.x"))) return;
  g.save();
  g.lineJoin = "round";
  g.lineCap = "round";
  g.globalAlpha = alpha;
  g.beginPath();
  columns.each_place(from, to, kMostPathPoints, (x, y) => {
    if (Number.isFinite(x)) g.lineTo(view.sx(x), view.sy(y));
  }, truly);
  stroke(g, colour, width, dash);
  g.restore();
}

/** An arrow by `v` [m] from `at`, `times` enlarged; left out below 5 px. */
export function arrow(g: Context, view: View, at: Point, v: Point, times: number, colour: string,
  width = 3, dash: number[] = []): void {
  const metres = Math.hypot(v.x, v.y) * times;
  const length = metres * view.scale;
  if (!(length >= 5)) return;
  const head = Math.min(11, length * 0.6);
  const angle = Math.atan2(-v.y, v.x);
  g.save();
  g.translate(view.sx(at.x), view.sy(at.y));
  g.rotate(angle);
  g.lineCap = dash.length > 0 ? "butt" : "round";
  g.beginPath();
  g.moveTo(0, 0);
  g.lineTo(Math.max(0, length - head + 2), 0);
  stroke(g, colour, Math.min(width, length / 3), dash);
  g.beginPath();
  g.moveTo(length, 0);
  g.lineTo(length - head, -head * 0.46);
  g.lineTo(length - head, head * 0.46);
  fill(g, colour);
  g.restore();
}

/** Strokes the outline with a line `width` [px] wide. */
export function stroke(g: Context, colour: string, width: number, dash: number[] = []): void {
  g.strokeStyle = colour;
  g.lineWidth = width;
  g.setLineDash(dash);
  g.stroke();
  g.setLineDash([]);
}

export function fill(g: Context, colour: string): void {
  g.fillStyle = colour;
  g.fill();
}

/** Writes `text` at x, y [px]. */
export function write(g: Context, text: string, x: number, y: number, colour: string, font: string,
  align: CanvasTextAlign = "center", baseline: CanvasTextBaseline = "middle"): void {
  g.fillStyle = colour;
  g.font = font;
  g.textAlign = align;
  g.textBaseline = baseline;
  g.fillText(text, x, y);
}

/** Writes `text` over anything: with a rim of the colour `under`, `rim` [px] wide. Lines join round from then on. */
export function write_over(g: Context, text: string, x: number, y: number, colour: string, font: string, under: string,
  rim: number, align: CanvasTextAlign = "center"): void {
  g.lineJoin = "round";
  g.lineWidth = rim;
  g.strokeStyle = under;
  [g.font, g.textAlign, g.textBaseline] = [font, align, "middle"];
  g.strokeText(text, x, y);
  write(g, text, x, y, colour, font, align);
}

/** Begins a new outline: a circle of `radius` [px] about `at` in W. */
export function circle(g: Context, view: View, at: Point, radius: number): void {
  g.beginPath();
  g.arc(view.sx(at.x), view.sy(at.y), radius, 0, 2 * Math.PI);
}

/** Adds a line through `points` to the outline. */
export function trace(g: Context, view: View, points: Point[]): void {
  points.forEach((p, i) => {
    if (i === 0) g.moveTo(view.sx(p.x), view.sy(p.y));
    else g.lineTo(view.sx(p.x), view.sy(p.y));
  });
}

/** A line through `points`, `width` [px] wide. */
export function polyline(g: Context, view: View, points: Point[], colour: string, width: number, dash: number[] = []): void {
  g.beginPath();
  trace(g, view, points);
  stroke(g, colour, width, dash);
}

/** Discs of `radius` [px]; `xy` holds x, y in turn. Discs outside the window are left out. */
export function dots(g: Context, view: View, xy: Float32Array, colour: string, radius: number): void {
  g.fillStyle = colour;
  g.beginPath();
  for (let i = 0; i < xy.length; i += 2) {
    const x = view.sx(xy[i]);
    const y = view.sy(xy[i + 1]);
    if (x < -4 || y < -4 || x > view.width + 4 || y > view.height + 4) continue;
    g.moveTo(x + radius, y);
    g.arc(x, y, radius, 0, 2 * Math.PI);
  }
  g.fill();
}
