// web/src/draw/ground.ts: ramps, steps and trenches from above: heights as shades and numbers, an arrow uphill; and the
// tilt of the robot. Fetched with the first world whose ground is not level.
import { Point, degrees, to_parent } from "../geometry";
import { downhill, slope_of, tilt_of, top_at } from "../ground";
import { Obstacle } from "../obstacle";
import { SceneState, robot_pose } from "../state/scene";
import { fixed } from "../words";
import { Context, arrow, fill, stroke, trace, write, write_over } from "./marks";
import { Palette } from "./palette";
import { draw_on_ground } from "./scene";
import { View } from "./view";
import { trace_obstacle } from "./world";

const kSteepShade = 0.6;  // [m] of height that has the strongest shade
const kContours = [0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5]; // [m] between contour lines
const kContourGap = 46;   // [px] at least between two of them: their numbers do not meet
const kWordsRoom = 34;    // [px] that a number needs inside its piece of ground
const kHatch = 7;         // [px] between the lines of a trench
const kTilted = Math.PI / 180; // [rad] from which on a tilt is shown

/** `#rrggbb` with the opacity of a height. */
function shade(colour: string, height: number): string {
  const alpha = height === 0 ? 0.06 : 0.16 + 0.5 * Math.sqrt(Math.min(1, Math.abs(height) / kSteepShade));
  return colour + Math.round(255 * alpha).toString(16).padStart(2, "0");
}

/** "0.15 m", and to a millimetre where it matters. */
export function height_words(height: number): string {
  return `${fixed(height, Math.abs(height) < 0.1 && Math.round(height * 1000) % 10 !== 0 ? 3 : 2)} m`;
}

function draw_ground(g: Context, view: View, palette: Palette, ground: Obstacle[], selected: number | null,
  hovered: number | null): void {
  const highest = (o: Obstacle) => Math.max(o.low, o.height) - (o.kind === "trench" ? 100 : 0);
  for (const o of [...ground].sort((a, b) => highest(a) - highest(b))) {
    g.save();
    trace_obstacle(g, view, o);
    if (o.kind === "trench") draw_trench(g, view, palette, o);
    else draw_rise(g, view, palette, o);
    g.restore();
    trace_obstacle(g, view, o);
    stroke(g, o.id === selected ? palette.accent : o.id === hovered ? palette.text : palette.high, o.id === selected ? 2.5 : 1.5);
  }
  for (const o of ground) draw_words(g, view, palette, o);
}

/** A hole: dark and hatched, so that shape repeats what colour says. */
function draw_trench(g: Context, view: View, palette: Palette, o: Obstacle): void {
  fill(g, palette.deep);
  g.clip();
  const [middle, reach] = [view.to_screen(o.pose), (Math.hypot(o.length, o.width) / 2) * view.scale];
  const n = Math.min(200, Math.ceil(reach / kHatch));
  g.beginPath();
  for (let i = -n; i <= n; ++i) {
    g.moveTo(middle.x + i * kHatch - reach, middle.y + reach);
    g.lineTo(middle.x + i * kHatch + reach, middle.y - reach);
  }
  g.globalAlpha = 0.45;
  stroke(g, palette.high, 1);
}

/** Shaded by height, with a line at every contour. */
function draw_rise(g: Context, view: View, palette: Palette, o: Obstacle): void {
  const [a, b] = [-o.length / 2, o.length / 2].map((x) => view.to_screen(to_parent(o.pose, x, 0)));
  const colours = g.createLinearGradient(a.x, a.y, b.x, b.y);
  colours.addColorStop(0, shade(palette.high, o.low));
  colours.addColorStop(1, shade(palette.high, o.height));
  g.fillStyle = colours;
  g.fill();
  g.beginPath();
  for (const { at } of contours(view, o)) {
    trace(g, view, [to_parent(o.pose, at, -o.width / 2), to_parent(o.pose, at, o.width / 2)]);
  }
  g.globalAlpha = 0.7;
  stroke(g, palette.high, 1);
}

/** The contour lines between both ends, by their x in the frame of the ramp. */
function contours(view: View, o: Obstacle): { at: number; height: number }[] {
  const rise = o.height - o.low;
  const step = kContours.find((s) => (s / Math.abs(rise)) * o.length * view.scale >= kContourGap);
  if (rise === 0 || !step) return [];
  const [from, to] = [Math.min(o.low, o.height), Math.max(o.low, o.height)];
  const found: { at: number; height: number }[] = [];
  for (let k = Math.floor(from / step) + 1; k * step < to - 1e-9; ++k) {
    found.push({ at: o.length * ((k * step - o.low) / rise - 0.5), height: k * step });
  }
  return found;
}

/** The arrow uphill and its slope; numbers at the contour lines and at the ends, beside a piece without room. */
function draw_words(g: Context, view: View, palette: Palette, o: Obstacle): void {
  const font = `600 11px ${palette.font}`;
  const put = (text: string, p: Point, colour = palette.text) => write_over(g, text, p.x, p.y, colour, font, palette.bg, 3);
  const inside = (x: number, y: number) => view.to_screen(to_parent(o.pose, x, y));
  const [length, width] = [o.length * view.scale, o.width * view.scale];
  const slope = slope_of(o);
  if (Math.min(length, width) < kWordsRoom) {
    const edge = inside(0, -o.width / 2), middle = inside(0, 0);
    const away = 12 / Math.max(1, Math.hypot(edge.x - middle.x, edge.y - middle.y));
    if (Math.max(length, width) < 12) return;
    put(slope === 0 ? height_words(o.kind === "trench" ? o.low : o.height) : `${fixed(degrees(Math.abs(slope)), 1)}°`,
      { x: edge.x + away * (edge.x - middle.x), y: edge.y + away * (edge.y - middle.y) });
    return;
  }
  if (slope === 0) {
    put(height_words(top_at(o, o.pose)), inside(0, 0));
    return;
  }
  const up = Math.sign(slope);
  const half = Math.min(0.32 * o.length, 60 / view.scale);
  const along = { x: 2 * half * up * Math.cos(o.pose.heading), y: 2 * half * up * Math.sin(o.pose.heading) };
  arrow(g, view, to_parent(o.pose, -half * up, 0), along, 1, palette.text, 2);
  const beside = Math.min(0.28 * o.width, 22 / view.scale);
  put(`${fixed(degrees(Math.abs(slope)), 1)}°`, inside(0, beside));
  const side = -0.5 * o.width + Math.min(0.25 * o.width, 24 / view.scale);
  for (const { at, height } of contours(view, o)) put(height_words(height), inside(at, side), palette.muted);
  const end = 0.5 * o.length - Math.min(0.2 * o.length, 24 / view.scale);
  if (length < 3 * kWordsRoom) return;
  put(height_words(o.low), inside(-end, -side));
  put(height_words(o.height), inside(end, -side));
}

/** From the hull an arrow downhill, with the angle of the robot's tilt. */
function draw_tilt(g: Context, view: View, palette: Palette, scene: SceneState): void {
  const [tilt, pose] = [tilt_of(scene), robot_pose(scene)];
  if (!tilt || !pose) return;
  const { bearing, angle } = downhill(tilt);
  if (angle < kTilted) return;
  const way = pose.heading + bearing;
  const at = (px: number) => {
    const r = Math.max(scene.radius, 6 / view.scale) + px / view.scale;
    return { x: pose.x + r * Math.cos(way), y: pose.y + r * Math.sin(way) };
  };
  const length = Math.min(34, 10 + 1.2 * degrees(angle));
  const [from, to] = [at(3), at(3 + length)];
  arrow(g, view, from, { x: to.x - from.x, y: to.y - from.y }, 1, palette.high, 3);
  const words = view.to_screen(at(length + 17));
  write(g, `${fixed(degrees(angle), 0)}°`, words.x, words.y, palette.text, `600 12px ${palette.font}`);
}

draw_on_ground({ draw_ground, draw_tilt });
