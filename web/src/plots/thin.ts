// web/src/plots/thin.ts: the rows of a column that a plot draws: with no more points than it has
// pixels, and with every peak.
import { Columns } from "../state/columns";
import { Span } from "./span";

export interface Points { x: ArrayLike<number>; y: ArrayLike<number> }

/** Rows [from, to) of `columns` in `span`, and one more on each side, so that the line goes to the edges. */
export function rows_in(columns: Columns, span: Span): [number, number] {
  const end = columns.length;
  const last = columns.row_at(span.to);
  return [columns.row_at(span.from), Math.min(end, last + 2)];
}

/**
 * Column `name` in `span`. Of more rows than `most`, each bucket of rows gives its least and its greatest
 * value, in their order; a bucket without a number gives a gap.
 */
export function points_of(columns: Columns, name: string, span: Span, most: number): Points {
  const [from, to] = rows_in(columns, span);
  const t = columns.get("t").subarray(from, to);
  const values = columns.get(name).subarray(from, to);
  if (t.length <= most) return { x: t, y: values };
  const key = [from, to, most, columns.length, t[0], t[t.length - 1]].join();
  const kept = kThinned.get(columns) ?? new Map<string, { key: string; points: Points }>();
  kThinned.set(columns, kept);
  const before = kept.get(name);
  if (before?.key === key) return before.points;
  const points = thinned(t, values, most);
  kept.set(name, { key, points });
  return points;
}

/** The last thinned points of each column: a moving cursor asks for the same again and again. */
const kThinned = new WeakMap<Columns, Map<string, { key: string; points: Points }>>();

function thinned(t: Float64Array, values: Float64Array, most: number): Points {
  const size = Math.ceil((2 * t.length) / most);
  const x: number[] = [];
  const y: number[] = [];
  for (let begin = 0; begin < t.length; begin += size) {
    const end = Math.min(t.length, begin + size);
    let low = -1;
    let high = -1;
    for (let i = begin; i < end; ++i) {
      if (Number.isNaN(values[i])) continue;
      if (low < 0 || values[i] < values[low]) low = i;
      if (high < 0 || values[i] > values[high]) high = i;
    }
    for (const i of low < 0 ? [begin] : low === high ? [low] : [Math.min(low, high), Math.max(low, high)]) {
      x.push(t[i]);
      y.push(values[i]);
    }
  }
  return { x, y };
}
