// web/src/link/past.ts: fetches from the record what a page missed: it was opened late, lost its
// connection, or the run is faster than the frames that are sent.
import { Page } from "../contract";
import { TickRow } from "../state/columns";
import { RunEdits } from "../state/edits";
import { EventLog } from "../state/events";
import { SceneState, fold_frame } from "../state/scene";
import { Frame, decode_frames, decode_sweep } from "./frame";
import * as rest from "./rest";
import { session_path } from "./session";
import { fetch_all, split_frames, stored_frames } from "./stored";

const kLate = 40;        // [ticks] from which a page fetches the rows that it missed
const kRecentTicks = 60; // ticks back in which the newest scan and words are found
const kNewestMs = 600;   // between the tries to read a paused run's last frame, which a busy record gets late
const kNewestTries = 20;
const kEventsMs = 2500;  // after which the events of missed ticks are fetched: they are recorded then
const kEventTicks = 20_000; // of one request

/** Ticks that no live frame brought. */
interface Missed { from: number; to: number }

export class Past {
  /** Whether filtered scans are shown. */
  wants_filtered = false;
  readonly edits = new RunEdits();
  private run_: number | null = null;      // run of the last frame
  private last_ = -1;                      // its tick
  private cut_ = false;                    // the connection was lost since
  private missed_: Missed | null = null;   // whose events are to be fetched
  private hole_: Missed | null = null;     // whose part of the path is to be fetched with them
  private sealed_ = -1;                    // last tick that is surely recorded when the timer ends
  private timer_: ReturnType<typeof setTimeout> | undefined;

  /** `recorded`: whether the record can be read now. */
  constructor(private readonly scene_: SceneState, private readonly most_rows_: number,
    private readonly recorded_: () => boolean, private readonly changed_: () => void) {}

  /** For another server process, whose run may have the same number. */
  forget(): void {
    this.run_ = null;
    this.missed_ = this.hole_ = null;
    this.edits.clear();
    clearTimeout(this.timer_);
    this.timer_ = undefined;
  }

  /** The connection was lost. */
  cut(): void {
    this.cut_ = true;
  }

  /** Takes a live frame, and fetches what came before it and after the frame before. */
  see(f: Frame): void {
    const { run } = this.scene_;
    if (run === null || run <= 0) return;
    if (run !== this.run_ || f.tick < this.last_) {
      this.forget();
      this.run_ = run;
      this.last_ = -1;
      this.cut_ = true;
    }
    this.edits.take(f);
    const missed = { from: this.last_ + 1, to: f.tick - 1 };
    this.last_ = f.tick;
    if (missed.to < missed.from) return;
    const late = this.cut_ && missed.to - missed.from >= kLate;
    this.cut_ = false;
    if (late && missed.from === 0) void this.fetch_rows(run, missed);
    else if (late) this.hole_ = missed;
    this.missed_ = { from: Math.min(this.missed_?.from ?? Infinity, missed.from), to: missed.to };
    this.catch_up_soon();
  }

  private catch_up_soon(): void {
    if (this.timer_ !== undefined) return;
    this.sealed_ = this.last_;
    this.timer_ = setTimeout(() => void this.catch_up(), kEventsMs);
  }

  /** A paused run sends no frames: without one, the page shows the last frame of the record, once that holds it. */
  async fetch_newest(tries = kNewestTries): Promise<void> {
    const { run } = this.scene_;
    if (run === null || run <= 0 || this.scene_.frame) return;
    try {
      const now = await rest.get<{ run?: { id: number }; tick?: number }>(session_path());
      // A run that was left before its first recorded tick has no record any more.
      if (now.tick === undefined || now.run?.id !== run) return;
      const frames = await recent(run, "frames", now.tick);
      if (this.scene_.frame || run !== this.scene_.run) return; // a live frame came meanwhile
      for (const frame of decode_frames(frames)) {
        fold_frame(this.scene_, frame);
        this.see(frame);
      }
      if (!this.scene_.frame && tries > 1) setTimeout(() => void this.fetch_newest(tries - 1), kNewestMs);
      this.changed_();
      if (this.scene_.frame && this.wants_filtered) await this.fetch_filtered();
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

  /** Fetches the path and the figures of missed ticks. */
  private async fetch_rows(run: number, { from, to }: Missed): Promise<void> {
    const stride = Math.max(1, Math.ceil((to - from) / this.most_rows_) * 2 - 1);
    const rows: TickRow[] = [];
    try {
      for (let next: number | null = from; next !== null && next <= to;) {
        const page: Page<TickRow> = await rest.get(`/runs/${run}/ticks?from=${next}&limit=5000`);
        // Clearance is 0 before the first reading.
        rows.push(...page.items.filter((r) => r.tick <= to && r.tick % stride === 0)
          .map((r) => ({ ...r, clearance: r.clearance || NaN })));
        next = page.next === null ? null : Number(page.next);
      }
    } catch {
      return; // the path then lacks this part
    }
    if (run !== this.run_ || run !== this.scene_.run) return;
    this.scene_.columns.insert(rows);
    this.scene_.rows = this.scene_.columns.length;
    this.changed_();
  }

  /** Fetches the events and edits of missed ticks, as far as they are recorded. */
  async catch_up(): Promise<void> {
    const { run_: run, missed_: missed, hole_: hole } = this;
    clearTimeout(this.timer_);
    this.timer_ = undefined;
    if (!missed || run === null || !this.recorded_()) return; // the next missed tick tries again
    const open = missed.to > this.sealed_; // its end is fetched again
    this.missed_ = open ? { from: Math.max(missed.from, this.sealed_ + 1), to: missed.to } : null;
    this.hole_ = null;
    if (open) this.catch_up_soon();
    if (hole) void this.fetch_rows(run, hole);
    const log = new EventLog(true);
    const fetch = stored_frames(run, "events");
    try {
      for (let next: number | null = missed.from; next !== null && next <= missed.to;) {
        const page = await fetch(next, Math.min(kEventTicks, missed.to - next + 1));
        const frames = decode_frames(split_frames(page.bytes));
        if (next === missed.from && frames.length > 0 && frames[0].tick > 0) log.begin(frames[0]);
        if (run !== this.run_) return;
        for (const frame of frames) {
          log.push(frame);
          this.edits.take(frame);
        }
        next = page.next;
      }
    } catch {
      if (run === this.run_) this.missed_ = { from: missed.from, to: Math.max(missed.to, this.last_) };
      return; // the next missed tick tries again
    }
    if (run !== this.run_ || run !== this.scene_.run) return;
    this.scene_.events.merge(log.list);
    this.changed_();
  }
}

/** The last messages up to tick `last`. */
function recent(run: number, what: "frames" | "filtered", last: number): Promise<Uint8Array[]> {
  const from = Math.max(0, last - kRecentTicks);
  return fetch_all(stored_frames(run, what), from, last - from + 1);
}
