// web/src/sign_of_life.ts: tells the server that somebody can see this page and press its Stop. The
// sign comes from the page's script and only after a frame was drawn: a frozen, hidden or closed tab,
// one that hears nothing, and one whose Stop is out of reach give none, and a real robot stops.

const kPeriod = 400; // [ms]; the server waits for 1.5 s

export interface SignEnvironment {
  visible(): boolean;
  /** Calls back before the next frame is drawn; not at all in a hidden tab. */
  next_frame(act: () => void): void;
  every(ms: number, act: () => void): void;
}

export class SignOfLife {
  private waiting_ = false;

  /** `stop_works` when Stop can be pressed and the server would hear of it. */
  constructor(private readonly env_: SignEnvironment, private readonly stop_works_: () => boolean,
    private readonly give_: () => void) {}

  start(): void {
    this.env_.every(kPeriod, () => this.look());
  }

  /** Two frames: that the second is begun proves that the first was drawn. */
  private look(): void {
    if (this.waiting_ || !this.able()) return;
    this.waiting_ = true;
    this.env_.next_frame(() => this.env_.next_frame(() => {
      this.waiting_ = false;
      if (this.able()) this.give_();
    }));
  }

  private able(): boolean {
    return this.env_.visible() && this.stop_works_();
  }
}

export const browser: SignEnvironment = {
  visible: () => document.visibilityState === "visible",
  next_frame: (act) => void requestAnimationFrame(act),
  every: (ms, act) => void setInterval(act, ms),
};

/** Whether a press on the middle of the Stop button would reach it: enabled, shown, not covered. */
export function stop_in_reach(): boolean {
  const button = document.querySelector<HTMLButtonElement>("button.stop");
  if (!button || button.disabled) return false;
  const box = button.getBoundingClientRect();
  const hit = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
  return hit !== null && button.contains(hit);
}
