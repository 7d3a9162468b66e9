// web/src/filter.ts: the scan filters, as the server's, so that the filtered scan need not be sent.
//
// Source: Nong 2008 (thesis), Eq. 1 (pseudomedian, with its own sentence in place of the misprinted
// index range); median 2N+1; LULU as the mean of U_N L_N and L_N U_N. Borders replicate.
import { Sweep, kFree, kMaxRange } from "./link/frame";

export type FilterName = "pseudomedian" | "median" | "lulu" | "none";

/** Values [any unit] and whether each is a reading; B long. */
export interface Samples { values: Float64Array; valid: Uint8Array }

/**
 * Filters with half width N. An output is valid iff its input is valid and the border-replicated
 * window of 2N+1 holds at least N+1 valid samples; an invalid output keeps its input value.
 */
export function apply_filter(name: string, n: number, input: Samples): Samples {
  const size = input.values.length;
  const out = { values: input.values.slice(), valid: input.valid.slice() };
  if (n <= 0 || size === 0 || name === "none") return out;
  const lulu = name === "lulu" ? lulu_values(input, n) : null;
  const window = new Float64Array(2 * n + 1);
  const ok = new Uint8Array(2 * n + 1);
  for (let c = 0; c < size; ++c) {
    if (!input.valid[c]) continue;
    let count = 0;
    for (let k = 0; k <= 2 * n; ++k) {
      const i = Math.min(size - 1, Math.max(0, c - n + k));
      window[k] = input.values[i];
      ok[k] = input.valid[i];
      count += input.valid[i];
    }
    if (count < n + 1) {
      out.valid[c] = 0;
      continue;
    }
    if (lulu) out.values[c] = lulu[c];
    else if (name === "median") out.values[c] = median(window, ok);
    else out.values[c] = pseudomedian(window, ok, n);
  }
  return out;
}

/** Eq. 1 over one window: half of max of the minima plus min of the maxima of G_0 .. G_N. */
function pseudomedian(window: Float64Array, ok: Uint8Array, n: number): number {
  let max_min = -Infinity;
  let min_max = Infinity;
  for (let k = 0; k <= n; ++k) {
    let low = Infinity;
    let high = -Infinity;
    for (let i = k; i <= k + n; ++i) {
      if (!ok[i]) continue;
      low = Math.min(low, window[i]);
      high = Math.max(high, window[i]);
    }
    if (low === Infinity) continue; // a group without a reading says nothing
    max_min = Math.max(max_min, low);
    min_max = Math.min(min_max, high);
  }
  return 0.5 * (max_min + min_max);
}

/** The middle of the readings in the window; of an even number the upper of the middle two. */
function median(window: Float64Array, ok: Uint8Array): number {
  const sorted = [...window].filter((_, i) => ok[i]).sort((a, b) => a - b);
  return sorted[sorted.length >> 1];
}

/** 1/2 (U_N L_N + L_N U_N) on the readings, padded by 3N copies of the border samples. */
function lulu_values(input: Samples, n: number): Float64Array {
  const size = input.values.length;
  const padded = (fill: number) => {
    const p = new Float64Array(size + 6 * n);
    for (let i = 0; i < p.length; ++i) {
      const j = Math.min(size - 1, Math.max(0, i - 3 * n));
      p[i] = input.valid[j] ? input.values[j] : fill;
    }
    return p;
  };
  // An invalid sample is neutral to the extremum that meets it first.
  const lower_first = upper(lower(padded(Infinity), n), n);
  const upper_first = lower(upper(padded(-Infinity), n), n);
  const out = new Float64Array(size);
  for (let i = 0; i < size; ++i) out[i] = 0.5 * (lower_first[i + 3 * n] + upper_first[i + 3 * n]);
  return out;
}

/** L_N: max over the N+1 windows about each sample of their minima (borders replicate). */
function lower(x: Float64Array, n: number): Float64Array {
  return slide(slide(x, n, Math.min, 0), n, Math.max, -n);
}
/** U_N: min over the N+1 windows about each sample of their maxima. */
function upper(x: Float64Array, n: number): Float64Array {
  return slide(slide(x, n, Math.max, 0), n, Math.min, -n);
}
function slide(x: Float64Array, n: number, pick: (a: number, b: number) => number,
  shift: number): Float64Array {
  const out = new Float64Array(x.length);
  for (let i = 0; i < x.length; ++i) {
    let best = NaN;
    for (let k = 0; k <= n; ++k) {
      const v = x[Math.min(x.length - 1, Math.max(0, i + shift + k))];
      if (!Number.isFinite(v)) continue;
      best = Number.isNaN(best) ? v : pick(best, v);
    }
    out[i] = best;
  }
  return out;
}

/** A sweep's beams [m] as samples: free is range_max, a device code is no reading. */
export function samples_of(sweep: Sweep): Samples {
  const size = sweep.ranges.length;
  const out = { values: new Float64Array(size), valid: new Uint8Array(size) };
  for (let i = 0; i < size; ++i) {
    const wire = sweep.ranges[i];
    const coded = wire > kMaxRange;
    out.values[i] = coded ? sweep.range_max : wire / 1000;
    out.valid[i] = coded && wire !== kFree ? 0 : 1;
  }
  return out;
}
