// web/src/edit/gestures.ts: turns pointers on the scene into drafts and edits, by tool. It reads
// only the numbers of pointer events, so that tests need no DOM.
import { Draft, Selection } from "../draw/scene";
import { View } from "../draw/view";
import { Point, Pose, distance } from "../geometry";
import { Goal } from "../link/frame";
import { Obstacle, covers } from "../obstacle";
import { SceneState } from "../state/scene";
import { kUsualRadius, kUsualSide, new_box, new_cylinder, round_cm } from "./edits";

/** `pan` moves the view, and a press selects; it changes nothing. */
export type Tool = "goal" | "cylinder" | "box" | "measure" | "pan";

/** The effects of gestures; the page sends the edits to the server. */
export interface GestureTarget {
  scene: SceneState;
  view: View;
  tool(): Tool;
  can_edit(): boolean; // whether obstacles may be moved
  set_goal(goal: Goal): void;
  add_goal(goal: Goal): void; // after the goals that the robot has
  add(obstacle: Obstacle): void;
  /** Called during a drag, with the pose where it began; `done` at its end. */
  move(id: number, pose: Pose, from: Pose, done: boolean): void;
  select(selection: Selection): void;
  draft(draft: Draft): void;
  hover(id: number | null): void;
  changed(): void;
}

const kDragPixels = 6;   // a shorter way is a click
const kGrabPixels = 8;   // from an obstacle's edge a press still hits it
const kLeast = 0.05;     // [m] least radius or half side of a drawn obstacle

/** A gesture that draws: its draft while the pointer is at `to` in W, and its edit at the end. */
interface Drawing {
  kind: "draw";
  px: Point;
  draft(to: Point, dragged: boolean): Draft;
  finish(to: Point, dragged: boolean): void;
}
type Active =
  | Drawing
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
   * `button` 0 left or touch, 1 middle, 2 right. Pixels from the corner of the canvas. With `shift`
   * the goal tool adds a goal after the others.
   */
  down(id: number, px: Point, button: number, shift = false): void {
    this.pointers_.set(id, px);
    if (this.pointers_.size === 2) {
      const [a, b] = [...this.pointers_.keys()];
      this.t_.draft(this.rest()); // the first finger began a pinch, not a drawing
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

  /** For Escape or a lost pointer: puts a moved obstacle back. */
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
    const { scene: { goal }, view } = this.t_;
    const at = view.to_world(px.x, px.y);
    const tool = this.t_.tool();
    if (tool === "measure") return { kind: "measure", at };
    if (tool === "pan") return pan(px, true);
    this.measure_ = undefined;
    const new_goal = (to: Point, dragged: boolean) => dragged_goal(at, to, dragged);
    if (tool === "goal" && shift) return drawn_goal(px, new_goal, (to) => this.t_.add_goal(to));
    const obstacle = this.obstacle_at(px);
    if (obstacle) {
      this.t_.select({ kind: "obstacle", id: obstacle.id });
      if (!this.t_.can_edit()) return null;
      const { id, pose } = obstacle;
      return { kind: "move", id, from: pose, offset: offset_of(pose, at), px, moved: false };
    }
    if (goal && this.on_goal(px)) {
      this.t_.select({ kind: "goal" });
      const offset = offset_of(goal, at);
      return drawn_goal(px, (to) => ({ ...goal, ...shifted(to, offset) }), (to, dragged) => {
        if (dragged) this.t_.set_goal(to);
      });
    }
    if (tool === "goal") {
      return drawn_goal(px, new_goal, (to) => {
        this.t_.select({ kind: "goal" });
        this.t_.set_goal(to);
      });
    }
    const drawn = (to: Point, dragged: boolean) => dragged_obstacle(tool, at, to, dragged);
    return {
      kind: "draw", px,
      draft: (to, dragged) => ({ obstacle: drawn(to, dragged) }),
      finish: (to, dragged) => this.t_.add(drawn(to, dragged)),
    };
  }

  private update(px: Point): void {
    const active = this.active_;
    if (!active) return;
    const to = this.t_.view.to_world(px.x, px.y);
    if (active.kind === "draw") {
      this.t_.draft(active.draft(to, far(active.px, px)));
    } else if (active.kind === "measure") {
      this.measure_ = { from: active.at, to };
      this.t_.draft({ measure: this.measure_ });
    } else if (active.kind !== "pinch" && (active.moved || far(active.px, px))) {
      active.moved = true;
      if (active.kind === "move") {
        const pose = { ...active.from, ...shifted(to, active.offset) };
        this.t_.draft({ moved: { id: active.id, pose } });
        this.t_.move(active.id, pose, active.from, false);
      } else {
        this.t_.view.pan(px.x - active.px.x, px.y - active.px.y);
        active.px = px;
      }
    }
    this.t_.changed();
  }

  private finish(active: Active, px: Point): void {
    const to = this.t_.view.to_world(px.x, px.y);
    this.t_.draft(this.rest());
    if (active.kind === "draw") active.finish(to, far(active.px, px));
    else if (active.kind === "pan" && active.inspects && !active.moved) this.inspect(px);
    else if (active.kind === "move" && active.moved) {
      this.t_.move(active.id, { ...active.from, ...shifted(to, active.offset) }, active.from, true);
    }
    this.t_.changed();
  }

  /** Selects the object under the pointer, and changes nothing. */
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
    const length = (p: Point) => Math.max(10, distance(p, other));
    const m0 = middle(before);
    const m1 = middle(px);
    this.t_.view.pan(m1.x - m0.x, m1.y - m0.y);
    this.t_.view.zoom_at(m1.x, m1.y, length(px) / length(before));
    this.t_.changed();
  }

  /** The draft between gestures: the last measured line. */
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
    return hits.at(-1) ?? null; // the last one drawn lies on top
  }
}

function pan(px: Point, inspects: boolean): Active {
  return { kind: "pan", px, inspects, moved: false };
}

function far(a: Point, b: Point): boolean {
  return distance(a, b) >= kDragPixels;
}

/** A gesture that draws or moves a goal. */
function drawn_goal(px: Point, goal: (to: Point, dragged: boolean) => Goal,
  finish: (goal: Goal, dragged: boolean) => void): Drawing {
  return {
    kind: "draw", px,
    draft: (to, dragged) => ({ goal: goal(to, dragged) }),
    finish: (to, dragged) => finish(goal(to, dragged), dragged),
  };
}

/** From the pointer to the reference point of an object gripped there. */
function offset_of(p: Point, at: Point): Point {
  return { x: p.x - at.x, y: p.y - at.y };
}

function shifted(p: Point, offset: Point): Point {
  return { x: round_cm(p.x + offset.x), y: round_cm(p.y + offset.y) };
}

function dragged_goal(at: Point, to: Point, with_heading: boolean): Goal {
  return {
    x: round_cm(at.x),
    y: round_cm(at.y),
    heading: with_heading ? Math.atan2(to.y - at.y, to.x - at.x) : null,
  };
}

/** A click makes an obstacle of usual size; a drag from the centre makes it as large as drawn. */
function dragged_obstacle(kind: "cylinder" | "box", at: Point, to: Point,
  dragged: boolean): Obstacle {
  const x = round_cm(at.x);
  const y = round_cm(at.y);
  if (kind === "cylinder") {
    const radius = dragged ? Math.max(kLeast, distance(at, to)) : kUsualRadius;
    return new_cylinder(x, y, round_cm(radius));
  }
  const length = dragged ? Math.max(kLeast, Math.abs(to.x - at.x)) * 2 : kUsualSide;
  const width = dragged ? Math.max(kLeast, Math.abs(to.y - at.y)) * 2 : kUsualSide;
  return new_box(x, y, round_cm(length), round_cm(width));
}
