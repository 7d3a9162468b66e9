// web/src/draw/sensing.ts: the free area of the filtered scan, sonar, infrared, bumpers.
import { Frame } from "../link/frame";
import { PlacedReadings } from "../state/ranging";
import { PlacedSweep, sweep_points } from "../state/sweeps";
import { Context, fill, stroke } from "./marks";
import { Palette } from "./palette";
import { View } from "./view";

export const kHalfCone = Math.PI / 12; // [rad] of a sonar: the echo came from somewhere on the arc
export const kConeAlpha = 0.12;        // of the cone that is free up to the arc
const kDot = 2;                 // [px]

/** The area that is free by the filtered scan, as a soft fan; a beam without a reading is a gap. */
export function draw_fan(g: Context, view: View, palette: Palette, placed: PlacedSweep): void {
  const { end } = sweep_points(placed);
  const ox = view.sx(placed.origin.x);
  const oy = view.sy(placed.origin.y);
  g.globalAlpha = 0.075;
  g.beginPath();
  g.moveTo(ox, oy);
  for (let i = 0; i < end.length; i += 2) {
    if (Number.isNaN(end[i])) g.lineTo(ox, oy);
    else g.lineTo(view.sx(end[i]), view.sy(end[i + 1]));
  }
  g.closePath();
  fill(g, palette.filtered);
  g.globalAlpha = 1;
}

export function draw_ranging(g: Context, view: View, palette: Palette,
  readings: PlacedReadings): void {
  const hits = [...readings.values()].filter((r) => r.hit);
  g.save();
  for (const { kind, origin, range } of hits) {
    if (kind !== "sonar") continue;
    const [x, y] = [view.sx(origin.x), view.sy(origin.y)];
    // The screen's y axis points down.
    const arc = () => g.arc(x, y, range * view.scale, -origin.heading - kHalfCone, -origin.heading + kHalfCone);
    g.globalAlpha = kConeAlpha;
    g.beginPath();
    g.moveTo(x, y);
    arc();
    g.closePath();
    fill(g, palette.scan);
    g.globalAlpha = 0.8;
    g.beginPath();
    arc();
    stroke(g, palette.scan, 2);
  }
  g.globalAlpha = 1;
  g.fillStyle = palette.warn;
  for (const { kind, origin, range } of hits) { // on top of the arcs
    if (kind !== "infrared") continue;
    const px = view.sx(origin.x + range * Math.cos(origin.heading));
    const py = view.sy(origin.y + range * Math.sin(origin.heading));
    g.fillRect(px - kDot, py - kDot, 2 * kDot, 2 * kDot);
  }
  g.restore();
}

/** Bumpers that are pressed, as thick arcs on the hull. */
export function draw_bumpers(g: Context, view: View, palette: Palette, f: Frame,
  radius: number): void {
  if (f.bumpers.length === 0) return;
  const half = Math.PI / Math.max(3, f.bumpers.length);
  for (const bumper of f.bumpers) {
    if (!bumper.pressed) continue;
    const heading = f.pose.heading + bumper.mount.heading;
    g.beginPath();
    g.arc(view.sx(f.pose.x), view.sy(f.pose.y), radius * view.scale, -heading - half,
      -heading + half);
    stroke(g, palette.bad, 5);
  }
}
