// web/src/link/past.ts: fetches from the record what a page missed that was opened late.
import { Page } from "../contract";
import { TickRow } from "../state/columns";
import { SceneState, fold_frame } from "../state/scene";
import { decode_frames, decode_sweep } from "./frame";
import * as rest from "./rest";
import { session_path } from "./session";
import { fetch_all, stored_frames } from "./stored";

const kLate = 40;        // [ticks] from which a page fetches the rows that it missed
const kRecentTicks = 60; // ticks back in which the newest scan and words are found

export class Past {
  /** Whether filtered scans are shown. */
  wants_filtered = false;
  private asked_for_: number | null = null; // run whose rows were fetched

  constructor(private readonly scene_: SceneState, private readonly most_rows_: number,
    private readonly changed_: () => void) {}

  /** For another server process, whose run may have the same number. */
  forget(): void {
    this.asked_for_ = null;
  }

  /** Fetches the missed rows, once for each run. */
  look_back(): void {
    const { run, columns } = this.scene_;
    if (run === null || run <= 0 || run === this.asked_for_ || columns.length === 0) return;
    this.asked_for_ = run;
    const first = columns.at("tick", 0);
    if (first > kLate) void this.fetch_rows(first);
  }

  /** A paused run sends no frames: without one, the page shows the last frame of the record. */
  async fetch_newest(): Promise<void> {
    const { run } = this.scene_;
    if (run === null || run <= 0 || this.scene_.frame) return;
    try {
      const { tick } = await rest.get<{ tick?: number }>(session_path());
      if (tick === undefined) return;
      const frames = await recent(run, "frames", tick);
      if (this.scene_.frame || run !== this.scene_.run) return; // a live frame came meanwhile
      for (const frame of decode_frames(frames)) fold_frame(this.scene_, frame);
      this.look_back();
      this.changed_();
      if (this.wants_filtered) await this.fetch_filtered();
    } catch {
      // The run has no record: the page shows it from the next frame on.
    }
  }

  /** The newest filtered scan, from the record. */
  async fetch_filtered(): Promise<void> {
    const { run, frame } = this.scene_;
    if (run === null || run <= 0 || !frame) return;
    try {
      const messages = await recent(run, "filtered", frame.tick);
      if (run !== this.scene_.run || !this.wants_filtered) return;
      const newest = messages.map(decode_sweep).filter((sweep) => sweep !== null).at(-1);
      if (newest) this.scene_.filtered.take(newest);
      this.changed_();
    } catch {
      // The page shows filtered scans from the next one on.
    }
  }

  /** Fetches the path and the figures before tick `before`. */
  private async fetch_rows(before: number): Promise<void> {
    const { run } = this.scene_;
    const stride = Math.max(1, Math.ceil(before / this.most_rows_) * 2 - 1);
    const rows: TickRow[] = [];
    try {
      for (let from: number | null = 0; from !== null && from < before;) {
        const page: Page<TickRow> = await rest.get(`/runs/${run}/ticks?from=${from}&limit=5000`);
        rows.push(...page.items.filter((r) => r.tick < before && r.tick % stride === 0));
        from = page.next === null ? null : Number(page.next);
      }
    } catch {
      return; // the path then begins at the first live frame
    }
    if (run !== this.scene_.run || rows.length === 0) return;
    this.scene_.columns.prepend(rows);
    this.scene_.rows = this.scene_.columns.length;
    this.changed_();
  }
}

/** The last messages up to tick `last`. */
function recent(run: number, what: "frames" | "filtered", last: number): Promise<Uint8Array[]> {
  const from = Math.max(0, last - kRecentTicks);
  return fetch_all(stored_frames(run, what), from, last - from + 1);
}
