// web/src/link/past.ts: what a page that came late, or to a paused run, asks of that run's record.
import { Page } from "../contract";
import { TickRow } from "../state/columns";
import { SceneState, fold_frame } from "../state/scene";
import { decode_frames, decode_sweep } from "./frame";
import * as rest from "./rest";
import { session_path } from "./session";
import { split_frames } from "./stored";

const kLate = 40;        // [ticks] a page that comes this late asks for what it missed
const kRecentTicks = 60; // by which the newest scan and words are looked for

export class Past {
  /** Filtered scans are looked at. */
  wants_filtered = false;
  private asked_for_: number | null = null; // run whose past was asked for

  constructor(private readonly scene_: SceneState, private readonly most_rows_: number,
    private readonly changed_: () => void) {}

  /** Another server process: what was asked for is of another run, even of the same number. */
  forget(): void {
    this.asked_for_ = null;
  }

  /** Once a run: a page that came late asks for what it missed. */
  look_back(): void {
    const { run, columns } = this.scene_;
    if (run === null || run <= 0 || run === this.asked_for_ || columns.length === 0) return;
    this.asked_for_ = run;
    const first = columns.at("tick", 0);
    if (first > kLate) void this.fetch_rows(first);
  }

  /** A paused run sends no frames: a page that has none shows the last one of the record. */
  async fetch_newest(): Promise<void> {
    const { run } = this.scene_;
    if (run === null || run <= 0 || this.scene_.frame) return;
    try {
      const { tick } = await rest.get<{ tick?: number }>(session_path());
      if (tick === undefined) return;
      const frames = await recent(run, "frames", tick);
      if (this.scene_.frame || run !== this.scene_.run) return; // a live one came meanwhile
      for (const frame of decode_frames(frames)) fold_frame(this.scene_, frame);
      this.look_back();
      this.changed_();
      if (this.wants_filtered) await this.fetch_filtered();
    } catch {
      // Nothing is kept of this run: it is shown from the next frame on.
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
      // It is shown from the next scan on.
    }
  }

  /** The path and the figures of the run before this page came. */
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
      return; // the path then begins where this page came in
    }
    if (run !== this.scene_.run || rows.length === 0) return;
    this.scene_.columns.prepend(rows);
    this.scene_.rows = this.scene_.columns.length;
    this.changed_();
  }
}

/** The last messages of `what` up to tick `last`. */
async function recent(run: number, what: "frames" | "filtered", last: number): Promise<Uint8Array[]> {
  const messages: Uint8Array[] = [];
  for (let from: number | null = Math.max(0, last - kRecentTicks); from !== null && from <= last;) {
    const page: { bytes: Uint8Array; next: number | null } =
      await rest.get_bytes(`/runs/${run}/${what}?from=${from}&limit=${kRecentTicks + 1}`);
    messages.push(...split_frames(page.bytes));
    from = page.next;
  }
  return messages;
}
