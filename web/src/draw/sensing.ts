// web/src/draw/sensing.ts: what the scanners saw, and what the controller saw of it.
import { PlacedSweep, sweep_points } from "../state/sweeps";
import { Context, dots } from "./marks";
import { Palette } from "./palette";
import { View } from "./view";

/** The area that the filtered scan says is free, as a soft fan; a beam without a reading is a gap. */
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

export function draw_raw(g: Context, view: View, palette: Palette, placed: PlacedSweep): void {
  dots(g, view, sweep_points(placed).hits, palette.scan, 2.2);
}

/** Grey while too `old` to drive by. */
export function draw_filtered(g: Context, view: View, palette: Palette, placed: PlacedSweep, old: boolean): void {
  dots(g, view, sweep_points(placed).hits, old ? palette.scan : palette.filtered, 1.4);
}
