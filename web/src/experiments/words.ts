// web/src/experiments/words.ts: states, times and rates of experiments in words.
import { Word, fixed } from "../words";
import { ExperimentInfo, ExperimentState, Figure, Rate } from "./contract";

const kStates: Record<ExperimentState, Word> = {
  running: { word: "Running", tone: "warn" },
  paused: { word: "Paused", tone: "info" },
  interrupted: { word: "Interrupted", tone: "warn" },
  cancelled: { word: "Cancelled", tone: "muted" },
  finished: { word: "Finished", tone: "ok" },
};

export function state_of(info: ExperimentInfo): Word {
  const whole = info.done - info.failed === info.runs;
  return info.state === "finished" && !whole ? { word: "Incomplete", tone: "warn" } : kStates[info.state];
}

/** "1 min 34 s", "2 h 5 min"; below a second "1 s". */
export function span_words(seconds: number): string {
  const s = Math.max(1, Math.round(seconds));
  if (s < 60) return `${s} s`;
  if (s < 3600) return `${Math.floor(s / 60)} min ${s % 60} s`;
  if (s < 360_000) return `${Math.floor(s / 3600)} h ${Math.floor((s % 3600) / 60)} min`;
  return `${Math.round(s / 86_400)} days`;
}

export function count(n: number): string {
  return n.toLocaleString("en");
}

/** "1 run", "3,000 runs". */
export function counted(n: number, noun: string): string {
  return `${count(n)} ${noun}${n === 1 ? "" : "s"}`;
}

/** The line below the name in the list. */
export function progress_words(info: ExperimentInfo): string {
  if (info.done === info.runs) return `${counted(info.runs, "run")}${info.failed > 0 ? `, ${info.failed} failed` : ""}`;
  const share = `${Math.floor((100 * info.done) / info.runs)} %`;
  return info.time_left === null ? `${count(info.done)} of ${counted(info.runs, "run")}`
    : `${share}, ${span_words(info.time_left)} left`;
}

/** Why the figures are not those of the whole experiment; null if they are. */
export function incomplete_words(info: ExperimentInfo): string | null {
  const missing = info.runs - info.done;
  if (missing === 0 && info.failed === 0) return null;
  const parts = [
    ...(missing > 0 ? [`${count(info.done)} of ${counted(info.runs, "run")}`] : []),
    ...(info.failed > 0 ? [`${counted(info.failed, "run")} failed`] : []),
  ];
  return parts.join(", ");
}

/** "97 %", "0.4 %": never 100 % of fewer than all. */
export function percent(rate: Rate | undefined): string {
  if (!rate || rate.rate === null || rate.runs === 0) return "–";
  const share = 100 * rate.rate;
  if (rate.count !== rate.runs && share > 99) return `${fixed(Math.min(share, 99.9), 1)} %`;
  if (rate.count > 0 && share < 1) return `${fixed(Math.max(share, 0.1), 1)} %`;
  return `${fixed(share, 0)} %`;
}

/** "94–98", in percent. */
export function interval_words(rate: Rate | undefined): string {
  if (!rate?.interval) return "";
  return rate.interval.map((bound) => fixed(100 * bound, 0)).join("–");
}

/** "44.6". The interval is the mean's, so mean_words() gives it. */
export function median_words(figure: Figure | undefined, digits: number): string {
  return fixed(figure?.median ?? null, digits);
}
/** "mean 44.6 [43.8–45.5]"; empty without an interval. */
export function mean_words(figure: Figure | undefined, digits: number): string {
  if (figure?.mean === undefined || !figure.mean_interval) return "";
  const [low, high] = figure.mean_interval;
  return `mean ${fixed(figure.mean, digits)} [${fixed(low, digits)}–${fixed(high, digits)}]`;
}

export function p_words(p: number): string {
  return p < 0.0001 ? "p < 0.0001" : `p = ${p.toPrecision(2)}`;
}
