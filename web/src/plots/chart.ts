// web/src/plots/chart.ts: draws one plot: axes with numbers, lines over the run clock, the cursor.
// The screen, PNG and SVG have the same drawing.
import { Context, stroke, write } from "../draw/marks";
import { Palette } from "../draw/palette";
import { Token } from "../state/layers";
import { fixed } from "../words";
import { Span } from "./span";
import { Points } from "./thin";

export interface Line { label: string; colour: Token; dash: number[]; points: Points }
export interface Chart {
  lines: Line[];
  least: [number, number]; // range of the values that is always shown
}
export interface Box { x: number; y: number; width: number; height: number }

export interface Look {
  palette: Palette;
  span: Span;
  cursor: number | null; // [s]
  band: Span | null;     // being dragged
}

export const kGutter = 46; // [px] left of the lines, for the numbers
export const kAxis = 20;   // [px] high is the time axis below the last plot
const kRight = 8;
const kTop = 5;
const kFoot = 4;

/** Where the lines of a plot in `box` lie. */
export function field_of(box: Box): Box {
  return {
    x: box.x + kGutter, y: box.y + kTop, width: Math.max(1, box.width - kGutter - kRight),
    height: Math.max(1, box.height - kTop - kFoot),
  };
}

/** About `most` round numbers from `from` to `to`, two at least: steps of 1, 2 or 5 of a power of ten. */
export function ticks(from: number, to: number, most: number): { values: number[]; digits: number } {
  const rough = (to - from) / Math.max(1, most);
  if (!(rough > 0) || !Number.isFinite(rough)) return { values: [], digits: 0 };
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((k) => k * power >= rough * (1 - 1e-9)) ?? 10);
  const values: number[] = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to + 1e-9 * step; ++k) values.push(k * step + 0); // never -0
  if (values.length < 2) return ticks(from, to, 2 * Math.max(1, most));
  return { values, digits: Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)) };
}

/** The range of values: `least`, what the lines have in `span`, and a little room. */
export function value_range(chart: Chart, span: Span): [number, number] {
  let [low, high] = chart.least;
  for (const { points } of chart.lines) {
    for (let i = 0; i < points.x.length; ++i) {
      const value = points.y[i];
      if (points.x[i] < span.from || points.x[i] > span.to || !Number.isFinite(value)) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  const room = 0.06 * (high - low || 1);
  return [low < chart.least[0] || low < 0 ? low - room : low, high + room];
}

export function draw_chart(g: Context, box: Box, chart: Chart, look: Look): void {
  const field = field_of(box);
  const { palette, span } = look;
  const [low, high] = value_range(chart, span);
  const x = (t: number) => field.x + ((t - span.from) / (span.to - span.from)) * field.width;
  const y = (v: number) => field.y + (1 - (v - low) / (high - low)) * field.height;
  draw_values(g, field, look, ticks(low, high, Math.max(2, field.height / 24)), x, y);
  g.save();
  g.beginPath();
  g.rect(field.x, field.y - 2, field.width, field.height + 4);
  g.clip();
  for (const line of chart.lines) {
    trace_line(g, line.points, x, y);
    g.lineJoin = "round";
    stroke(g, palette[line.colour], 1.8, line.dash);
  }
  if (look.band) {
    const [a, b] = [x(look.band.from), x(look.band.to)];
    g.globalAlpha = 0.18;
    g.fillStyle = palette.accent;
    g.fillRect(Math.min(a, b), field.y, Math.abs(b - a), field.height);
    g.globalAlpha = 1;
  }
  if (look.cursor !== null) {
    g.beginPath();
    g.moveTo(x(look.cursor), field.y);
    g.lineTo(x(look.cursor), field.y + field.height);
    stroke(g, palette.text, 1);
  }
  g.restore();
}

const times_of = (field: Box, span: Span) => ticks(span.from, span.to, Math.max(2, field.width / 70));
const edge = (v: number) => Math.round(v) + 0.5; // a sharp line

/** The grid, and the numbers of the values. */
function draw_values(g: Context, field: Box, look: Look, values: ReturnType<typeof ticks>,
  x: (t: number) => number, y: (v: number) => number): void {
  const { palette, span } = look;
  g.beginPath();
  for (const v of values.values) {
    g.moveTo(field.x, edge(y(v)));
    g.lineTo(field.x + field.width, edge(y(v)));
  }
  for (const t of times_of(field, span).values) {
    g.moveTo(edge(x(t)), field.y);
    g.lineTo(edge(x(t)), field.y + field.height);
  }
  stroke(g, palette.grid2, 1);
  const font = `11px ${palette.font}`;
  for (const v of values.values) write(g, fixed(v, values.digits), field.x - 6, y(v), palette.muted, font, "right");
}

/** The time axis below plots as wide as `box`. */
export function draw_time_axis(g: Context, box: Box, look: Look): void {
  const field = field_of(box);
  const { palette, span } = look;
  const times = times_of(field, span);
  const font = `11px ${palette.font}`;
  const y = box.y + box.height / 2;
  const name_at = field.x + field.width - 46; // where the axis says its name
  for (const t of times.values) {
    const x = field.x + ((t - span.from) / (span.to - span.from)) * field.width;
    if (x < name_at) write(g, fixed(t, times.digits), x, y, palette.muted, font);
  }
  write(g, "time, s", field.x + field.width, y, palette.muted, font, "right");
}

/** Begins the outline of a line; a value that is not a number is a gap. */
function trace_line(g: Context, points: Points, x: (t: number) => number, y: (v: number) => number): void {
  g.beginPath();
  let drawing = false;
  for (let i = 0; i < points.x.length; ++i) {
    const value = points.y[i];
    if (!Number.isFinite(value)) {
      drawing = false;
      continue;
    }
    if (drawing) g.lineTo(x(points.x[i]), y(value));
    else g.moveTo(x(points.x[i]), y(value));
    // A value between two gaps is a dot.
    if (!drawing && !Number.isFinite(points.y[i + 1] ?? NaN)) g.lineTo(x(points.x[i]) + 1.5, y(value));
    drawing = true;
  }
}
