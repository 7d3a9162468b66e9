// web/src/link/clock.ts: the server's clock as this page knows it, and how long the way there and back takes.

const kKept = 20;   // samples: ten seconds of them
const kMedianOf = 5;

interface Sample { offset: number; round_trip: number }

/** All times in seconds. The sample with the shortest way tells the clocks' difference best: it waited least. */
export class ServerClock {
  private samples_: Sample[] = [];

  /** The server read `server` on its clock between `sent` and `received` on ours. */
  take(sent: number, received: number, server: number): void {
    const round_trip = received - sent;
    if (!(round_trip >= 0) || !Number.isFinite(server)) return;
    this.samples_.push({ offset: server - (sent + received) / 2, round_trip });
    if (this.samples_.length > kKept) this.samples_.shift();
  }

  /** After a reconnection: it may be another server. */
  clear(): void {
    this.samples_ = [];
  }

  /** What the server's clock shows when ours shows `now`; null before the first answer. */
  server_time(now: number): number | null {
    if (this.samples_.length === 0) return null;
    return now + this.samples_.reduce((best, s) => (s.round_trip < best.round_trip ? s : best)).offset;
  }

  /** The usual one of the last few; null before the first answer. */
  get round_trip(): number | null {
    if (this.samples_.length === 0) return null;
    const last = this.samples_.slice(-kMedianOf).map((s) => s.round_trip).sort((a, b) => a - b);
    return last[Math.floor(last.length / 2)];
  }
}
