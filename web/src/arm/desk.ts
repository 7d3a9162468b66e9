// web/src/arm/desk.ts: what people ask of an arm: goals of the hand by drags, keys and numbers, joints, the fold, goals
// to carry to. Each is one step of undo, which brings back what was asked before.
import type { App } from "../app";
import type { ArmRequest, HandGoalJson, RequestJson } from "../contract";
import type { View } from "../draw/view";
import { goal_json, goal_request, route_request } from "../edit/edits";
import type { Drawing } from "../edit/gestures";
import { Point, degrees, distance, radians } from "../geometry";
import type { Goal } from "../link/frame";
import { goal_from_json } from "../state/goals";
import type { SceneState } from "../state/scene";
import { ArmPlace, reach_words } from "./chain";
import { arm_of } from "./plan";
import { Pointing, goal_at, moved, pointing_of, quaternion_to, wrist_of } from "./pose";

const kGrab = 18;       // [px] about the goal of the hand
const kStep = 0.1;      // [m] of a key
const kFineStep = 0.01; // [m]
const kTurn = radians(5);
const kSendMs = 120;    // [ms] between two requests of one slider

/** Rounds [m] to a centimetre: no hand is more exact. */
const round_cm = (v: number) => Math.round(v * 100) / 100;
export const rounded = (goal: HandGoalJson): HandGoalJson => ({ ...goal, x: round_cm(goal.x), y: round_cm(goal.y), z: round_cm(goal.z) });

/** `goal` with another direction. */
export function pointed(goal: HandGoalJson, change: Partial<Pointing>): HandGoalJson {
  return { ...goal, ...quaternion_to({ ...pointing_of(goal), ...change }) };
}

/** The goal of the hand at the shown instant: that of the live robot as it was last asked, or as a frame tells. */
export function hand_goal_of({ arm_asked, frame }: SceneState): HandGoalJson | null {
  if (!arm_asked) return frame?.arm?.hand_goal ?? null;
  return arm_asked.type === "set_hand_goal" ? arm_asked : null;
}

/** What a press of a key does to the hand's goal. */
const kKeys: Record<string, (goal: HandGoalJson, step: number) => HandGoalJson> = {
  ArrowLeft: (g, step) => moved(g, [-step, 0, 0]),
  ArrowRight: (g, step) => moved(g, [step, 0, 0]),
  ArrowUp: (g, step) => moved(g, [0, step, 0]),
  ArrowDown: (g, step) => moved(g, [0, -step, 0]),
  PageUp: (g, step) => moved(g, [0, 0, step]),
  PageDown: (g, step) => moved(g, [0, 0, -step]),
  "[": (g) => pointed(g, { bearing: pointing_of(g).bearing + kTurn }),
  "]": (g) => pointed(g, { bearing: pointing_of(g).bearing - kTurn }),
  "{": (g) => pointed(g, { pitch: pitched(g, kTurn) }),
  "}": (g) => pointed(g, { pitch: pitched(g, -kTurn) }),
  "(": (g) => pointed(g, { turn: pointing_of(g).turn + kTurn }),
  ")": (g) => pointed(g, { turn: pointing_of(g).turn - kTurn }),
};

/** Up and down end the pitch: beyond them the bearing would jump. */
const pitched = (goal: HandGoalJson, by: number) => Math.max(-Math.PI / 2, Math.min(Math.PI / 2, pointing_of(goal).pitch + by));

export class ArmDesk {
  /** A goal that is held in a hand, or typed, and not sent yet. */
  draft: HandGoalJson | null = null;
  /** Goals of the base that a person sets in the scene are driven to straight, with the arm as it is. */
  carries = false;
  private turning_: { from: ArmRequest; busy: boolean; sent: number } | null = null;

  constructor(private readonly app_: App) {}

  /** Whether this person may move the arm now. */
  get may(): boolean {
    const { looking, session } = this.app_.ui.value;
    return !looking && !!session?.robot.drives && this.app_.scene.arm !== null && this.app_.people.may("operator");
  }
  /** Where the arm is, of the live robot. */
  get place(): ArmPlace | null {
    return arm_of(this.app_.scene);
  }
  /** The goal that edits change: the draft, else the robot's, else where the hand is. */
  get goal(): HandGoalJson | null {
    const place = this.place;
    return this.draft ?? hand_goal_of(this.app_.scene) ?? (place && goal_at(place));
  }
  /** Whether the hand's goal is what arrows and the gizmo move. */
  get chosen(): boolean {
    return this.may && (this.app_.ui.value.selection?.kind === "hand" || this.app_.usable_tool === "hand");
  }

  /** Why the arm alone does not reach `goal` from where the base is; null: the distances are no obstacle. */
  reach(goal: HandGoalJson): { words: string; never: boolean } | null {
    const { arm } = this.app_.scene;
    const place = this.place;
    return arm && place ? reach_words(arm, place.shoulder, wrist_of(goal, arm.hand)) : null;
  }

  /** Shows `goal` without sending it. */
  hold(goal: HandGoalJson | null): void {
    this.draft = goal;
    this.app_.redraw();
  }
  /** A drag has ended at `goal`: a simulated robot sets off, real hardware after Go. */
  drop(goal: HandGoalJson): void {
    this.hold(goal);
    if (!this.app_.on_hardware) void this.send(goal);
  }
  async send(goal: HandGoalJson): Promise<void> {
    this.draft = goal;
    const { x, y, z, qw, qx, qy, qz, arm_angle, base_stays, path, then } = goal;
    const order: ArmRequest = {
      type: "set_hand_goal", x, y, z, qw, qx, qy, qz, ...(arm_angle !== undefined && { arm_angle }),
      ...(base_stays && { base_stays }), ...(path && { path }), ...(then && { then }),
    };
    await this.ask("Move the hand", order, this.before());
    if (this.draft === goal) this.hold(null);
  }

  /** Carries to `goal` if a person has chosen that, or if the robot carries now. */
  carry(goal: Goal): boolean {
    const carried = this.app_.scene.arm_asked?.type === "carry";
    if (!this.may || this.app_.on_hardware || !(this.carries || carried)) return false;
    void this.send_carry(goal);
    return true;
  }
  send_carry(goal: Goal): Promise<void> {
    return this.ask("Carry", { type: "carry", ...goal_json(goal) }, this.before());
  }
  /** Turns all joints straight to `position` [rad]. */
  set_joints(label: string, position: number[]): Promise<void> {
    return this.ask(label, { type: "set_joints", position }, this.joints_before());
  }
  fold(): Promise<void> {
    return this.set_joints("Fold the arm", this.app_.scene.arm?.rest ?? []);
  }
  clear(): void {
    this.draft = null;
    void this.ask("Clear the goal of the hand", goal_request(null), this.before());
  }

  /** A slider of joint `k` is at `angle` [rad]. Its values are sent at a steady pace, and the last one always; the
   * whole drag is one step of undo. */
  turn(k: number, angle: number, done: boolean): void {
    const now = this.joints_asked;
    if (!now) return;
    const order: RequestJson = { type: "set_joints", position: now.map((q, i) => (i === k ? angle : q)) };
    const turning = (this.turning_ ??= { from: this.joints_before(), busy: false, sent: 0 });
    if (done) {
      this.turning_ = null;
      void this.ask(`Turn joint ${k + 1}`, order, turning.from);
      return;
    }
    const at = performance.now();
    if (turning.busy || at - turning.sent < kSendMs || this.app_.on_hardware) return;
    this.app_.go_live();
    Object.assign(turning, { busy: true, sent: at });
    // A refusal on the way needs no toast: the end of the drag shows one.
    this.app_.link.call("/request", order).catch(() => undefined).finally(() => (turning.busy = false));
  }
  /** [rad] Where the joints are to be, else where they are. */
  get joints_asked(): number[] | null {
    const { arm_asked, frame } = this.app_.scene;
    return arm_asked?.type === "set_joints" ? arm_asked.position : frame?.joints ?? null;
  }

  /** Sends `order`. There is no undo on hardware: it would send the robot somewhere else. */
  private async ask(label: string, order: RequestJson, back: RequestJson): Promise<void> {
    this.app_.go_live();
    if (this.app_.on_hardware) await this.app_.request(order);
    else await this.app_.editor.edit({ label, forward: order, backward: back });
  }
  /** The request that brings back what is asked now. */
  private before(): RequestJson {
    const { arm_asked, route } = this.app_.scene;
    if (arm_asked && arm_asked.type !== "set_joints") return arm_asked;
    return route.goals.length > 0 ? route_request(route) : arm_asked ?? goal_request(null);
  }
  private joints_before(): ArmRequest {
    const { arm_asked, frame } = this.app_.scene;
    return arm_asked ?? { type: "set_joints", position: frame?.joints ?? [] };
  }

  /** Whether a pointer at `px` of the view from above is on the goal of the hand. */
  near(view: View, px: Point): boolean {
    const goal = this.draft ?? hand_goal_of(this.app_.shown);
    return goal !== null && distance(view.to_screen(goal), px) <= kGrab;
  }
  /** A drag from above: the goal keeps its height. A press beside it brings the goal there, and a drag from there gives
   * the direction. */
  drag(view: View, px: Point): Drawing | null {
    const goal = this.may ? this.goal : null;
    if (!goal) return null;
    const from = view.to_world(px.x, px.y);
    const on_it = this.near(view, px);
    const to_goal = (to: Point, dragged: boolean): HandGoalJson => {
      if (on_it) return rounded(moved(goal, [to.x - from.x, to.y - from.y, 0]));
      const there = rounded({ ...goal, ...from });
      return dragged ? pointed(there, { bearing: Math.atan2(to.y - from.y, to.x - from.x) }) : there;
    };
    return {
      kind: "draw", px, draft: (to, dragged) => ({ hand: to_goal(to, dragged) }),
      finish: (to, dragged) => {
        this.app_.ui.set({ selection: { kind: "hand" } });
        if (dragged || !on_it) this.drop(to_goal(to, dragged));
      },
    };
  }
  /** The crosshair places the goal. */
  put(at: Point): void {
    const { goal } = this;
    if (!goal || !this.may) return;
    this.app_.ui.set({ selection: { kind: "hand" } });
    this.drop(rounded({ ...goal, ...at }));
  }

  /** Whether the key `e` was for the hand. */
  key(e: KeyboardEvent): boolean {
    if (e.key === "Escape" && this.draft) this.hold(null); // the selection goes too
    if (!this.may) return false;
    if (e.key.toLowerCase() === "h") {
      this.app_.pick_tool(this.app_.ui.value.tool === "hand" ? "pan" : "hand");
      return true;
    }
    const focus = document.activeElement;
    const elsewhere = focus && focus !== document.body && !(focus instanceof HTMLCanvasElement);
    const { goal } = this;
    if (!this.chosen || !goal || elsewhere) return false;
    if (e.key === "Delete" || e.key === "Backspace") {
      this.clear();
      return true;
    }
    const act = kKeys[e.key];
    if (!act) return false;
    const to = rounded(act(goal, e.shiftKey ? kFineStep : kStep));
    this.drop(to);
    this.app_.say(goal_words(to));
    return true;
  }

  /** Where a robot that fetches comes back to: where its base stands. */
  get here(): HandGoalJson["then"] {
    const pose = this.app_.scene.frame?.pose;
    return pose && { x: round_cm(pose.x), y: round_cm(pose.y), heading: pose.heading };
  }
}

/** "2.50, 0.00, 0.95 metres, bearing 0, pitch −25, turn 0 degrees". */
export function goal_words(goal: HandGoalJson): string {
  const { bearing, pitch, turn } = pointing_of(goal);
  const whole = (angle: number) => String(Math.round(degrees(angle)));
  return `${[goal.x, goal.y, goal.z].map((v) => v.toFixed(2)).join(", ")} metres, bearing ${whole(bearing)}, pitch ${whole(pitch)}, turn ${whole(turn)} degrees`;
}

/** The goal to carry to, as the live robot was asked. */
export function carry_goal_of({ arm_asked }: SceneState): Goal | null {
  return arm_asked?.type === "carry" ? goal_from_json(arm_asked) : null;
}
