// web/src/state/events.ts: the marks of the timeline: changes of mission and hold, and requests.
import { Frame, Halt } from "../link/frame";

type EventKind = "goal" | "edit" | "good" | "bad" | "hold" | "gain";
export interface RunEvent { t: number; kind: EventKind; label: string }

const kMost = 400;
const kFirstScan = 0.5; // [s] within which every run waits for its first scan
const kMerge = 1.5;     // [s] within which equal events are one mark, as those of a drag

const kHoldWords: Record<string, string> = {
  bumper: "Bumper pressed",
  stale_scan: "Scan too old",
  dazzled: "Laser dazzled",
  not_finite: "A number was not finite",
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
};

export class EventLog {
  readonly list: RunEvent[] = [];
  private before_: Frame | null = null;

  clear(): void {
    this.list.length = 0;
    this.before_ = null;
  }

  push(f: Frame): void {
    const before = this.before_;
    this.before_ = f;
    for (const r of f.requests) {
      switch (r.type) {
        case "set_goal": this.add(f.stamp, "goal", "Goal set"); break;
        case "add_goal": this.add(f.stamp, "goal", "Waypoint added"); break;
        case "clear_goal": this.add(f.stamp, "goal", "Goal cleared"); break;
        case "add_obstacle": this.add(f.stamp, "edit", "Obstacle added"); break;
        case "move_obstacle": this.add(f.stamp, "edit", "Obstacle moved"); break;
        case "remove_obstacle": this.add(f.stamp, "edit", "Obstacle removed"); break;
        case "stop": this.add(f.stamp, "hold", r.engaged ? "Stop" : "Released"); break;
        case "set_parameter": this.add(f.stamp, "gain", `${r.name} set`); break;
      }
    }
    if (before && f.mission !== before.mission) {
      if (f.mission === "arrived") this.add(f.stamp, "good", "Arrived");
      if (f.mission === "stuck") this.add(f.stamp, "bad", "Stuck");
    }
    const no_mark = ["none", "stopped"].includes(f.hold) || (f.hold === "stale_scan" && f.stamp < kFirstScan);
    const halt = f.hold === "halted" && f.halt !== "none" ? f.halt : null;
    if (f.hold !== before?.hold || (halt && halt !== before.halt)) {
      if (!no_mark) this.add(f.stamp, "hold", halt ? kHaltWords[halt] : kHoldWords[f.hold] ?? f.hold);
    }
    if (f.truth?.collided && this.list.at(-1)?.label !== "Collision") {
      this.add(f.stamp, "bad", "Collision");
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
