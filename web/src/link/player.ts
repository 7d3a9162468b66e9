// web/src/link/player.ts: plays a stored run: its clock runs, is dragged, or steps row by row.
import { StoredRun } from "./stored";

export class Player {
  playing = false;
  speed = 1; // times real time
  time = 0;  // [s] run clock
  private row_ = -1;

  constructor(readonly run: StoredRun, private readonly changed_: () => void) {}

  /** Moves on by `dt` [s] of wall time; returns whether another frame is shown now. */
  advance(dt: number): boolean {
    if (!this.playing) return false;
    const end = this.run.duration;
    this.time = Math.min(end, this.time + dt * this.speed);
    if (this.time >= end && this.run.done) {
      this.playing = false;
      this.changed_();
    }
    return this.show();
  }

  seek(t: number): void {
    this.time = Math.max(0, Math.min(this.run.duration, t));
    this.show();
    this.changed_();
  }

  /** `rows` on (or back, when negative), paused. */
  step(rows: number): void {
    this.playing = false;
    const at = Math.max(0, Math.min(this.run.rows - 1, this.run.columns.row_at(this.time) + rows));
    if (this.run.rows > 0) this.seek(this.run.columns.at("t", at));
  }

  /** Shows the row again, after the wanted parts of it have changed. */
  show_again(): void {
    if (this.row_ >= 0) this.run.seek(this.row_, this.changed_);
    this.changed_();
  }

  toggle(): void {
    if (!this.playing && this.run.done && this.time >= this.run.duration) this.time = 0;
    this.playing = !this.playing;
    this.changed_();
  }

  private show(): boolean {
    const row = this.run.columns.row_at(this.time);
    if (row === this.row_) return false;
    if (this.run.seek(row, this.changed_)) this.row_ = row;
    return true;
  }
}
