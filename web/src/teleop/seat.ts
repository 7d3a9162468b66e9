// web/src/teleop/seat.ts: the operator's seat: one stick made of the drawn one, keys and a gamepad. It says what to
// send, and never goes on by itself: after a loss, every source must come back to the middle first.

/** As the server takes it: ahead and left are positive, each in [-1, 1] of what full stick asks for. */
export interface Stick { forward: number; turn: number }

export const kSendEvery = 50; // [ms] the server's watchdog waits 500
const kZeros = 3;             // sent after letting go, so that one that is lost does not matter

const kKeys: Record<string, Stick> = {
  KeyW: { forward: 1, turn: 0 }, ArrowUp: { forward: 1, turn: 0 },
  KeyS: { forward: -1, turn: 0 }, ArrowDown: { forward: -1, turn: 0 },
  KeyA: { forward: 0, turn: 1 }, ArrowLeft: { forward: 0, turn: 1 },
  KeyD: { forward: 0, turn: -1 }, ArrowRight: { forward: 0, turn: -1 },
};

function clamped(value: number): number {
  return Math.max(-1, Math.min(1, value));
}

export class Seat {
  private readonly keys_ = new Set<string>();
  private drawn_: Stick | null = null;
  private pad_: Stick | null = null;
  private barred_ = false; // until the middle
  private zeros_ = 0;      // still to send

  /** Whether the key is one of the seat's. A repeat presses nothing: after a loss it would go on by itself. */
  key(code: string, down: boolean, repeat = false): boolean {
    if (!Object.hasOwn(kKeys, code)) return false;
    if (repeat) return true;
    if (down) this.keys_.add(code);
    else this.keys_.delete(code);
    return true;
  }
  /** The drawn stick; null: nobody holds it. */
  draw(stick: Stick | null): void {
    this.drawn_ = stick && { forward: clamped(stick.forward), turn: clamped(stick.turn) };
  }
  pad(stick: Stick | null): void {
    this.pad_ = stick;
  }
  /** The hand is gone, or nobody can know: nothing moves until all sources have been in the middle. A key's release
   * may never be heard, so held keys are forgotten. */
  drop(): void {
    this.barred_ = true;
    this.keys_.clear();
    this.drawn_ = null;
  }
  get barred(): boolean {
    return this.barred_ && !this.centred;
  }

  /** What the hand wants now, whether it is sent or not. */
  get wish(): Stick {
    if (this.drawn_) return this.drawn_;
    if (this.keys_.size > 0) {
      const sum = { forward: 0, turn: 0 };
      for (const code of this.keys_) {
        sum.forward += kKeys[code].forward;
        sum.turn += kKeys[code].turn;
      }
      return { forward: clamped(sum.forward), turn: clamped(sum.turn) };
    }
    return this.pad_ ?? { forward: 0, turn: 0 };
  }
  private get centred(): boolean {
    return this.wish.forward === 0 && this.wish.turn === 0;
  }
  /** Whether nobody holds a stick or a key here. */
  get idle(): boolean {
    return !this.drawn_ && this.keys_.size === 0 && !this.pad_;
  }
  /** Whether the hand moves the robot, so that it may be pushed back. */
  get drives(): boolean {
    return !this.barred_ && !this.centred;
  }

  /** The stick to send now; null: none. */
  next(): Stick | null {
    if (this.centred) {
      this.barred_ = false;
      if (this.zeros_ === 0) return null;
      --this.zeros_;
      return { forward: 0, turn: 0 };
    }
    if (this.barred_) return null;
    this.zeros_ = kZeros;
    return this.wish;
  }
}
