// web/src/state/sweeps.ts: scans with the pose at which they were taken: raw ones, and the filtered
// scan that the server gave the controller.
import { Pose, compose } from "../geometry";
import { Frame, Sweep, kFree, kMaxRange } from "../link/frame";

/** A sweep and its pose. Its points are computed when it is first drawn. */
export interface PlacedSweep {
  sweep: Sweep;
  origin: Pose; // of the scanner in W
  points: SweepPoints | null;
}

/** Points in W; x, y alternate. `end`: the end of every beam; NaN without a reading. */
export interface SweepPoints { hits: Float32Array; end: Float32Array }

const same = (a: Pose, b: Pose): boolean => a.x === b.x && a.y === b.y && a.heading === b.heading;

export function placed(sweep: Sweep, robot: Pose): PlacedSweep {
  return { sweep, origin: compose(robot, sweep.mount), points: null };
}

/** The newest sweep of each scanner after `f`. */
export function newest_sweeps(before: PlacedSweep[], f: Frame): PlacedSweep[] {
  if (f.sweeps.length === 0) return before;
  // Each scanner delivers in its own phase, so the sweeps of the others stay.
  const others = before.filter((old) => old.sweep.stamp <= f.stamp &&
    !f.sweeps.some((sweep) => same(sweep.mount, old.sweep.mount)));
  return [...others, ...f.sweeps.map((sweep) => placed(sweep, f.pose))];
}

/** The ends of the beams, kept with the sweep. */
export function sweep_points(of: PlacedSweep): SweepPoints {
  if (of.points) return of.points;
  const { sweep, origin } = of;
  const hits: number[] = [];
  const end = new Float32Array(2 * sweep.ranges.length).fill(NaN);
  sweep.ranges.forEach((range, i) => {
    if (range > kMaxRange && range !== kFree) return; // a device code says nothing
    const bearing = origin.heading + sweep.angle_min + i * sweep.angle_increment;
    const r = range === kFree ? sweep.range_max : range / 1000;
    end[2 * i] = origin.x + r * Math.cos(bearing);
    end[2 * i + 1] = origin.y + r * Math.sin(bearing);
    if (range !== kFree) hits.push(end[2 * i], end[2 * i + 1]);
  });
  of.points = { hits: Float32Array.from(hits), end };
  return of.points;
}

const kRemembered = 32;

/**
 * The filtered scan of a live run. It comes on its own channel, before or after the frame of its
 * tick. The pose of the robot is in that frame, so the scan waits for the frame with its stamp.
 */
export class FilteredScan {
  shown: PlacedSweep | null = null;
  private waiting_: Sweep | null = null;
  private recent_: { stamp: number; robot: Pose }[] = [];

  clear(): void {
    this.shown = null;
    this.waiting_ = null;
    this.recent_ = [];
  }

  take(sweep: Sweep): void {
    this.waiting_ = sweep;
    this.join();
  }

  see(f: Frame): void {
    for (const { stamp } of f.sweeps) this.recent_.push({ stamp, robot: f.pose });
    this.recent_.splice(0, this.recent_.length - kRemembered);
    this.join();
  }

  private join(): void {
    const sweep = this.waiting_;
    const taken = sweep && this.recent_.find((r) => r.stamp === sweep.stamp);
    if (!taken) return;
    this.shown = placed(sweep, taken.robot);
    this.waiting_ = null;
  }
}
