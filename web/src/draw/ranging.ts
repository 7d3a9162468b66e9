// web/src/draw/ranging.ts: sonar cones, infrared returns, bumpers.
import { Frame } from "../link/frame";
import { PlacedReadings } from "../state/ranging";
import { Context } from "./marks";
import { Palette } from "./palette";
import { View } from "./view";

const kHalfCone = Math.PI / 12; // [rad] of a sonar: the echo is somewhere on that arc
const kDot = 2;                 // [px]

export function draw_ranging(g: Context, view: View, palette: Palette,
  readings: PlacedReadings): void {
  g.lineWidth = 2;
  for (const reading of readings.values()) {
    if (!reading.hit) continue;
    const { x, y, heading } = reading.origin;
    if (reading.kind === "sonar") {
      g.strokeStyle = palette.scan;
      g.globalAlpha = 0.8;
      g.beginPath();
      // The screen's y axis points down.
      g.arc(view.sx(x), view.sy(y), reading.range * view.scale, -heading - kHalfCone,
        -heading + kHalfCone);
      g.stroke();
    } else {
      const px = view.sx(x + reading.range * Math.cos(heading));
      const py = view.sy(y + reading.range * Math.sin(heading));
      g.fillStyle = palette.warn;
      g.globalAlpha = 1;
      g.fillRect(px - kDot, py - kDot, 2 * kDot, 2 * kDot);
    }
  }
  g.globalAlpha = 1;
}

/** Bumpers that are pressed, as thick arcs on the hull. */
export function draw_bumpers(g: Context, view: View, palette: Palette, f: Frame,
  radius: number): void {
  if (f.bumpers.length === 0) return;
  const half = Math.PI / Math.max(3, f.bumpers.length);
  g.strokeStyle = palette.bad;
  g.lineWidth = 5;
  for (const bumper of f.bumpers) {
    if (!bumper.pressed) continue;
    const heading = f.pose.heading + bumper.mount.heading;
    g.beginPath();
    g.arc(view.sx(f.pose.x), view.sy(f.pose.y), radius * view.scale, -heading - half,
      -heading + half);
    g.stroke();
  }
}
