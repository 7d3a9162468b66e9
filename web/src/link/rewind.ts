// web/src/link/rewind.ts: looks back in the live run: shows an earlier instant from the record, while
// the run goes on. It steps and plays by ticks, and jumps over what is not recorded.
import { Gap, RunItem, SessionState } from "../contract";
import { Columns, interpolated } from "../state/columns";
import { RunEdits } from "../state/edits";
import { learn_layers } from "../state/layers";
import { SceneState, forget_instant, show_frame, take_parameters } from "../state/scene";
import { FilteredScan, placed } from "../state/sweeps";
import { clock, sentence_of } from "../words";
import { Frame, decode_sweep } from "./frame";
import { FramePages } from "./pages";
import { FetchFrames, fetch_all, initial_obstacles } from "./stored";

/** Where the record is read; tests bring their own. */
export interface RecordSource {
  frames(run: number): FetchFrames;
  filtered(run: number): FetchFrames;
  row(run: number): Promise<RunItem>;
}

export interface RewindEvents {
  /** The shown instant has changed, or it is live again. */
  changed(): void;
  problem(sentence: string): void;
}

/** A span of run clock [s] that cannot be entered, and why. */
export interface Barred { from: number; to: number; words: string }

/** The spans of `gaps` in the time of a run. */
export function barred_by(gaps: Gap[], columns: Columns): Barred[] {
  const time = (tick: number) => interpolated(columns, "tick", "t", tick);
  return gaps.map((gap) => ({ from: time(gap.first_tick), to: time(gap.last_tick + 1), words: gap.sentence }));
}

const kLead = 6.1;          // [s] in which each value that holds has come again; a grid comes each 5 s
const kRetries = 4;         // for ticks that are not committed yet
const kRetryMs = 400;
const kRowMs = 10_000;      // age at which the row of the run is fetched again
const kRestMs = 250;        // after which a filtered scan is fetched: the server computes it
const kFilteredAtOnce = 48; // [ticks]
const kMostFiltered = 500;

type Timer = ReturnType<typeof setTimeout>;

export class Rewind {
  playing = false;
  private past_: SceneState | null = null; // null: live
  private clock_ = 0;                    // [s] run clock looked at
  private wanted_: number | null = null; // tick
  private drawn_: Frame | null = null;
  private pages_: FramePages | null = null;
  private busy_ = false;
  private retries_ = 0;
  private row_: RunItem | null = null;
  private row_at_ = -Infinity;           // [ms]
  private wants_filtered_ = false;
  private filtering_ = false; // a request is under way
  private filtered_ = new Map<number, Uint8Array>(); // by tick
  private retry_timer_: Timer | undefined;
  private rest_timer_: Timer | undefined;

  constructor(private readonly live_: SceneState, private readonly edits_: RunEdits,
    private readonly session_: () => SessionState | null, private readonly source_: RecordSource,
    private readonly events_: RewindEvents) {}

  /** The earlier instant; null while live, and until its first frames are there. */
  get scene(): SceneState | null {
    return this.drawn_ && this.past_;
  }

  /** [s] Run clock of the earlier instant; null: live. */
  get time(): number | null {
    return this.past_ && this.clock_;
  }
  /** [s] Before the newest tick; null: live. */
  get age(): number | null {
    return this.past_ && Math.max(0, (this.live_.frame?.stamp ?? 0) - this.clock_);
  }

  /** After a live frame: the rows of the path may have been thinned. */
  follow(): void {
    if (this.past_) this.place_row(this.past_);
  }

  /** Another run begins. */
  forget(): void {
    this.live();
    this.row_ = null;
    this.row_at_ = -Infinity;
  }

  live(): void {
    if (!this.past_) return;
    clearTimeout(this.retry_timer_);
    clearTimeout(this.rest_timer_);
    this.past_ = null;
    this.playing = false;
    this.wanted_ = this.drawn_ = this.pages_ = null;
    this.filtered_.clear();
    this.events_.changed();
  }

  /** Shows run clock `t` [s]. The newest tick and later is live. */
  seek(t: number): void {
    this.go(this.tick_at(t), t);
  }

  /** Shows the tick `by` ticks on, or back, at rest. */
  step(by: number): void {
    const from = this.wanted_ ?? this.live_.frame?.tick;
    if (from === undefined) return;
    this.playing = false;
    this.go(from + by);
  }

  toggle(): void {
    this.playing = this.past_ !== null && !this.playing;
    this.events_.changed();
  }

  /** Plays on by `dt` [s] of wall time, unless frames must be fetched first. */
  advance(dt: number): void {
    if (!this.playing || this.busy_) return;
    const t = this.clock_ + dt;
    const tick = this.tick_at(t);
    if (tick === this.wanted_) this.clock_ = t;
    else this.go(tick, t);
  }

  want_filtered(wanted: boolean): void {
    this.wants_filtered_ = wanted;
    if (this.past_) this.show_filtered(this.past_);
  }

  /** What the record does not hold. */
  get barred(): Barred[] {
    const kept_from = this.kept_from;
    const out = barred_by(this.gaps, this.live_.columns);
    const dropped = { from: 0, to: kept_from, words: `Only the time from ${clock(kept_from)} on is kept.` };
    return kept_from > 0 ? [dropped, ...out.filter((b) => b.to > kept_from)] : out;
  }

  /** The gaps so far; the last one lasts while nothing is recorded. */
  private get gaps(): Gap[] {
    const { row_: row, live_: { frame } } = this;
    const record = this.session_()?.record;
    const gaps = row?.gaps ?? [];
    if (!row || !record || !frame || record.status === "recording" || row.ticks >= frame.tick) return gaps;
    return [...gaps, { first_tick: row.ticks, last_tick: frame.tick - 1, cause: record.status, sentence: record.sentence }];
  }

  /** The state of the record has changed: there may be another gap. */
  record_changed(): void {
    this.row_at_ = -Infinity;
    if (this.live_.run !== null && this.live_.run > 0) void this.fetch_row(this.live_.run);
  }

  /** [s] Run clock of the oldest tick that is kept. */
  private get kept_from(): number {
    return this.session_()?.record.kept_from ?? 0;
  }

  private go(tick: number, t?: number): void {
    const newest = this.live_.frame;
    const { run } = this.live_;
    if (!newest || run === null || run <= 0) return;
    const there = this.allowed(tick);
    if (there >= newest.tick) {
      this.live();
      return;
    }
    this.begin(run);
    this.clock_ = t !== undefined && there === tick ? t : this.time_at(there);
    this.wanted_ = there;
    this.retries_ = kRetries;
    this.show();
    this.events_.changed();
  }

  private begin(run: number): void {
    if (!this.past_) {
      this.past_ = {
        ...this.live_, frame: null, sweeps: [], filtered: new FilteredScan(), readings: new Map(), layers: new Map(),
        words: null, arm_asked: null, arm_plan: null,
      };
      this.pages_ = new FramePages(this.source_.frames(run));
    }
    void this.fetch_row(run);
  }

  /** The tick, or the next one that is recorded, in the direction of the move. */
  private allowed(tick: number): number {
    const oldest = this.kept_from > 0 ? this.tick_at(this.kept_from) + 1 : 0;
    const gap = this.gaps.find((g) => tick >= g.first_tick && tick <= g.last_tick);
    if (!gap || tick < oldest) return Math.max(oldest, tick);
    const back = tick < (this.wanted_ ?? Infinity) && gap.first_tick > 0;
    return back ? gap.first_tick - 1 : gap.last_tick + 1;
  }

  private show(): void {
    const tick = this.wanted_;
    if (tick === null || !this.pages_) return;
    const frames = this.pages_.at_hand(this.lead_of(tick), tick);
    if (frames) this.draw(frames);
    else if (!this.busy_) void this.fetch(this.pages_);
  }

  /** Fetches the frames of the wanted tick, until those of the newest wish are there. */
  private async fetch(pages: FramePages): Promise<void> {
    this.busy_ = true;
    try {
      for (let done: number | null = null; this.pages_ === pages && this.wanted_ !== null && done !== this.wanted_;) {
        done = this.wanted_;
        await pages.fetch(this.lead_of(done), done);
      }
    } catch (error) {
      if (this.pages_ === pages) {
        this.events_.problem(`This instant could not be fetched. ${sentence_of(error)}`);
        if (!this.drawn_) this.live();
      }
    } finally {
      this.busy_ = false;
    }
    if (this.pages_ !== pages) this.show();
    else this.show_known(pages);
  }

  /** Shows the wanted tick as far as it is recorded, and tries again for what is committed within a second. */
  private show_known(pages: FramePages): void {
    const tick = this.wanted_;
    if (tick === null) return;
    const frames = pages.known(this.lead_of(tick), tick);
    this.draw(frames);
    if (!pages.at_hand(this.lead_of(tick), tick) && this.retries_-- > 0) {
      clearTimeout(this.retry_timer_);
      this.retry_timer_ = setTimeout(() => this.show(), kRetryMs);
    } else if (!this.playing && this.drawn_) {
      this.clock_ = this.drawn_.stamp;
    }
  }

  private draw(frames: Frame[]): void {
    const { past_: scene, drawn_: before } = this;
    const last = frames.at(-1);
    if (!scene || !last) return;
    const goes_on = before !== null && before.tick <= last.tick && before.tick >= frames[0].tick;
    const newer = goes_on ? frames.filter((f) => f.tick > before.tick) : frames;
    if (!goes_on) forget_instant(scene);
    if (newer.length > 0) this.fold(scene, newer, last);
    this.show_filtered(scene);
    this.events_.changed();
  }

  private fold(scene: SceneState, frames: Frame[], last: Frame): void {
    this.place_world(scene, last.tick);
    for (const frame of frames) {
      learn_layers(scene.known, frame.layers);
      show_frame(scene, frame);
    }
    this.drawn_ = last;
    if (!this.playing && last.tick === this.wanted_) this.clock_ = last.stamp;
    this.place_row(scene);
  }

  private place_row(scene: SceneState): void {
    scene.rows = scene.columns.row_at(this.drawn_?.stamp ?? this.clock_) + 1;
  }

  /** Shows the filtered scan of the newest scan up to the shown tick. Of several scanners one is filtered. */
  private show_filtered(scene: SceneState): void {
    scene.filtered.shown = null;
    const shown = this.drawn_;
    if (!this.wants_filtered_ || !shown || !this.pages_) return;
    const scans = this.pages_.known(this.lead_of(shown.tick), shown.tick).filter((f) => f.sweeps.length > 0).slice(-8);
    const missing = scans.find((f) => !this.filtered_.has(f.tick));
    if (missing) {
      clearTimeout(this.rest_timer_);
      this.rest_timer_ = setTimeout(() => void this.fetch_filtered(missing.tick), this.playing ? 0 : kRestMs);
    }
    for (const frame of scans.reverse()) {
      const sweep = decode_sweep(this.filtered_.get(frame.tick) ?? new Uint8Array(0));
      if (!sweep) continue;
      scene.filtered.shown = placed(sweep, frame.pose);
      return;
    }
  }

  private async fetch_filtered(from: number): Promise<void> {
    const { pages_: pages, live_: { run } } = this;
    if (!pages || run === null || this.filtering_) return;
    this.filtering_ = true;
    const ticks = pages.known(from, from + kFilteredAtOnce - 1).map((f) => f.tick);
    const messages = await fetch_all(this.source_.filtered(run), from, ticks.length).catch(() => []);
    this.filtering_ = false;
    if (this.pages_ !== pages || !this.past_ || messages.length === 0) return; // the rest is shown without it
    if (this.filtered_.size > kMostFiltered) this.filtered_.clear();
    ticks.forEach((tick, i) => this.filtered_.set(tick, messages[i] ?? new Uint8Array(0)));
    this.show_filtered(this.past_);
    this.events_.changed();
  }

  /** The world at the start, and the gaps of the record so far. */
  private async fetch_row(run: number): Promise<void> {
    if (performance.now() - this.row_at_ < kRowMs) return;
    this.row_at_ = performance.now();
    const row = await this.source_.row(run).catch(() => null); // without it every gap is entered at its edge
    if (!row || run !== this.live_.run) return;
    this.row_ = row;
    this.edits_.begin(initial_obstacles(row), row.parameters ?? {});
    const wanted = this.wanted_;
    if (wanted !== null && this.allowed(wanted) !== wanted) {
      this.wanted_ = null; // as if it was sought just now
      this.go(wanted);
    } else {
      this.show_world();
    }
  }

  /** Shows the world again, once its start or an earlier edit is known. */
  show_world(): void {
    if (!this.past_ || !this.drawn_) return;
    this.place_world(this.past_, this.drawn_.tick);
    show_frame(this.past_, this.drawn_);
    this.events_.changed();
  }

  private place_world(scene: SceneState, tick: number): void {
    scene.obstacles = this.edits_.obstacles_at(tick, this.live_.obstacles);
    take_parameters(scene, this.edits_.parameters_at(tick, this.session_()?.parameters ?? {}));
  }

  private lead_of(tick: number): number {
    return Math.max(0, Math.min(tick, this.tick_at(this.time_at(tick) - kLead)));
  }
  private tick_at(t: number): number {
    return Math.floor(interpolated(this.live_.columns, "t", "tick", t) + 1e-3);
  }
  private time_at(tick: number): number {
    return interpolated(this.live_.columns, "tick", "t", tick);
  }
}

