// web/src/link/stored.ts: a stored run as a source of frames: fetched page by page, kept within a
// bound, seekable and playable at any speed. It fills the same SceneState as the live link.
import { RunItem } from "../contract";
import { obstacle_from_json } from "../obstacle";
import { Obstacle } from "../obstacle";
import { EventLog } from "../state/events";
import { Columns } from "../state/columns";
import {
  SceneState, edited, new_scene, place_sweeps, show_frame, take_parameters,
} from "../state/scene";
import { Frame, GridLayer, decode_frame } from "./frame";

export type FetchFrames = (from: number, limit: number, signal?: AbortSignal) =>
  Promise<{ bytes: Uint8Array; next: number | null }>;

interface Chunk { from_tick: number; first_row: number; frames: Uint8Array[] | null; used: number }

export const kPageFrames = 400;
const kMostChunks = 60;      // about 24 000 frames, some 40 MB
const kScanLookBack = 60;    // frames; the newest sweep lies within them
const kGridLookBack = 200;   // frames; the newest grid of a controller that keeps one does

/** Splits an answer of /frames: each frame is a u32 length and its bytes. */
export function split_frames(bytes: Uint8Array): Uint8Array[] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const out: Uint8Array[] = [];
  let at = 0;
  while (at + 4 <= bytes.length) {
    const length = view.getUint32(at, true);
    if (at + 4 + length > bytes.length) {
      throw new Error(`a frame of ${length} bytes at byte ${at} runs past the end of the answer`);
    }
    // A copy each, so that a page of frames can be forgotten frame by frame.
    out.push(bytes.slice(at + 4, at + 4 + length));
    at += 4 + length;
  }
  if (at !== bytes.length) throw new Error(`${bytes.length - at} stray bytes after the last frame`);
  return out;
}

export class StoredRun {
  readonly columns = new Columns();
  readonly events = new EventLog();
  readonly scene: SceneState;
  done = false;
  error: string | null = null;
  private chunks_: Chunk[] = [];
  private worlds_: { row: number; obstacles: Obstacle[] }[] = [];
  private parameters_: { row: number; name: string; value: number }[] = [];
  private clock_ = 0;
  private wanted_ = -1;
  private has_grid_ = false;

  constructor(
    readonly item: RunItem,
    private readonly fetch_: FetchFrames,
  ) {
    const doc = item.document?.scenario;
    const robot = item.document?.robot;
    this.scene = new_scene();
    this.scene.columns = this.columns;
    this.scene.events = this.events;
    this.scene.run = item.id;
    this.scene.radius = robot?.radius ?? this.scene.radius;
    this.scene.half_track = robot?.half_track ?? this.scene.half_track;
    this.scene.filter = item.filter;
    this.scene.start = doc?.start ?? null;
    this.scene.world = item.vehicle !== "log";
    this.scene.goal = doc?.goal
      ? { x: doc.goal.x, y: doc.goal.y, heading: doc.goal.heading ?? null } : null;
    this.scene.obstacles = (doc?.obstacles ?? []).map(numbered);
    take_parameters(this.scene, item.parameters ?? {});
    this.worlds_.push({ row: -1, obstacles: this.scene.obstacles });
  }

  get rows(): number {
    return this.columns.length;
  }
  /** [s] run clock of the last frame. */
  get duration(): number {
    return this.rows === 0 ? 0 : this.columns.at("t", this.rows - 1);
  }
  /** 0..1 of the run that has been fetched. */
  get progress(): number {
    if (this.done) return 1;
    return this.item.ticks > 0 ? Math.min(1, this.rows / this.item.ticks) : 0;
  }

  /**
   * Fetches the run once, front to back, reading off columns, events and edits. Of a run that is
   * still being recorded: what was there when it was opened, or it would never be through.
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
      this.error = error instanceof Error ? error.message : String(error);
    }
    on_progress();
  }

  /**
   * Shows row `row` in `scene`. Returns false when its frame has to be fetched first; `ready` is
   * then called when it is there and still the one wanted.
   */
  seek(row: number, ready: () => void = () => undefined): boolean {
    if (this.rows === 0) return false;
    const at = Math.max(0, Math.min(this.rows - 1, row));
    this.wanted_ = at;
    const frame = this.frame(at);
    if (!frame) {
      void this.fetch_chunk(this.chunk_of(at)).then(() => {
        if (this.wanted_ === at && this.seek(at)) ready();
      });
      return false;
    }
    this.scene.obstacles = this.world_at(at);
    this.set_parameters_at(at);
    show_frame(this.scene, frame);
    for (let back = 1; frame.sweeps.length === 0 && back < kScanLookBack; ++back) {
      const earlier = this.frame(at - back);
      if (!earlier) break;
      if (earlier.sweeps.length === 0) continue;
      place_sweeps(this.scene, earlier);
      break;
    }
    if (this.has_grid_) this.scene.grid = this.grid_at(at);
    this.scene.rows = at + 1;
    return true;
  }

  /** Grids are sent seldom: the newest up to row `at`. */
  private grid_at(at: number): GridLayer | null {
    for (let back = 0; back < kGridLookBack; ++back) {
      const grid = this.frame(at - back)?.grid;
      if (grid) return grid;
    }
    return null;
  }

  private take(from_tick: number, frames: Uint8Array[]): void {
    const first_row = this.rows;
    this.chunks_.push({ from_tick, first_row, frames, used: ++this.clock_ });
    for (const bytes of frames) {
      const f = decode_frame(bytes);
      const row = this.rows;
      this.columns.push(f);
      this.events.push(f);
      this.has_grid_ ||= f.grid !== null;
      for (const request of f.requests) {
        const before = this.worlds_.at(-1)!.obstacles;
        const after = edited(before, request);
        if (after !== before) this.worlds_.push({ row, obstacles: after });
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
    return bytes ? decode_frame(bytes) : null;
  }

  private chunk_of(row: number): Chunk {
    let found = this.chunks_[0];
    for (const chunk of this.chunks_) {
      if (chunk.first_row > row) break;
      found = chunk;
    }
    return found;
  }

  private async fetch_chunk(chunk: Chunk): Promise<void> {
    try {
      const page = await this.fetch_(chunk.from_tick, kPageFrames);
      chunk.frames = split_frames(page.bytes);
      chunk.used = ++this.clock_;
      this.trim();
    } catch (error) {
      this.error = error instanceof Error ? error.message : String(error);
    }
  }

  private trim(): void {
    const held = this.chunks_.filter((c) => c.frames !== null);
    if (held.length <= kMostChunks) return;
    held.sort((a, b) => a.used - b.used);
    for (const chunk of held.slice(0, held.length - kMostChunks)) chunk.frames = null;
  }

  private world_at(row: number): Obstacle[] {
    let found = this.worlds_[0].obstacles;
    for (const w of this.worlds_) if (w.row <= row) found = w.obstacles;
    return found;
  }

  private set_parameters_at(row: number): void {
    const now: Record<string, number> = { ...this.item.parameters };
    for (const p of this.parameters_) if (p.row <= row) now[p.name] = p.value;
    take_parameters(this.scene, now);
  }
}

/** Obstacles of a document may go without ids; they are then numbered in order from 1. */
function numbered(json: Parameters<typeof obstacle_from_json>[0], index: number): Obstacle {
  const o = obstacle_from_json(json);
  return o.id === 0 ? { ...o, id: index + 1 } : o;
}
