// web/src/state/events.ts: the marks of the timeline: changes of mission and hold, and requests.
import { Frame, Halt } from "../link/frame";

type EventKind = "goal" | "edit" | "good" | "bad" | "hold" | "gain";
export interface RunEvent { t: number; kind: EventKind; label: string }

const kMost = 400;
const kFirstScan = 0.5; // [s] within which every run waits for its first scan
const kMerge = 1.5;     // [s] within which equal events are one mark, as those of a drag

const kHoldWords: Record<string, string> = {
  stopped: "Stop",
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
  private mission_ = "";
  private hold_ = "none";
  private halt_ = "none";

  clear(): void {
    this.list.length = 0;
    this.mission_ = "";
    this.hold_ = "none";
    this.halt_ = "none";
  }

  push(f: Frame): void {
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
    if (this.mission_ !== "" && f.mission !== this.mission_) {
      if (f.mission === "arrived") this.add(f.stamp, "good", "Arrived");
      if (f.mission === "stuck") this.add(f.stamp, "bad", "Stuck");
    }
    const before_first_scan = f.hold === "stale_scan" && f.stamp < kFirstScan;
    if (f.hold === "halted" && f.halt !== this.halt_ && f.halt !== "none") {
      this.add(f.stamp, "hold", kHaltWords[f.halt]);
    } else if (!before_first_scan && f.hold !== this.hold_ && f.hold !== "none" && f.hold !== "stopped") {
      this.add(f.stamp, "hold", kHoldWords[f.hold] ?? f.hold);
    }
    if (f.truth?.collided && this.list.at(-1)?.label !== "Collision") {
      this.add(f.stamp, "bad", "Collision");
    }
    this.mission_ = f.mission;
    this.hold_ = f.hold;
    this.halt_ = f.hold === "halted" ? f.halt : "none";
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
