// web/src/state/events.ts: the marks of the timeline: changes of mission and hold, and requests.
import { Frame, Halt } from "../link/frame";

export type EventKind = "goal" | "edit" | "good" | "bad" | "hold" | "stop" | "gain";
export interface RunEvent { t: number; kind: EventKind; label: string }

const kMost = 400;
const kFirstScan = 0.5; // [s] within which every run waits for its first scan
const kMerge = 1.5;     // [s] within which equal events are one mark, as those of a drag
const kBreak = 40;      // [ticks] missed, from which on a change has no known time

const kHoldWords: Record<string, string> = {
  bumper: "Bumper pressed",
  stale_scan: "Scan too old",
  dazzled: "Laser dazzled",
  not_finite: "A number was not finite",
  overturned: "Turned over",
  not_located: "Not located on the map",
  no_joints: "The arm does not report",
  no_tilt: "No inclination yet",
  stale_tilt: "Inclination too old",
  halted: "Held by the robot",
};

const kHaltWords: Record<Exclude<Halt, "none">, string> = {
  disarmed: "Disarmed",
  base_lost: "Base silent",
  scanner_lost: "Laser silent",
  bad_line: "Laser's line bad",
  scanner_fault: "Laser reports a fault",
  stop_button: "Stop button",
  base_fault: "Base reports a fault",
  over_current: "Motor current too high",
  battery_low: "Battery low",
  motors_off: "Motors not on",
  late_tick: "Tick too late",
  floor_lost: "Floor sensors silent",
  floor_fault: "Floor sensors not to be trusted",
};

/** What ends a run, as the simulator knows it. */
const kEnds = [["collided", "Collision"], ["overturned", "Turned over"], ["fallen", "Fell"]] as const;

export class EventLog {
  readonly list: RunEvent[] = [];
  private before_: Frame | null = null;

  /** `every_change`: the frames are those of all changes, however far apart; else a longer break tells nothing. */
  constructor(private readonly every_change_ = false) {}

  clear(): void {
    this.list.length = 0;
    this.before_ = null;
  }

  /** The frame before the next one: what it shows already is no event. */
  begin(f: Frame): void {
    this.before_ = f;
  }

  push(f: Frame): void {
    const before = this.before_;
    this.before_ = f;
    this.push_requests(f);
    if (this.every_change_ || f.tick - (before?.tick ?? 0) < kBreak) this.push_changes(before, f);
  }

  /** Adds events of the record that are not there yet. */
  merge(recorded: RunEvent[]): void {
    const known = [...this.list];
    const is_known = (e: RunEvent) => known.some((k) => k.label === e.label && Math.abs(k.t - e.t) < kMerge);
    this.list.push(...recorded.filter((e) => !is_known(e)));
    this.list.sort((a, b) => a.t - b.t);
    this.list.splice(0, this.list.length - kMost);
  }

  /** The last time that the robot stood, or was held, against its will. */
  get last_trouble(): RunEvent | null {
    return this.list.filter((e) => e.kind === "bad" || e.kind === "hold").at(-1) ?? null;
  }

  private push_requests(f: Frame): void {
    for (const r of f.requests) {
      switch (r.type) {
        case "set_goal": this.add(f.stamp, "goal", "Goal set"); break;
        case "add_goal": this.add(f.stamp, "goal", "Waypoint added"); break;
        case "clear_goal": this.add(f.stamp, "goal", "Goal cleared"); break;
        case "add_obstacle": this.add(f.stamp, "edit", "Obstacle added"); break;
        case "change_obstacle": this.add(f.stamp, "edit", "Obstacle changed"); break;
        case "move_obstacle": this.add(f.stamp, "edit", "Obstacle moved"); break;
        case "remove_obstacle": this.add(f.stamp, "edit", "Obstacle removed"); break;
        case "stop": this.add(f.stamp, "stop", r.engaged ? "Stop" : "Released"); break;
        case "set_parameter": this.add(f.stamp, "gain", `${r.name} set`); break;
      }
    }
  }

  private push_changes(before: Frame | null, f: Frame): void {
    if (before && f.mission !== before.mission) {
      if (f.mission === "arrived") this.add(f.stamp, "good", "Arrived");
      if (f.mission === "stuck") this.add(f.stamp, "bad", "Stuck");
    }
    const no_mark = ["none", "stopped"].includes(f.hold) || (f.hold === "stale_scan" && f.stamp < kFirstScan);
    const halt = f.hold === "halted" && f.halt !== "none" ? f.halt : null;
    if (f.hold !== before?.hold || (halt && halt !== before.halt)) {
      if (!no_mark) this.add(f.stamp, "hold", halt ? kHaltWords[halt] : kHoldWords[f.hold] ?? f.hold);
    }
    for (const [end, label] of kEnds) {
      if (f.truth?.[end] && !before?.truth?.[end]) this.add(f.stamp, "bad", label);
    }
  }

  private add(t: number, kind: EventKind, label: string): void {
    const last = this.list.at(-1);
    if (last && last.label === label && t - last.t < kMerge) {
      last.t = t;
      return;
    }
    this.list.push({ t, kind, label });
    if (this.list.length > kMost) this.list.shift();
  }
}
