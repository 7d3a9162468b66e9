// web/src/plots/plot.ts: one small uPlot chart: lines over the run clock, a cursor, the theme's
// colours. Values arrive as columns; the window is set from outside.
import uPlot from "uplot";
import { read_palette } from "../draw/palette";

export type Token = "filtered" | "external" | "elastic" | "internal" | "accent" | "path" | "ok";
export interface Line { label: string; colour: Token; dash?: number[]; width?: number }

export class Plot {
  private chart_: uPlot | null = null;
  private observer_: ResizeObserver;
  private cursor_: number | null = null;
  private data_: uPlot.AlignedData;

  constructor(private readonly box_: HTMLElement, private readonly lines_: Line[],
    private readonly height_: number, private readonly least_: [number, number],
    private readonly on_pick_?: (t: number) => void) {
    this.data_ = [[], ...lines_.map(() => [])] as unknown as uPlot.AlignedData;
    this.observer_ = new ResizeObserver(() => {
      if (box_.clientWidth > 0) this.chart_?.setSize({ width: box_.clientWidth, height: height_ });
    });
    this.observer_.observe(box_);
    this.theme();
  }

  /** Builds the chart anew with the colours of the current theme. */
  theme(): void {
    this.chart_?.destroy();
    const p = read_palette();
    const axis_font = `11px ${p.font}`;
    this.chart_ = new uPlot({
      width: Math.max(80, this.box_.clientWidth),
      height: this.height_,
      padding: [6, 2, 4, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: false, auto: false },
        y: { range: (_u, low, high) => padded(low, high, this.least_) },
      },
      axes: [
        { show: false },
        {
          size: 34, font: axis_font, stroke: p.muted, gap: 4,
          grid: { stroke: p.grid2, width: 1 }, ticks: { show: false },
          space: 22,
          values: (_u, splits) => splits.map((v) => String(Number(v.toFixed(2))).replace("-", "−")),
        },
      ],
      series: [{}, ...this.lines_.map((line) => ({
        label: line.label, stroke: p[line.colour], width: line.width ?? 2, dash: line.dash,
        points: { show: false },
      }))],
      hooks: { draw: [(u) => this.draw_cursor(u, p.text)] },
    }, this.data_, this.box_);
    const over = this.chart_.over;
    if (this.on_pick_) {
      const pick = (e: PointerEvent) => {
        if (e.type === "pointermove" && e.buttons !== 1) return;
        const box = over.getBoundingClientRect();
        this.on_pick_!(this.chart_!.posToVal(e.clientX - box.left, "x"));
      };
      over.addEventListener("pointerdown", pick);
      over.addEventListener("pointermove", pick);
      over.classList.add("pickable");
    }
  }

  /** Columns x, y1, y2 ...; shows [from, to] of the run clock. */
  update(columns: ArrayLike<number | null>[], from: number, to: number, cursor: number | null): void {
    this.data_ = columns as unknown as uPlot.AlignedData;
    this.cursor_ = cursor;
    this.chart_?.batch(() => {
      this.chart_!.setData(this.data_, false);
      this.chart_!.setScale("x", { min: from, max: Math.max(to, from + 0.1) });
    });
  }

  destroy(): void {
    this.observer_.disconnect();
    this.chart_?.destroy();
    this.chart_ = null;
  }

  private draw_cursor(u: uPlot, colour: string): void {
    if (this.cursor_ === null) return;
    const x = Math.round(u.valToPos(this.cursor_, "x", true));
    const { top, height } = u.bbox;
    u.ctx.save();
    u.ctx.strokeStyle = colour;
    u.ctx.globalAlpha = 0.6;
    u.ctx.lineWidth = devicePixelRatio || 1;
    u.ctx.beginPath();
    u.ctx.moveTo(x, top);
    u.ctx.lineTo(x, top + height);
    u.ctx.stroke();
    u.ctx.restore();
  }
}

/** At least `least`, and a little room above and below. */
function padded(low: number | null, high: number | null, least: [number, number]):
  [number, number] {
  const a = Math.min(low ?? least[0], least[0]);
  const b = Math.max(high ?? least[1], least[1]);
  const room = 0.06 * (b - a);
  return [a < 0 || a < least[0] ? a - room : a, b + room];
}

/** A copy of every `step`-th of `values`; all of them for a step of 1 or less. */
export function every(values: Float64Array, step: number): Float64Array {
  return step <= 1 ? values.slice() : values.filter((_, i) => i % step === 0);
}

/** `values` with null in place of NaN, which leaves a gap in the line. */
export function gapped(values: Float64Array): (number | null)[] | Float64Array {
  return values.some(Number.isNaN) ? Array.from(values, (v) => (Number.isNaN(v) ? null : v)) : values;
}

/** Column `other` of a second run, sampled at the times `t` of the first; null behind its end. */
export function resampled(t: Float64Array, other_t: Float64Array, other: Float64Array):
  (number | null)[] {
  const out: (number | null)[] = [];
  let j = 0;
  for (let i = 0; i < t.length; ++i) {
    while (j + 1 < other_t.length && other_t[j + 1] <= t[i]) ++j;
    const inside = other_t.length > 0 && t[i] <= other_t[other_t.length - 1] + 0.2;
    out.push(inside && !Number.isNaN(other[j]) ? other[j] : null);
  }
  return out;
}
