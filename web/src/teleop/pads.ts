// web/src/teleop/pads.ts: gamepads: which axis and which button of one does what. Browsers know it for pads of the
// standard mapping; for the others a person says it once, and the browser keeps it.
import { keep, kept } from "../state/store";
import type { Stick } from "./seat";

/** The parts of a Gamepad that count. */
export interface Pad {
  id: string;
  mapping: string;
  axes: readonly number[];
  buttons: readonly { pressed: boolean; value: number }[];
}

/** An axis, and the sign of its value when it is pushed ahead or to the left. */
export interface PadAxis { axis: number; sign: 1 | -1 }
/** `run`: the button that must be held while the robot drives. */
export interface PadMap { ahead: PadAxis; turn: PadAxis; run: number; stop: number }
export type Role = keyof PadMap;
export const kRoles: readonly Role[] = ["ahead", "turn", "run", "stop"];

/** What a pad asks for. `stop`: its Stop is pressed. `stick` is null unless its button is held. */
export interface PadWish { stick: Stick | null; stop: boolean; strange: boolean }

const kDeadZone = 0.12; // of an axis
const kExpo = 0.35;     // share of the cube: fine near the middle
// Of the standard mapping. Browsers count axes down and to the right: negated here, and nowhere else.
const kAhead: PadAxis = { axis: 1, sign: -1 }, kTurn: PadAxis = { axis: 2, sign: -1 };
const kButtonB = 1, kBumpers = [4, 5], kBackTrigger = 6, kAheadTrigger = 7;

/** A standard pad: left stick ahead, right stick turn, triggers ahead and back, B is Stop. Another one by `map`, and
 * without one it is strange: it moves nothing. */
export function read_pad(pad: Pad | null, map: PadMap | null = null): PadWish {
  if (!pad) return { stick: null, stop: false, strange: false };
  const down = (b: number) => pad.buttons[b]?.pressed ?? false;
  const at = ({ axis, sign }: PadAxis) => sign * curved(pad.axes[axis] ?? 0) + 0;
  if (pad.mapping !== "standard") {
    if (!map || !fits(map, pad)) return { stick: null, stop: false, strange: true };
    const stick = down(map.run) ? { forward: at(map.ahead), turn: at(map.turn) } : null;
    return { stick, stop: down(map.stop), strange: false };
  }
  if (!kBumpers.some(down)) return { stick: null, stop: down(kButtonB), strange: false };
  const trigger = (b: number) => pad.buttons[b]?.value ?? 0;
  const forward = Math.max(-1, Math.min(1, at(kAhead) + trigger(kAheadTrigger) - trigger(kBackTrigger)));
  return { stick: { forward, turn: at(kTurn) }, stop: down(kButtonB), strange: false };
}

/** Without the dead zone, and finer near the middle. */
export function curved(axis: number): number {
  if (!Number.isFinite(axis)) return 0;
  const beyond = Math.max(0, Math.min(1, Math.abs(axis)) - kDeadZone) / (1 - kDeadZone);
  return Math.sign(axis) * ((1 - kExpo) * beyond + kExpo * beyond ** 3);
}

/** The gamepad to listen to: the first that may move something, else the first. Null where there is none, or where a
 * policy bars the page from them. */
export function find_pad<P extends Pad>(list: () => (P | null)[] | undefined): P | null {
  try {
    const pads = (list() ?? []).filter((p) => p !== null);
    return pads.find((p) => !read_pad(p, map_of(p.id)).strange) ?? pads[0] ?? null;
  } catch {
    return null;
  }
}

/** Whether the pad has what `map` names: two pads may have one id. */
export function fits(map: PadMap, pad: Pad): boolean {
  return Math.max(map.ahead.axis, map.turn.axis) < pad.axes.length && Math.max(map.run, map.stop) < pad.buttons.length;
}

const kMaps = "tautline.pads";
const kMostMaps = 20; // the one that was kept first goes first

const is_index = (value: unknown): value is number => Number.isInteger(value) && (value as number) >= 0;

/** Whether `value` maps every role, each to an axis or a button of its own. */
export function is_map(value: unknown): value is PadMap {
  if (typeof value !== "object" || value === null) return false;
  const { ahead, turn, run, stop } = value as Partial<PadMap>;
  const is_axis = (a: PadAxis | undefined) => !!a && is_index(a.axis) && (a.sign === 1 || a.sign === -1);
  return is_axis(ahead) && is_axis(turn) && ahead!.axis !== turn!.axis && is_index(run) && is_index(stop) && run !== stop;
}

/** The map of each pad's id that is valid. */
export function read_maps(text: string): [string, PadMap][] {
  const list: unknown = JSON.parse(text);
  if (!Array.isArray(list)) return [];
  return list.filter((e): e is [string, PadMap] => Array.isArray(e) && typeof e[0] === "string" && is_map(e[1]));
}

const all = () => kept<[string, PadMap][]>(kMaps, [], read_maps);
let held: { id: string; map: PadMap | null } | null = null; // looked up 20 times a second

export function map_of(id: string): PadMap | null {
  if (held?.id !== id) held = { id, map: all().find(([known]) => known === id)?.[1] ?? null };
  return held.map;
}

/** Null forgets the map of the pad. */
export function keep_map(id: string, map: PadMap | null): void {
  const others = all().filter(([known]) => known !== id);
  keep(kMaps, JSON.stringify([...others, ...(map ? [[id, map]] : [])].slice(-kMostMaps)));
  held = { id, map };
}

const kMoved = 0.5;    // of an axis, from its rest
const kMiddle = 0.25;  // within which an axis rests that springs back
const kStill = 0.05;   // less is a tremble of an axis
const kStillFor = 6;   // states without a change, until the pad counts as let go

/** Hears by which axis or button a person answers "push the stick ahead" and the like. */
export class PadEar {
  private rest_: readonly number[] | null = null; // of each axis; null: not known yet
  private last_: readonly number[] = [];
  private still_ = 0;     // states without a change
  private quiet_ = false; // all has been let go since the question
  map: Partial<PadMap> = {};
  /** Asked for now; null: nothing. */
  role: Role | null = null;
  /** Why what was moved is not taken; empty without a reason. */
  remark = "";

  /** Begins with `role`, and goes on with those that have no answer yet. */
  begin(role: Role): void {
    this.rest_ = null;
    this.still_ = 0;
    this.ask(role);
  }
  private ask(role: Role | null): void {
    this.role = role;
    this.quiet_ = false;
    this.remark = "";
    if (role) delete this.map[role];
  }

  get complete(): PadMap | null {
    return is_map(this.map) ? this.map : null;
  }
  /** Waits for all to be let go: a stick on its way back would answer the next question. */
  get waits(): boolean {
    return this.role !== null && !this.quiet_;
  }

  /** Takes the newest state of the pad; returns whether it answered. */
  hear(pad: Pad): boolean {
    if (!this.role) return false;
    const pressed = pad.buttons.some((b) => b.pressed);
    if (!this.rest_) {
      const same = !pressed && pad.axes.every((value, i) => Math.abs(value - (this.last_[i] ?? NaN)) < kStill);
      this.still_ = same ? this.still_ + 1 : 0;
      this.last_ = [...pad.axes];
      if (this.still_ < kStillFor) return false;
      this.rest_ = this.last_;
    }
    const rest = this.rest_;
    const moved = pad.axes.map((value, i) => value - (rest[i] ?? 0));
    if (!this.quiet_) {
      this.quiet_ = !pressed && moved.every((m) => Math.abs(m) < kMiddle);
      return false;
    }
    const answer = this.role === "ahead" || this.role === "turn" ? this.axis(moved, this.role) : this.button(pad, this.role);
    if (!answer) return false;
    this.ask(kRoles.find((role) => this.map[role] === undefined) ?? null);
    return true;
  }

  private axis(moved: number[], role: "ahead" | "turn"): boolean {
    const axis = moved.reduce((most, m, i) => (Math.abs(m) > Math.abs(moved[most]) ? i : most), 0);
    if (!(Math.abs(moved[axis] ?? 0) > kMoved)) return false;
    if (Math.abs(this.rest_![axis]) > kMiddle) {
      this.remark = `Axis ${axis} does not rest in the middle, so the robot would drive by itself. Choose another.`;
      return false;
    }
    if (axis === this.map[role === "ahead" ? "turn" : "ahead"]?.axis) {
      this.remark = `Axis ${axis} has a use already. Choose another.`;
      return false;
    }
    this.map[role] = { axis, sign: moved[axis] > 0 ? 1 : -1 };
    return true;
  }

  private button(pad: Pad, role: "run" | "stop"): boolean {
    const button = pad.buttons.findIndex((b) => b.pressed);
    if (button < 0) return false;
    if (button === this.map[role === "run" ? "stop" : "run"]) {
      this.remark = `Button ${button} has a use already. Choose another.`;
      return false;
    }
    this.map[role] = button;
    return true;
  }
}
