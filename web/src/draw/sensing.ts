// web/src/draw/sensing.ts: what the scanner saw: field of view, raw and filtered returns, nearest
// left and right.
import { Point } from "../geometry";
import { Frame } from "../link/frame";
import { PlacedSweep, sweep_points } from "../state/scene";
import { Palette } from "./palette";
import { View } from "./view";

type Context = CanvasRenderingContext2D;

/** The area the filtered scan says is free, as a soft fan; a beam without a reading is a gap. */
export function draw_fan(g: Context, view: View, palette: Palette, placed: PlacedSweep): void {
  const { end } = sweep_points(placed);
  const ox = view.sx(placed.origin.x);
  const oy = view.sy(placed.origin.y);
  g.fillStyle = palette.filtered;
  g.globalAlpha = 0.075;
  g.beginPath();
  g.moveTo(ox, oy);
  for (let i = 0; i < end.length; i += 2) {
    if (Number.isNaN(end[i])) g.lineTo(ox, oy);
    else g.lineTo(view.sx(end[i]), view.sy(end[i + 1]));
  }
  g.closePath();
  g.fill();
  g.globalAlpha = 1;
}

/** Returns of a sweep too `old` to drive by are grey and small. */
export function draw_returns(g: Context, view: View, palette: Palette, placed: PlacedSweep,
  old = false): void {
  const { raw, filtered } = sweep_points(placed);
  if (!old) dots(g, view, raw, palette.scan, 2.2);
  dots(g, view, filtered, old ? palette.scan : palette.filtered, 1.4);
}

function dots(g: Context, view: View, xy: Float32Array, colour: string, radius: number): void {
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

/** The nearest return of each side: a dotted line and a ringed point. */
export function draw_nearest(g: Context, view: View, palette: Palette, f: Frame): void {
  for (const nearest of [f.left, f.right]) {
    if (!nearest) continue;
    const a = view.to_screen(f.pose as Point);
    const b = view.to_screen(nearest.point);
    g.strokeStyle = palette.external;
    g.setLineDash([3, 4]);
    g.lineWidth = 1.3;
    g.beginPath();
    g.moveTo(a.x, a.y);
    g.lineTo(b.x, b.y);
    g.stroke();
    g.setLineDash([]);
    g.fillStyle = palette.external;
    g.beginPath();
    g.arc(b.x, b.y, 5, 0, 2 * Math.PI);
    g.fill();
    g.strokeStyle = palette.bg;
    g.lineWidth = 2;
    g.stroke();
  }
}
