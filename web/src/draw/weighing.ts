// web/src/draw/weighing.ts: what a controller without a strip weighs: its grid, its histogram, its
// candidate motions, its plan.
import { Pose } from "../geometry";
import { Candidate, Frame, GridLayer, kUnknownCell } from "../link/frame";
import { Palette } from "./palette";
import { arrow } from "./strip";
import { View } from "./view";

type Context = CanvasRenderingContext2D;
const kEven = 127;        // as likely free as occupied
const kGrades = 6;        // shades of occupied cells
const kArcPoints = 8;     // corners of a candidate's arc
const kRing = 0.45;       // [m] from the hull's centre to the histogram's foot
const kTallest = 0.5;     // [m] of a sector at twice the threshold and above

/**
 * Cells more likely occupied than free, the surer the stronger. A path a shade, not a call a cell:
 * there are thousands.
 */
export function draw_cells(g: Context, view: View, palette: Palette, grid: GridLayer): void {
  const edge = grid.cell * view.scale;
  g.fillStyle = palette.external;
  for (let grade = 0; grade < kGrades; ++grade) {
    g.globalAlpha = (0.5 * (grade + 1)) / kGrades;
    g.beginPath();
    grid.cells.forEach((c, at) => {
      if (c === kUnknownCell || c <= kEven) return;
      if (Math.floor(((c - kEven) * kGrades) / (kUnknownCell - kEven)) !== grade) return;
      const x = grid.corner.x + (at % grid.columns) * grid.cell;
      const y = grid.corner.y + Math.floor(at / grid.columns) * grid.cell;
      g.rect(view.sx(x), view.sy(y) - edge, edge, edge);
    });
    g.fill();
  }
  g.globalAlpha = 1;
}

/** The polar histogram as a rose about the robot; sectors from the threshold up in their own colour. */
export function draw_histogram(g: Context, view: View, palette: Palette, f: Frame): void {
  const { histogram, histogram_threshold: threshold } = f;
  if (histogram.length === 0 || !(threshold > 0)) return;
  const x = view.sx(f.pose.x);
  const y = view.sy(f.pose.y);
  const width = (2 * Math.PI) / histogram.length;
  const foot = kRing * view.scale;
  g.globalAlpha = 0.6;
  histogram.forEach((density, k) => {
    if (!(density > 0)) return;
    const height = Math.min(1, density / (2 * threshold)) * kTallest * view.scale;
    g.fillStyle = density < threshold ? palette.muted : palette.external;
    g.beginPath();
    // Bearings are in W and the screen's y axis points down.
    g.arc(x, y, foot + height, -k * width, -(k + 1) * width, true);
    g.arc(x, y, foot, -(k + 1) * width, -k * width);
    g.closePath();
    g.fill();
  });
  g.globalAlpha = 1;
}

/** Points of a motion of constant twist from `pose`, in W. */
export function arc_points(pose: Pose, c: Candidate): { x: number; y: number }[] {
  const points = [];
  for (let k = 0; k <= kArcPoints; ++k) {
    const t = (c.horizon * k) / kArcPoints;
    const turn = c.omega * t;
    const half = turn / 2;
    // The chord of an arc: v t sinc(turn / 2) along the middle heading.
    const chord = c.v * t * (Math.abs(half) < 1e-6 ? 1 : Math.sin(half) / half);
    points.push({
      x: pose.x + chord * Math.cos(pose.heading + half),
      y: pose.y + chord * Math.sin(pose.heading + half),
    });
  }
  return points;
}

/** The motions weighed: refused ones faint and broken, the chosen one on top. */
export function draw_candidates(g: Context, view: View, palette: Palette, f: Frame): void {
  const styles = [
    { of: (c: Candidate) => !c.allowed, colour: palette.bad, alpha: 0.25, width: 1 },
    { of: (c: Candidate) => c.allowed && !c.chosen, colour: palette.muted, alpha: 0.4, width: 1 },
    { of: (c: Candidate) => c.chosen, colour: palette.accent, alpha: 1, width: 3 },
  ];
  for (const style of styles) {
    g.strokeStyle = style.colour;
    g.globalAlpha = style.alpha;
    g.lineWidth = style.width;
    g.beginPath();
    for (const c of f.candidates) {
      if (!style.of(c)) continue;
      arc_points(f.pose, c).forEach((p, i) => {
        if (i === 0) g.moveTo(view.sx(p.x), view.sy(p.y));
        else g.lineTo(view.sx(p.x), view.sy(p.y));
      });
    }
    g.stroke();
  }
  g.globalAlpha = 1;
}

/** What was seen moving, and its way in the next second; faint while it is out of sight. */
export function draw_tracks(g: Context, view: View, palette: Palette, f: Frame): void {
  for (const t of f.tracks) {
    g.globalAlpha = t.unseen > 0.2 ? 0.4 : 1;
    g.strokeStyle = palette.warn;
    g.lineWidth = 2;
    g.beginPath();
    g.arc(view.sx(t.position.x), view.sy(t.position.y), t.radius * view.scale, 0, 2 * Math.PI);
    g.stroke();
    arrow(g, view, t.position, t.velocity, 1, palette.warn, 2);
  }
  g.globalAlpha = 1;
}

export function draw_plan(g: Context, view: View, palette: Palette, f: Frame): void {
  if (f.plan.length < 2) return;
  g.strokeStyle = palette.accent;
  g.lineWidth = 2.5;
  g.lineJoin = "round";
  g.setLineDash([2, 6]);
  g.lineCap = "round";
  g.beginPath();
  f.plan.forEach((p, i) => {
    if (i === 0) g.moveTo(view.sx(p.x), view.sy(p.y));
    else g.lineTo(view.sx(p.x), view.sy(p.y));
  });
  g.stroke();
  g.setLineDash([]);
}
