// web/src/state/edits.ts: the edits of a live run by tick, and with them the world and the parameters
// of an earlier tick.
import { Frame, FrameRequest } from "../link/frame";
import { Obstacle } from "../obstacle";
import { edited } from "./scene";

type Parameters = Record<string, number>;

export class RunEdits {
  private by_tick_ = new Map<number, FrameRequest[]>();
  private ordered_: [number, FrameRequest[]][] | null = null; // ascending; null: to be sorted again
  private start_: { obstacles: Obstacle[]; parameters: Parameters } = { obstacles: [], parameters: {} };

  clear(): void {
    this.by_tick_.clear();
    this.ordered_ = null;
    this.start_ = { obstacles: [], parameters: {} };
  }

  /** The world and the parameters with which the run began. */
  begin(obstacles: Obstacle[], parameters: Parameters): void {
    this.start_ = { obstacles, parameters };
  }

  /** Keeps the edits of `f`, in any order of ticks; a tick counts once. */
  take(f: Pick<Frame, "tick" | "requests">): void {
    if (f.requests.length === 0 || this.by_tick_.has(f.tick)) return;
    this.by_tick_.set(f.tick, f.requests);
    this.ordered_ = null;
  }

  /**
   * The obstacles at `tick`, where those of the newest tick are `now`. An obstacle that no later edit
   * touches stands where it stands now. So the edits before the oldest known one are not needed.
   */
  obstacles_at(tick: number, now: Obstacle[]): Obstacle[] {
    const later = this.after(tick);
    const touched = new Set(later.map(touched_by));
    if (!later.some((r) => touched_by(r) !== null)) return now;
    const then = this.until(tick).reduce(edited, this.start_.obstacles);
    return [...now.filter((o) => !touched.has(o.id)), ...then.filter((o) => touched.has(o.id))];
  }

  /** The parameters at `tick`, in the same way. */
  parameters_at(tick: number, now: Parameters): Parameters {
    const later = this.after(tick).filter((r) => r.type === "set_parameter");
    if (later.length === 0) return now;
    const then = { ...this.start_.parameters };
    for (const r of this.until(tick)) if (r.type === "set_parameter") then[r.name] = r.value;
    const back = later.filter(({ name }) => name in then).map(({ name }) => [name, then[name]]);
    return { ...now, ...Object.fromEntries(back) };
  }

  private until(tick: number): FrameRequest[] {
    return this.ordered().filter(([t]) => t <= tick).flatMap(([, requests]) => requests);
  }
  private after(tick: number): FrameRequest[] {
    return this.ordered().filter(([t]) => t > tick).flatMap(([, requests]) => requests);
  }
  private ordered(): [number, FrameRequest[]][] {
    return (this.ordered_ ??= [...this.by_tick_].sort((a, b) => a[0] - b[0]));
  }
}

/** The id of the obstacle that `r` adds, changes or removes. */
function touched_by(r: FrameRequest): number | null {
  if (r.type === "add_obstacle" || r.type === "change_obstacle") return r.obstacle.id;
  return r.type === "move_obstacle" || r.type === "remove_obstacle" ? r.id : null;
}
