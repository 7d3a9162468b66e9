// web/src/link/stored.ts: a stored run as a source of frames: fetched page by page, kept within a
// bound, seekable and playable at any speed. It fills the same SceneState as the live link.
import { RunItem } from "../contract";
import { Obstacle, ObstacleJson, obstacle_from_json } from "../obstacle";
import { EventLog } from "../state/events";
import { Columns, last_not_after } from "../state/columns";
import { Route, first_route, rerouted, route_at } from "../state/goals";
import { learn_layers } from "../state/layers";
import {
  SceneState, edited, forget_instant, held_of, hold_time, new_scene, show_frame, take_parameters,
  take_robot,
} from "../state/scene";
import { placed } from "../state/sweeps";
import { sentence_of } from "../words";
import { Frame, decode_frame, decode_frames, decode_sweep } from "./frame";
import { Legends } from "./legend";
import * as rest from "./rest";

export type FetchFrames = (from: number, limit: number, signal?: AbortSignal) =>
  Promise<{ bytes: Uint8Array; next: number | null }>;

/** The frames of run `id`, those of them in which something happens, or a message for each: its filtered
 * scan, empty without a new one. */
export function stored_frames(id: number, what: "frames" | "filtered" | "events"): FetchFrames {
  return (from, limit, signal) => rest.get_bytes(`/runs/${id}/${what}?from=${from}&limit=${limit}`, signal);
}

/** A page of frames, and their filtered scans once they are wanted. */
interface Chunk {
  from_tick: number; first_row: number; count: number; frames: Uint8Array[] | null; filtered: Uint8Array[] | null;
  used: number;
}

export const kPageFrames = 400;
const kMostChunks = 60;      // about 24 000 frames, some 40 MB

/** Splits an answer of /frames or /filtered: each message is a u32 length and its bytes. */
export function split_frames(bytes: Uint8Array): Uint8Array[] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const out: Uint8Array[] = [];
  let at = 0;
  while (at + 4 <= bytes.length) {
    const length = view.getUint32(at, true);
    if (at + 4 + length > bytes.length) {
      throw new Error(`a frame of ${length} bytes at byte ${at} runs past the end of the answer`);
    }
    // Copies, so that one kept frame does not keep its whole page.
    out.push(bytes.slice(at + 4, at + 4 + length));
    at += 4 + length;
  }
  if (at !== bytes.length) throw new Error(`${bytes.length - at} stray bytes after the last frame`);
  return out;
}

export class StoredRun {
  readonly columns = new Columns();
  readonly events = new EventLog(true);
  readonly scene: SceneState;
  done = false;
  error: string | null = null;
  private chunks_: Chunk[] = [];
  private worlds_: { row: number; obstacles: Obstacle[] }[] = [];
  private routes_: { row: number; route: Route }[] = [];
  private parameters_: { row: number; name: string; value: number }[] = [];
  private legends_ = new Legends();
  private clock_ = 0;
  private wanted_ = -1;
  private held_ = new Map<string, number[]>(); // rows with values that hold in later rows, by name
  private wants_filtered_ = false;
  private filtering_ = new Set<Chunk>(); // whose filtered scans were asked for

  constructor(
    readonly item: RunItem,
    private readonly fetch_: FetchFrames,
    private readonly fetch_filtered_: FetchFrames,
  ) {
    const doc = item.document?.scenario;
    this.scene = new_scene();
    this.scene.columns = this.columns;
    this.scene.events = this.events;
    this.scene.run = item.id;
    this.scene.controller = item.controller;
    take_robot(this.scene, item.document?.robot);
    this.scene.start = doc?.start ?? null;
    this.scene.world = item.physics !== "log";
    this.scene.drives = this.scene.world;
    this.scene.route = first_route(doc);
    this.scene.goal = this.scene.route.goals[0] ?? null;
    this.scene.obstacles = initial_obstacles(item);
    take_parameters(this.scene, item.parameters ?? {});
    this.worlds_.push({ row: -1, obstacles: this.scene.obstacles });
    this.routes_.push({ row: -1, route: this.scene.route });
  }

  get rows(): number {
    return this.columns.length;
  }
  /** [s] run clock of the last frame. */
  get duration(): number {
    return this.rows === 0 ? 0 : this.columns.at("t", this.rows - 1);
  }
  /** [s] Run clock of the first scan that has been fetched; 0 without one. */
  get opening(): number {
    const rows = [...this.held_].filter(([name]) => name.startsWith("scan ")).map(([, bringing]) => bringing[0]);
    return rows.length > 0 ? this.columns.at("t", Math.min(...rows)) : 0;
  }
  /** Whether somebody drove by hand, as far as it has been fetched. */
  get driven(): boolean {
    return this.held_.has("stick");
  }
  /** 0..1 of the run that has been fetched. */
  get progress(): number {
    if (this.done) return 1;
    return this.item.ticks > 0 ? Math.min(1, this.rows / this.item.ticks) : 0;
  }

  /**
   * Fetches the run once from front to back, and reads columns, events and edits. Of a run that is
   * still recorded it fetches the ticks up to the opening; otherwise it would never end.
   */
  async load(on_progress: () => void, signal?: AbortSignal): Promise<void> {
    let from: number | null = 0;
    const growing = ["queued", "recording"].includes(this.item.status) && this.item.ticks > 0;
    const end = growing ? this.item.ticks : Infinity;
    try {
      while (from !== null && !signal?.aborted) {
        const page: { bytes: Uint8Array; next: number | null } =
          await this.fetch_(from, kPageFrames, signal);
        this.take(from, split_frames(page.bytes));
        from = page.next !== null && page.next > from && page.next < end ? page.next : null;
        on_progress();
      }
      this.done = from === null;
    } catch (error) {
      if (signal?.aborted) return;
      this.error = sentence_of(error);
    }
    on_progress();
  }

  /**
   * Shows `row` in `scene`. Returns false if a frame must be fetched first: then `ready` is called
   * once it is shown, unless another row was sought; and again for its filtered scan.
   */
  seek(row: number, ready: () => void = () => undefined): boolean {
    if (this.rows === 0) return false;
    const at = Math.max(0, Math.min(this.rows - 1, row));
    this.wanted_ = at;
    const frames: Frame[] = [];
    for (const needed of this.rows_for(at)) {
      const frame = this.frame(needed);
      if (!frame) {
        void this.fetch_chunk(this.chunk_of(needed)).then((there) => {
          if (there && this.wanted_ === at && this.seek(at, ready)) ready();
        });
        return false;
      }
      frames.push(frame);
    }
    forget_instant(this.scene);
    this.scene.obstacles = this.world_at(at);
    this.set_parameters_at(at);
    for (const frame of frames) show_frame(this.scene, frame);
    this.scene.route = route_at(this.route_of(at), frames.at(-1)!);
    this.scene.rows = at + 1;
    this.show_filtered(at, ready);
    return true;
  }

  /** Switches filtered scans on or off, from the next seek on. */
  want_filtered(wanted: boolean): void {
    this.wants_filtered_ = wanted;
  }

  /** Row `at` and the rows before it whose values still hold, ascending. */
  private rows_for(at: number): number[] {
    const rows = new Set([at]);
    const t = (row: number) => this.columns.at("t", row);
    for (const [name, bringing] of this.held_) {
      const newest = bringing[last_not_after(bringing, at)];
      if (newest !== undefined && t(at) - t(newest) <= hold_time(name)) rows.add(newest);
    }
    return [...rows].sort((a, b) => a - b);
  }

  /** Shows the filtered scan of the newest row up to `at` with a new scan. */
  private show_filtered(at: number, ready: () => void): void {
    this.scene.filtered.clear();
    if (!this.wants_filtered_) return;
    const newest: number[] = []; // of each scanner; only one is filtered
    for (const [name, bringing] of this.held_) {
      const last = last_not_after(bringing, at);
      if (name.startsWith("scan ") && last >= 0) newest.push(bringing[last]);
    }
    for (const row of newest.sort((a, b) => b - a)) {
      const chunk = this.chunk_of(row);
      if (!chunk.filtered) {
        void this.fetch_filtered(chunk).then((there) => {
          if (!there || this.wanted_ !== at) return;
          this.show_filtered(at, ready);
          ready();
        });
        return;
      }
      const sweep = decode_sweep(chunk.filtered[row - chunk.first_row] ?? new Uint8Array(0));
      const frame = sweep && this.frame(row);
      if (!frame) continue;
      this.scene.filtered.shown = placed(sweep, frame.pose);
      return;
    }
  }

  private take(from_tick: number, frames: Uint8Array[]): void {
    const first_row = this.rows;
    const count = frames.length;
    this.chunks_.push({ from_tick, first_row, count, frames, filtered: null, used: ++this.clock_ });
    for (const f of decode_frames(frames, this.legends_)) {
      const row = this.rows;
      this.columns.push(f);
      this.events.push(f);
      learn_layers(this.scene.known, f.layers);
      for (const name of held_of(f)) {
        const rows = this.held_.get(name);
        if (rows) rows.push(row);
        else this.held_.set(name, [row]);
      }
      for (const request of f.requests) {
        const before = this.worlds_.at(-1)!.obstacles;
        const after = edited(before, request);
        if (after !== before) this.worlds_.push({ row, obstacles: after });
        const way = this.routes_.at(-1)!.route;
        const route = rerouted(way, request);
        if (route !== way) this.routes_.push({ row, route });
        if (request.type === "set_parameter") {
          this.parameters_.push({ row, name: request.name, value: request.value });
        }
      }
    }
    this.trim();
  }

  private frame(row: number): Frame | null {
    if (row < 0 || row >= this.rows) return null;
    const chunk = this.chunk_of(row);
    chunk.used = ++this.clock_;
    const bytes = chunk.frames?.[row - chunk.first_row];
    return bytes ? decode_frame(bytes, this.legends_) : null;
  }

  private chunk_of(row: number): Chunk {
    return this.chunks_[last_not_after(this.chunks_.map((c) => c.first_row), row)];
  }

  private async fetch_chunk(chunk: Chunk): Promise<boolean> {
    try {
      chunk.frames = await fetch_all(this.fetch_, chunk.from_tick, chunk.count);
      chunk.used = ++this.clock_;
      this.trim();
      return true;
    } catch (error) {
      this.error = sentence_of(error);
      return false;
    }
  }

  /** Sends one request at a time for a page, and none after a failure. */
  private async fetch_filtered(chunk: Chunk): Promise<boolean> {
    if (this.filtering_.has(chunk)) return false;
    this.filtering_.add(chunk);
    try {
      chunk.filtered = await fetch_all(this.fetch_filtered_, chunk.from_tick, chunk.count);
      this.filtering_.delete(chunk);
      return true;
    } catch {
      return false; // the rest of the instant is shown without it
    }
  }

  private trim(): void {
    const held = this.chunks_.filter((c) => c.frames !== null);
    if (held.length <= kMostChunks) return;
    held.sort((a, b) => a.used - b.used);
    for (const chunk of held.slice(0, held.length - kMostChunks)) chunk.frames = chunk.filtered = null;
  }

  private world_at(row: number): Obstacle[] {
    return this.worlds_[last_not_after(this.worlds_.map((w) => w.row), row)].obstacles;
  }
  private route_of(row: number): Route {
    return this.routes_[last_not_after(this.routes_.map((r) => r.row), row)].route;
  }

  private set_parameters_at(row: number): void {
    const now: Record<string, number> = { ...this.item.parameters };
    for (const p of this.parameters_) if (p.row <= row) now[p.name] = p.value;
    take_parameters(this.scene, now);
  }
}

/** Up to `count` messages from tick `first`. A page may hold fewer messages than asked for. */
export async function fetch_all(fetch: FetchFrames, first: number,
  count: number): Promise<Uint8Array[]> {
  const out: Uint8Array[] = [];
  for (let from: number | null = first; from !== null && out.length < count;) {
    const page: { bytes: Uint8Array; next: number | null } = await fetch(from, count - out.length);
    out.push(...split_frames(page.bytes));
    from = page.next;
  }
  return out;
}

/** The world with which the run began. */
export function initial_obstacles({ document }: RunItem): Obstacle[] {
  const own = (document?.scenario.obstacles ?? []).map(numbered);
  return [...own, ...(document?.others ?? []).map(obstacle_from_json)];
}

/** Obstacles of a document may have no ids; then their order from 1 is their id. */
function numbered(json: ObstacleJson, index: number): Obstacle {
  const o = obstacle_from_json(json);
  return o.id === 0 ? { ...o, id: index + 1 } : o;
}
