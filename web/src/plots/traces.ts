// web/src/plots/traces.ts: which lines the plots have: signals of one run in their own colours, or of
// several runs in the colours of the runs.
import { Columns } from "../state/columns";
import { Token } from "../state/layers";
import { plots_of } from "../state/measures";
import { Signal } from "../state/signals";
import { fixed } from "../words";
import { Chart } from "./chart";
import { Span } from "./span";
import { points_of } from "./thin";

/** A run to plot. */
export interface PlotRun { label: string; columns: Columns }

/** The colours of compared runs, in their order. */
export const kRunColours: Token[] = ["accent", "elastic", "third", "fourth"];
const kDashes = [[], [6, 3], [2, 3], [8, 3, 2, 3]]; // of the signals of a plot, when colours tell the runs
const kBehind = 0.2; // [s] behind its end a run has no value

export interface Trace { signal: Signal; run: PlotRun; label: string; colour: Token; dash: number[] }
export interface Plot { title: string; traces: Trace[] }

export function plots_with(signals: Signal[], runs: PlotRun[]): Plot[] {
  const several = runs.length > 1;
  return plots_of(signals).map(({ title, unit, signals: shared }) => ({
    title: unit ? `${title}, ${unit}` : title,
    traces: shared.flatMap((signal, k) => runs.map((run, i) => ({
      signal, run, label: several ? `${run.label}: ${signal.label}` : signal.label,
      colour: several ? kRunColours[i % kRunColours.length] : signal.colour,
      dash: several ? kDashes[k % kDashes.length] : signal.dash,
    }))),
  }));
}

/** `plot` in `span`, with about `most` points a line. */
export function chart_of({ traces }: Plot, span: Span, most: number): Chart {
  return {
    least: [Math.min(...traces.map((t) => t.signal.least[0])), Math.max(...traces.map((t) => t.signal.least[1]))],
    lines: traces.map(({ signal, run, label, colour, dash }) =>
      ({ label, colour, dash, points: points_of(run.columns, signal.name, span, most) })),
  };
}

/** The value at `t` in words, or the newest. */
export function value_words({ signal, run }: Trace, t: number | null): string {
  const { columns } = run;
  const last = columns.length - 1;
  const behind = last < 0 || (t !== null && t > columns.at("t", last) + kBehind);
  const value = behind ? NaN : columns.at(signal.name, t === null ? last : columns.row_at(t));
  return Number.isFinite(value) && signal.unit ? `${fixed(value, signal.digits)} ${signal.unit}` : fixed(value, signal.digits);
}

/** From the first to the last instant of all runs. */
export function whole_of(runs: PlotRun[]): Span {
  const filled = runs.map((r) => r.columns).filter((c) => c.length > 0);
  return {
    from: Math.min(0, ...filled.map((c) => c.at("t", 0))),
    to: Math.max(0, ...filled.map((c) => c.at("t", c.length - 1))),
  };
}
