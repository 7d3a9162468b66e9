// web/src/state/meter.ts: how long drawing takes, and how often it is done: the last frames of the
// scene, from above or in 3D.

const kFrames = 120; // of the mean and the longest

export class Meter {
  private readonly times_ = new Float64Array(kFrames); // [ms]
  private readonly ends_ = new Float64Array(kFrames);  // [ms]
  private count_ = 0;

  /** A frame that took `ms` was ready at `now`. */
  take(ms: number, now: number): void {
    this.times_[this.count_ % kFrames] = ms;
    this.ends_[this.count_++ % kFrames] = now;
  }

  /** "1.9 ms, longest 4.2 ms, 38 a second"; null before the first frame. */
  words(now = performance.now()): string | null {
    const kept = Math.min(this.count_, kFrames);
    if (kept === 0) return null;
    const times = this.times_.subarray(0, kept);
    const mean = times.reduce((sum, t) => sum + t, 0) / kept;
    const rate = this.ends_.subarray(0, kept).filter((end) => now - end < 1000).length;
    return `${mean.toFixed(1)} ms, longest ${Math.max(...times).toFixed(1)} ms, ${rate} a second`;
  }

  /** Does `draw`, and takes its time. */
  around(draw: () => void): void {
    const begun = performance.now();
    draw();
    const now = performance.now();
    this.take(now - begun, now);
  }
}

/** Of the page's one scene. */
export const drawing = new Meter();
