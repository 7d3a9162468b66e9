// web/src/teleop/operator_link.ts: the link of a driver: how slow it is, and the stamp of each stick.
import { ServerClock } from "../link/clock";
import { LiveLink } from "../link/live";
import { Stick, kSendEvery } from "./seat";

const kAskEvery = 500;   // [ms]
const kStuckBeats = 500 / kSendEvery; // a stick that waits longer is not obeyed
export const kGood = 0.1;       // [s] of round trip
export const kTooSlow = 0.5;    // [s] beyond it the server accepts only Stop
const kSettles = 1100;          // [ms] after a connection: the server takes a stick that comes at once for one that is stuck
const kUnanswered = 2000;       // [ms] a question that is still open counts as that slow

/** What goes with a stick: its number, the server's time at which it was sent, and the round trip. */
export interface Stamp { sequence: number; sent?: number; round_trip?: number }

export class OperatorLink {
  private readonly clock_ = new ServerClock();
  private sequence_ = 0;
  private asked_ = -Infinity;
  private answered_ = true;
  private blocked_ = 0; // beats on end: time would also count a page that stood still, whose hand is well heard
  private opened_: number | null = null;

  constructor(private readonly link_: Pick<LiveLink, "is_open" | "is_clear" | "call">) {}

  /** Call it every kSendEvery. Returns false when a hand's stick no longer reaches the robot: it must be let go. */
  beat(): boolean {
    const now = performance.now();
    if (!this.link_.is_open) {
      this.clock_.clear();
      this.answered_ = true;
      this.blocked_ = 0;
      this.opened_ = null;
      return false;
    }
    this.opened_ ??= now;
    this.blocked_ = this.link_.is_clear ? 0 : this.blocked_ + 1;
    if (now - this.asked_ >= kAskEvery && (this.answered_ || now - this.asked_ > kUnanswered)) this.ask(now);
    return this.blocked_ < kStuckBeats;
  }

  /** Whether a stick may be sent now: none waits in the socket, where it would grow old. */
  get takes_sticks(): boolean {
    return this.link_.is_clear && this.opened_ !== null && performance.now() - this.opened_ > kSettles;
  }

  private ask(sent: number): void {
    this.asked_ = sent;
    this.answered_ = false;
    this.link_.call<{ now: number }>("/clock").then((answer) => {
      this.answered_ = true;
      this.clock_.take(sent / 1000, performance.now() / 1000, answer.now);
    }).catch(() => (this.answered_ = true));
  }

  /** [s] null before the first answer. */
  get round_trip(): number | null {
    const open = this.answered_ ? 0 : (performance.now() - this.asked_) / 1000;
    const usual = this.clock_.round_trip;
    return usual === null ? null : Math.max(usual, open);
  }

  stamped(stick: Stick): Stick & Stamp {
    const stamp: Stamp = { sequence: ++this.sequence_ };
    const sent = this.clock_.server_time(performance.now() / 1000);
    if (sent !== null) stamp.sent = sent;
    if (this.round_trip !== null) stamp.round_trip = Math.min(60, this.round_trip);
    return { ...stick, ...stamp };
  }
}

/** The quality of a link in words. */
export function link_words(round_trip: number | null): { word: string; tone: "ok" | "warn" | "bad" } {
  if (round_trip === null) return { word: "measuring the link", tone: "warn" };
  const ms = `${Math.round(round_trip * 1000)} ms to and fro`;
  if (round_trip <= kGood) return { word: `${ms}: a good link`, tone: "ok" };
  if (round_trip <= kTooSlow) return { word: `${ms}: the robot keeps more room`, tone: "warn" };
  return { word: `${ms}: too slow to drive; only Stop works`, tone: "bad" };
}
