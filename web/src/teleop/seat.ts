// web/src/teleop/seat.ts: the operator's seat: one stick made of the drawn one, keys and a gamepad. It says what to
// send, and never goes on by itself: after a loss, every source must come back to the middle first.

/** As the server takes it: ahead and left are positive, each in [-1, 1] of what full stick asks for. */
export interface Stick { forward: number; turn: number }

export const kSendEvery = 50; // [ms] the server's watchdog waits 500
const kDeadZone = 0.12;       // of an axis of a gamepad
const kExpo = 0.35;           // share of the cube: fine near the middle
const kZeros = 3;             // sent after letting go, so that one that is lost does not matter

const kKeys: Record<string, Stick> = {
  KeyW: { forward: 1, turn: 0 }, ArrowUp: { forward: 1, turn: 0 },
  KeyS: { forward: -1, turn: 0 }, ArrowDown: { forward: -1, turn: 0 },
  KeyA: { forward: 0, turn: 1 }, ArrowLeft: { forward: 0, turn: 1 },
  KeyD: { forward: 0, turn: -1 }, ArrowRight: { forward: 0, turn: -1 },
};
// Of the standard mapping.
const kButtonB = 1, kBumpers = [4, 5], kBackTrigger = 6, kAheadTrigger = 7;

/** The parts of a Gamepad that count. */
export interface Pad {
  mapping: string;
  axes: readonly number[];
  buttons: readonly { pressed: boolean; value: number }[];
}

/** What a pad asks for. `stop`: B is pressed. `stick` is null unless a bumper is held. */
export interface PadWish { stick: Stick | null; stop: boolean; strange: boolean }

/** Left stick: ahead; right stick: turn; triggers: ahead and back. Browsers count axes down and right: negated here. */
export function read_pad(pad: Pad | null): PadWish {
  if (!pad) return { stick: null, stop: false, strange: false };
  if (pad.mapping !== "standard") return { stick: null, stop: false, strange: true };
  const stop = pad.buttons[kButtonB]?.pressed ?? false;
  if (!kBumpers.some((b) => pad.buttons[b]?.pressed)) return { stick: null, stop, strange: false };
  const trigger = (b: number) => pad.buttons[b]?.value ?? 0;
  const forward = clamped(-curved(pad.axes[1] ?? 0) + trigger(kAheadTrigger) - trigger(kBackTrigger));
  return { stick: { forward: forward + 0, turn: -curved(pad.axes[2] ?? 0) + 0 }, stop, strange: false };
}

/** Without the dead zone, and finer near the middle. */
export function curved(axis: number): number {
  if (!Number.isFinite(axis)) return 0;
  const beyond = Math.max(0, Math.min(1, Math.abs(axis)) - kDeadZone) / (1 - kDeadZone);
  return Math.sign(axis) * ((1 - kExpo) * beyond + kExpo * beyond ** 3);
}

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
