// web/src/edit/gestures.ts: what a pointer does on the scene, per tool, as drafts and edits. No
// DOM in here but the numbers of pointer events, so that it can be tested.
import { Draft, Selection } from "../draw/scene";
import { View } from "../draw/view";
import { Point, Pose, distance } from "../geometry";
import { Goal } from "../link/frame";
import { Obstacle, covers } from "../obstacle";
import { SceneState } from "../state/scene";
import { new_box, new_cylinder } from "./edits";

/** `pan` moves the view, and a press shows what is there; it asks the robot for nothing. */
export type Tool = "goal" | "cylinder" | "box" | "measure" | "pan";

/** What the gestures may do to the world; the page asks the server. */
export interface GestureTarget {
  scene: SceneState;
  view: View;
  tool(): Tool;
  can_edit(): boolean;  // obstacles
  can_drive(): boolean; // goals
  set_goal(goal: Goal): void;
  add_goal(goal: Goal): void; // for when those before it are reached
  add(obstacle: Obstacle): void;
  /** Called along a drag; `done` at its end, with where it began. */
  move(id: number, pose: Pose, from: Pose, done: boolean): void;
  select(selection: Selection): void;
  draft(draft: Draft): void;
  hover(id: number | null): void;
  refuse(what: "goal" | "obstacle"): void;
  changed(): void;
}

const kDragPixels = 6;   // less is a click
const kGrabPixels = 8;   // beyond an obstacle's edge
const kLeast = 0.05;     // [m] least radius or half side that is drawn by hand
const kDefaultRadius = 0.3;
const kDefaultSide = 0.6;

type Active =
  | { kind: "goal" | "further_goal"; at: Point; px: Point }
  | { kind: "move_goal"; from: Goal; offset: Point; px: Point }
  | { kind: "cylinder" | "box"; at: Point; px: Point }
  | { kind: "measure"; at: Point }
  | { kind: "move"; id: number; from: Pose; offset: Point; px: Point; moved: boolean }
  | { kind: "pan"; px: Point; inspects: boolean; moved: boolean }
  | { kind: "pinch"; a: number; b: number };

export class Gestures {
  private active_: Active | null = null;
  private pointers_ = new Map<number, Point>();
  private measure_: Draft["measure"];

  constructor(private readonly t_: GestureTarget) {}

  get busy(): boolean {
    return this.active_ !== null;
  }

  /**
   * `button` 0 left or touch, 1 middle, 2 right. Pixels from the canvas' corner. With `shift` a goal
   * is added to those there are.
   */
  down(id: number, px: Point, button: number, shift = false): void {
    this.pointers_.set(id, px);
    if (this.pointers_.size === 2) {
      const [a, b] = [...this.pointers_.keys()];
      this.t_.draft(this.rest()); // the first finger meant to pinch, not to draw
      this.active_ = { kind: "pinch", a, b };
      return;
    }
    if (this.pointers_.size > 2) return;
    this.active_ = button === 0 ? this.begin(px, shift) : pan(px, false);
    this.update(px);
  }

  move(id: number, px: Point): void {
    const before = this.pointers_.get(id);
    if (!before) {
      this.t_.hover(this.obstacle_at(px)?.id ?? null);
      return;
    }
    this.pointers_.set(id, px);
    if (this.active_?.kind === "pinch") this.pinch(id, before, px);
    else this.update(px);
  }

  up(id: number, px: Point): void {
    if (!this.pointers_.delete(id)) return;
    const active = this.active_;
    if (active?.kind === "pinch") {
      if (this.pointers_.size === 0) this.active_ = null;
      return;
    }
    this.active_ = null;
    if (active) this.finish(active, px);
  }

  /** Escape, a lost pointer: nothing happened. */
  cancel(): void {
    const active = this.active_;
    this.active_ = null;
    this.pointers_.clear();
    this.measure_ = undefined;
    if (active?.kind === "move" && active.moved) {
      this.t_.move(active.id, active.from, active.from, true);
    }
    this.t_.draft({});
    this.t_.changed();
  }

  private begin(px: Point, shift: boolean): Active | null {
    const { scene, view } = this.t_;
    const at = view.to_world(px.x, px.y);
    const tool = this.t_.tool();
    if (tool === "measure") return { kind: "measure", at };
    if (tool === "pan") return pan(px, true);
    this.measure_ = undefined;
    if (tool === "goal" && shift && this.t_.can_drive()) return { kind: "further_goal", at, px };
    const obstacle = this.obstacle_at(px);
    if (obstacle) {
      this.t_.select({ kind: "obstacle", id: obstacle.id });
      if (!this.t_.can_edit()) return null;
      const offset = { x: obstacle.pose.x - at.x, y: obstacle.pose.y - at.y };
      return { kind: "move", id: obstacle.id, from: obstacle.pose, offset, px, moved: false };
    }
    if (scene.goal && this.t_.can_drive() && this.on_goal(px)) {
      this.t_.select({ kind: "goal" });
      const offset = { x: scene.goal.x - at.x, y: scene.goal.y - at.y };
      return { kind: "move_goal", from: scene.goal, offset, px };
    }
    if (tool === "goal") {
      if (this.t_.can_drive()) return { kind: "goal", at, px };
      this.t_.refuse("goal");
      return null;
    }
    if (this.t_.can_edit()) return { kind: tool, at, px };
    this.t_.refuse("obstacle");
    return null;
  }

  private update(px: Point): void {
    const active = this.active_;
    if (!active) return;
    const to = this.t_.view.to_world(px.x, px.y);
    switch (active.kind) {
      case "pan":
        if (!active.moved && !far(active.px, px)) break;
        active.moved = true;
        this.t_.view.pan(px.x - active.px.x, px.y - active.px.y);
        active.px = px;
        break;
      case "goal":
      case "further_goal":
        this.t_.draft({ goal: dragged_goal(active.at, to, far(active.px, px)) });
        break;
      case "move_goal":
        this.t_.draft({ goal: { ...active.from, ...shifted(to, active.offset) } });
        break;
      case "cylinder":
      case "box":
        this.t_.draft({ obstacle: dragged_obstacle(active.kind, active.at, to, far(active.px, px)) });
        break;
      case "measure":
        this.measure_ = { from: active.at, to };
        this.t_.draft({ measure: this.measure_ });
        break;
      case "move": {
        if (!active.moved && !far(active.px, px)) break;
        active.moved = true;
        const pose = { ...active.from, ...shifted(to, active.offset) };
        this.t_.draft({ moved: { id: active.id, pose } });
        this.t_.move(active.id, pose, active.from, false);
        break;
      }
      case "pinch":
        break;
    }
    this.t_.changed();
  }

  private finish(active: Active, px: Point): void {
    const to = this.t_.view.to_world(px.x, px.y);
    this.t_.draft(this.rest());
    switch (active.kind) {
      case "goal":
        this.t_.select({ kind: "goal" });
        this.t_.set_goal(dragged_goal(active.at, to, far(active.px, px)));
        break;
      case "further_goal":
        this.t_.add_goal(dragged_goal(active.at, to, far(active.px, px)));
        break;
      case "move_goal":
        if (far(active.px, px)) this.t_.set_goal({ ...active.from, ...shifted(to, active.offset) });
        break;
      case "cylinder":
      case "box":
        this.t_.add(dragged_obstacle(active.kind, active.at, to, far(active.px, px)));
        break;
      case "move":
        if (active.moved) {
          this.t_.move(active.id, { ...active.from, ...shifted(to, active.offset) }, active.from,
            true);
        }
        break;
      case "pan":
        if (active.inspects && !active.moved) this.inspect(px);
        break;
      default:
        break;
    }
    this.t_.changed();
  }

  /** Shows what is pressed on, and changes nothing. */
  private inspect(px: Point): void {
    const obstacle = this.obstacle_at(px);
    if (obstacle) this.t_.select({ kind: "obstacle", id: obstacle.id });
    else this.t_.select(this.on_goal(px) ? { kind: "goal" } : null);
  }

  private pinch(id: number, before: Point, px: Point): void {
    const active = this.active_;
    if (active?.kind !== "pinch" || (id !== active.a && id !== active.b)) return;
    const other = this.pointers_.get(id === active.a ? active.b : active.a);
    if (!other) return;
    const middle = (p: Point) => ({ x: (p.x + other.x) / 2, y: (p.y + other.y) / 2 });
    const length = (p: Point) => Math.max(10, Math.hypot(p.x - other.x, p.y - other.y));
    const m0 = middle(before);
    const m1 = middle(px);
    this.t_.view.pan(m1.x - m0.x, m1.y - m0.y);
    this.t_.view.zoom_at(m1.x, m1.y, length(px) / length(before));
    this.t_.changed();
  }

  /** What stays drawn when no gesture is under way: the last measured line. */
  private rest(): Draft {
    return this.measure_ ? { measure: this.measure_ } : {};
  }

  private on_goal(px: Point): boolean {
    const { scene: { goal }, view } = this.t_;
    const at = view.to_world(px.x, px.y);
    return goal !== null && distance(goal, at) * view.scale < Math.max(14, 0.22 * view.scale);
  }

  private obstacle_at(px: Point): Obstacle | null {
    const at = this.t_.view.to_world(px.x, px.y);
    const slack = kGrabPixels / this.t_.view.scale;
    const hits = this.t_.scene.obstacles.filter((o) => covers(o, at, slack));
    return hits.at(-1) ?? null; // drawn last lies on top
  }
}

function pan(px: Point, inspects: boolean): Active {
  return { kind: "pan", px, inspects, moved: false };
}

function far(a: Point, b: Point): boolean {
  return Math.hypot(a.x - b.x, a.y - b.y) >= kDragPixels;
}

function shifted(p: Point, offset: Point): Point {
  return { x: round_cm(p.x + offset.x), y: round_cm(p.y + offset.y) };
}

/** Hands are not exact to less than a centimetre; round values read better. */
function round_cm(v: number): number {
  return Math.round(v * 100) / 100;
}

function dragged_goal(at: Point, to: Point, with_heading: boolean): Goal {
  return {
    x: round_cm(at.x),
    y: round_cm(at.y),
    heading: with_heading ? Math.atan2(to.y - at.y, to.x - at.x) : null,
  };
}

/** A click makes a thing of usual size; a drag from the centre makes it as large as drawn. */
function dragged_obstacle(kind: "cylinder" | "box", at: Point, to: Point,
  dragged: boolean): Obstacle {
  const x = round_cm(at.x);
  const y = round_cm(at.y);
  if (kind === "cylinder") {
    const radius = dragged ? Math.max(kLeast, distance(at, to)) : kDefaultRadius;
    return new_cylinder(x, y, round_cm(radius));
  }
  const length = dragged ? Math.max(kLeast, Math.abs(to.x - at.x)) * 2 : kDefaultSide;
  const width = dragged ? Math.max(kLeast, Math.abs(to.y - at.y)) * 2 : kDefaultSide;
  return new_box(x, y, round_cm(length), round_cm(width));
}
