// web/src/stopper.ts: sends a press of Stop by every way, again and again, until the server has
// answered. Without an answer within half a second Stop has failed, and the page raises an alarm.

export const kAnswerTime = 500; // [ms]

type StopPhase = "none" | "sent" | "failed";
export interface StopState {
  phase: StopPhase;
  since: number; // [ms] of the press, by performance.now()
}

/** Sends a Stop; rejects when it did not get through. */
type StopWay = () => Promise<unknown>;

export class Stopper {
  private press_ = 0; // counts presses, so that answers to an old one have no effect
  private timer_: ReturnType<typeof setTimeout> | undefined;
  private state_: StopState = { phase: "none", since: 0 };

  /** The first way is used at once, all of them once it has not answered in time. */
  constructor(private readonly ways_: StopWay[], private readonly changed_: (state: StopState) => void,
    private readonly now_: () => number = () => performance.now()) {}

  press(): void {
    const press = ++this.press_;
    clearTimeout(this.timer_);
    // Another press after a failure keeps the time of the first one.
    const since = this.state_.phase === "failed" ? this.state_.since : this.now_();
    if (this.state_.phase !== "failed") this.tell({ phase: "sent", since });
    this.send(press, this.ways_.slice(0, 1), since);
  }

  /** After a release, or once the person has seen the failure: sends nothing any more. */
  forget(): void {
    ++this.press_;
    clearTimeout(this.timer_);
    this.tell({ phase: "none", since: 0 });
  }

  private send(press: number, ways: StopWay[], since: number): void {
    const mine = () => press === this.press_;
    let left = ways.length;
    for (const way of ways) {
      way().then(() => mine() && this.forget(), () => {
        // Refused: tries the other ways without waiting.
        if (--left === 0 && mine() && ways.length < this.ways_.length) this.send(press, this.ways_, since);
        else if (left === 0 && mine()) this.tell({ phase: "failed", since });
      });
    }
    clearTimeout(this.timer_);
    this.timer_ = setTimeout(() => {
      if (!mine()) return;
      this.tell({ phase: "failed", since });
      this.send(press, this.ways_, since);
    }, kAnswerTime);
  }

  private tell(state: StopState): void {
    const same = state.phase === this.state_.phase && state.since === this.state_.since;
    this.state_ = state;
    if (!same) this.changed_(state);
  }
}

/** Two tones, for people who look at the robot. Silent if the browser allows no sound. */
export function sound_alarm(): void {
  try {
    const context = new AudioContext();
    const gain = context.createGain();
    gain.gain.value = 0.25;
    gain.connect(context.destination);
    [0, 0.25, 0.5].forEach((at, i) => {
      const tone = context.createOscillator();
      tone.frequency.value = i % 2 === 0 ? 880 : 660;
      tone.connect(gain);
      tone.start(context.currentTime + at);
      tone.stop(context.currentTime + at + 0.2);
    });
    setTimeout(() => void context.close(), 1000);
  } catch {
    // the alarm is then only seen
  }
}
