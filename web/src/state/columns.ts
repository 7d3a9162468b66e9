// web/src/state/columns.ts: the numbers of a run by row, for the path and the plots, in growing
// typed arrays; a missing number is NaN. Beyond a bound, a live run is thinned to save memory.
import { ChannelInfo } from "../contract";
import { Frame } from "../link/frame";
import { Before, kFrameSignals } from "./signals";

/** The columns of the record's ticks. Each other signal has a column from its first value on. */
const kColumns = ["t", "tick", "x", "y", "heading", "v", "omega", "clearance"] as const;

export interface MeasureKey { name: string; unit: string }

/** A row of GET /runs/{id}/ticks. */
export type TickRow = Record<(typeof kColumns)[number], number>;

/** The column of value `k`, named as in the CSV: "NAME", or "NAME[1]" of several values. */
const column_of = (info: ChannelInfo, k: number) => (info.values > 1 ? `${info.name}[${k}]` : info.name);

export class Columns {
  length = 0;
  /** The measures so far, in the order of their first frame. */
  measures: MeasureKey[] = [];
  /** The channels of the robot; a reading names its channel by the index in this list. */
  channels: ChannelInfo[] = [];
  private held_ = new Map<string, number>(); // the newest value of each channel
  private data_ = new Map<string, Float64Array>();
  private capacity_ = 1024;
  private stride_ = 1;
  private skipped_ = 0;
  private before_: Before = { stamp: NaN, scan: NaN, sees: false };

  /** Keeps at most `most` rows: beyond, every second row goes, and later rows are thinned alike. */
  constructor(private readonly most_ = Infinity) {
    for (const name of kColumns) this.add(name);
  }

  /** A view of the rows, valid until the next push; NaN for an unknown column. */
  get(name: string): Float64Array {
    return this.data_.get(name)?.subarray(0, this.length) ?? new Float64Array(this.length).fill(NaN);
  }

  has(name: string): boolean {
    return this.data_.has(name);
  }

  at(name: string, row: number): number {
    return this.data_.get(name)?.[row] ?? NaN;
  }

  clear(): void {
    this.data_.clear();
    for (const name of kColumns) this.add(name);
    this.measures = [];
    this.before_ = { stamp: NaN, scan: NaN, sees: false };
    this.held_.clear();
    this.length = 0;
    this.stride_ = 1;
    this.skipped_ = 0;
  }

  push(f: Frame): void {
    this.hold(f);
    for (const { stamp } of f.sweeps) this.before_.scan = stamp;
    this.before_.sees ||= f.sweeps.length > 0 || f.sonar.length > 0;
    const values = kFrameSignals.map(({ name, of }) => ({ name, value: of(f, this.before_) }));
    this.before_.stamp = f.stamp;
    if (++this.skipped_ < this.stride_) return;
    this.skipped_ = 0;
    if (this.length >= this.most_) this.thin();
    if (this.length === this.capacity_) this.grow();
    const i = this.length++;
    for (const column of this.data_.values()) column[i] = NaN;
    const put = (name: string, value: number) => {
      if (!Number.isNaN(value)) (this.data_.get(name) ?? this.add(name))[i] = value;
    };
    put("t", f.stamp);
    put("tick", f.tick);
    for (const { name, value } of values) put(name, value);
    const put_named = (name: string, unit: string, value: number) => {
      if (!this.measures.some((m) => m.name === name)) this.measures = [...this.measures, { name, unit }];
      put(name, value);
    };
    for (const { name, unit, value } of f.measures) put_named(name, unit, value);
    for (const { name, unit } of this.channel_columns()) {
      const value = this.held_.get(name);
      if (value !== undefined) put_named(name, unit, value);
    }
  }

  /** Keeps the values of channels, which are read less often than every tick. */
  private hold(f: Frame): void {
    for (const { channel, values } of f.readings) {
      const info = this.channels[channel];
      if (!info) continue;
      values.forEach((value, k) => this.held_.set(column_of(info, k), value));
    }
  }

  private channel_columns(): MeasureKey[] {
    return this.channels.flatMap((info) =>
      Array.from({ length: info.values }, (_, k) => ({ name: column_of(info, k), unit: info.unit })));
  }

  /** Inserts rows of the record that follow each other, by their ticks. Columns that they lack are NaN there. */
  insert(rows: TickRow[]): void {
    const count = rows.length;
    if (count === 0) return;
    const at = last_not_after(this.get("tick"), rows[0].tick) + 1;
    while (this.capacity_ < this.length + count) this.grow();
    for (const [name, column] of this.data_) {
      column.copyWithin(at + count, at, this.length);
      for (let i = 0; i < count; ++i) {
        column[at + i] = (rows[i] as unknown as Record<string, number | undefined>)[name] ?? NaN;
      }
    }
    this.length += count;
  }

  /** Calls `each` with the positions of rows [from, to), thinned to about `most`; with `truly` the true ones. */
  each_place(from: number, to: number, most: number, each: (x: number, y: number) => void, truly = false): void {
    const xs = this.get(truly ? "truth.x" : "x");
    const ys = this.get(truly ? "truth.y" : "y");
    const step = Math.max(1, Math.floor((to - from) / most));
    for (let i = from; i < to - 1; i += step) each(xs[i], ys[i]);
    each(xs[to - 1], ys[to - 1]);
  }

  /** The last row with t <= `t`; 0 when there is none. */
  row_at(t: number): number {
    return Math.max(0, last_not_after(this.get("t"), t));
  }

  private thin(): void {
    for (const column of this.data_.values()) {
      for (let i = 0; 2 * i < this.length; ++i) column[i] = column[2 * i];
    }
    this.length = Math.ceil(this.length / 2);
    this.stride_ *= 2;
  }

  private add(name: string): Float64Array {
    const column = new Float64Array(this.capacity_).fill(NaN);
    this.data_.set(name, column);
    return column;
  }

  private grow(): void {
    this.capacity_ *= 2;
    for (const [name, column] of this.data_) {
      const wider = new Float64Array(this.capacity_);
      wider.set(column);
      this.data_.set(name, wider);
    }
  }
}

/** Index of the last of the ascending `values` that is at most `limit`; -1 if none is. */
export function last_not_after(values: ArrayLike<number>, limit: number): number {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const mid = (low + high) >> 1;
    if (values[mid] <= limit) low = mid + 1;
    else high = mid;
  }
  return low - 1;
}

/** The value of column `y` where column `x` is `at`; both ascend, and begin before the rows with 0. */
export function interpolated(columns: Columns, x: string, y: string, at: number): number {
  const point = (row: number) => (row < 0 ? { x: 0, y: 0 } : { x: columns.at(x, row), y: columns.at(y, row) });
  const row = Math.min(last_not_after(columns.get(x), at), columns.length - 2); // beyond the rows as between the last two
  const [a, b] = [point(row), point(row + 1)];
  return columns.length > 0 && b.x > a.x ? a.y + ((at - a.x) / (b.x - a.x)) * (b.y - a.y) : a.y;
}
