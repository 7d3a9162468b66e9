// web/src/explain.ts: words for a tick, formed where they are read. The server says the same in its
// log and over REST (algo/explain.cpp); tests/golden/words.json holds both to the same sentences.
import { Frame, Halt, Nearest } from "./link/frame";
import { Point } from "./geometry";

const kNoticeable = 0.005; // [m] a smaller force is not worth a sentence

export interface Explanation { what: string; why: string }

/** One sentence for what the robot is doing, one for why, with the numbers. */
export function explain(f: Frame): Explanation {
  if (f.what) return { what: f.what, why: f.why }; // a controller with words of its own
  if (f.hold !== "none") return explain_hold(f);
  if (f.behaviour === "manual") {
    return { what: "Driven by hand",
      why: `${metres(f.command.v)} m/s ahead, ${metres(f.command.omega)} rad/s. ${surroundings(f)}` };
  }
  if (!f.goal) return { what: "Waiting for a goal", why: surroundings(f) };
  const to_go = Math.hypot(f.goal.x - f.pose.x, f.goal.y - f.pose.y);
  switch (f.mission) {
    case "arrived":
      return { what: "Arrived",
        why: `${metres(to_go)} m from the goal at (${metres(f.goal.x)}, ${metres(f.goal.y)}).` };
    case "stuck":
      return { what: "Stuck",
        why: `The pull to the goal and the push of ${metres(length(f.elastic))} m from obstacles cancel; ` +
          `${metres(to_go)} m to go. Move an obstacle or the goal.` };
    default:
      return explain_drive(f, to_go);
  }
}

const kHalts: Record<Exclude<Halt, "none">, Explanation> = {
  disarmed: { what: "The motors are off",
    why: "Nobody has armed this robot. It moves only once somebody does." },
  base_lost: { what: "Waiting for the base",
    why: "The motor controller is silent. The wheels are held still." },
  scanner_lost: { what: "Waiting for the laser",
    why: "The scanner is silent. The wheels are held still." },
  bad_line: { what: "Holding still",
    why: "More of what the scanner sends comes damaged than whole: look at its cable." },
  scanner_fault: { what: "Holding still",
    why: "The scanner reports a fault of its own, or is blinded." },
  stop_button: { what: "Stop button pressed",
    why: "The stop button on the robot is pressed. Release it, then arm again." },
  base_fault: { what: "Holding still",
    why: "The motor controller reports a fault." },
  over_current: { what: "Holding still",
    why: "A motor took more current than it may: is a wheel blocked?" },
  battery_low: { what: "Battery low",
    why: "The battery is below its limit. Charge it." },
  motors_off: { what: "Waiting for the motors",
    why: "The robot is armed, but its motors are not on yet." },
  late_tick: { what: "Holding still",
    why: "The control loop came too late; the wheels were stopped." },
};

function explain_hold(f: Frame): Explanation {
  switch (f.hold) {
    case "halted":
      return f.halt === "none"
        ? { what: "Holding still", why: "The robot holds its wheels still." } : kHalts[f.halt];
    case "stopped":
      return { what: "Stopped", why: "Stop is engaged. The robot stays here until it is released." };
    case "bumper":
      return { what: "Touching something", why: "The bumper is pressed. Back away by hand, or reset." };
    case "stale_scan":
      return { what: "Waiting for the laser", why: f.newest_scan === null
        ? "No scan has come yet. The robot waits."
        : `Scan is ${(f.stamp - f.newest_scan).toFixed(1)} s old. The robot waits.` };
    case "dazzled":
      return { what: "Waiting for the laser", why: "It is blinded or dazzled: beams ahead tell nothing." };
    case "not_finite":
      return { what: "Holding still",
        why: "A sensor or the controller gave a value that is not a number." };
    default:
      return { what: "Holding still", why: "The link to the robot is lost." };
  }
}

function explain_drive(f: Frame, to_go: number): Explanation {
  const left = length(f.external_left);
  const right = length(f.external_right);
  const by_left = left >= right;
  const side = by_left ? "left" : "right";
  const nearest = by_left ? f.left : f.right;
  const force = by_left ? left : right;
  if (force < kNoticeable || !nearest) {
    return { what: "Driving to the goal", why: `${metres(to_go)} m to go. ${surroundings(f)}` };
  }
  const why = `External force ${metres(force)} m from the nearest ${side} return at ${metres(nearest.distance)} m`;
  if (f.side === 0) return { what: `Keeping clear of the ${side} obstacle`, why: `${why}.` };
  return { what: `Passing the obstacle on its ${f.side > 0 ? "left" : "right"}`,
    why: `${why}; side chosen ${(f.stamp - f.side_since).toFixed(1)} s ago.` };
}

function surroundings(f: Frame): string {
  const nearest: Nearest | null =
    f.left && (!f.right || f.left.distance <= f.right.distance) ? f.left : f.right;
  return nearest ? `The nearest return is ${metres(nearest.distance)} m from the robot's centre.`
    : "Nothing is seen within range.";
}

const metres = (value: number): string => value.toFixed(2);
const length = (v: Point): number => Math.hypot(v.x, v.y);
