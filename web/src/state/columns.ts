// web/src/state/columns.ts: the plain numbers of a run by row, for the path and the plots, in
// growing typed arrays. A live run is thinned when it grows beyond a bound, so memory stays flat.
import { Frame } from "../link/frame";

export const kColumns = ["t", "tick", "x", "y", "heading", "v", "omega", "clearance", "left",
  "right", "elastic", "internal"] as const;
export type Column = (typeof kColumns)[number];

/** A row of GET /runs/{id}/ticks. */
export interface TickRow {
  tick: number; t: number; x: number; y: number; heading: number; v: number; omega: number;
  clearance: number;
}

export class Columns {
  length = 0;
  private data_ = new Map<Column, Float64Array>();
  private capacity_ = 1024;
  private stride_ = 1;
  private skipped_ = 0;

  /** `most` rows are kept; when reached, every second one goes and later ones are thinned alike. */
  constructor(private readonly most_ = Infinity) {
    for (const name of kColumns) this.data_.set(name, new Float64Array(this.capacity_));
  }

  /** A view of the rows, valid until the next push. */
  get(name: Column): Float64Array {
    return this.data_.get(name)!.subarray(0, this.length);
  }

  at(name: Column, row: number): number {
    return this.data_.get(name)![row];
  }

  clear(): void {
    this.length = 0;
    this.stride_ = 1;
    this.skipped_ = 0;
  }

  push(f: Frame): void {
    if (++this.skipped_ < this.stride_) return;
    this.skipped_ = 0;
    if (this.length >= this.most_) this.thin();
    if (this.length === this.capacity_) this.grow();
    const i = this.length++;
    const put = (name: Column, value: number) => {
      this.data_.get(name)![i] = value;
    };
    put("t", f.stamp);
    put("tick", f.tick);
    put("x", f.pose.x);
    put("y", f.pose.y);
    put("heading", f.pose.heading);
    put("v", f.twist.v);
    put("omega", f.twist.omega);
    put("clearance", f.clearance);
    put("left", Math.hypot(f.external_left.x, f.external_left.y));
    put("right", Math.hypot(f.external_right.x, f.external_right.y));
    put("elastic", Math.hypot(f.elastic.x, f.elastic.y));
    const via = f.strip[1];
    put("internal", via ? Math.hypot(via.internal.x, via.internal.y) : 0);
  }

  /** Puts rows of the record before those that are here. What they do not say is NaN. */
  prepend(rows: TickRow[]): void {
    const count = rows.length;
    while (this.capacity_ < this.length + count) this.grow();
    for (const [name, column] of this.data_) {
      column.copyWithin(count, 0, this.length);
      for (let i = 0; i < count; ++i) {
        column[i] = (rows[i] as unknown as Record<string, number | undefined>)[name] ?? NaN;
      }
    }
    this.length += count;
  }

  /** The last row with t <= `t`; 0 when there is none. */
  row_at(t: number): number {
    const column = this.data_.get("t")!;
    let low = 0;
    let high = this.length;
    while (low < high) {
      const mid = (low + high) >> 1;
      if (column[mid] <= t) low = mid + 1;
      else high = mid;
    }
    return Math.max(0, low - 1);
  }

  private thin(): void {
    for (const column of this.data_.values()) {
      for (let i = 0; 2 * i < this.length; ++i) column[i] = column[2 * i];
    }
    this.length = Math.ceil(this.length / 2);
    this.stride_ *= 2;
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
