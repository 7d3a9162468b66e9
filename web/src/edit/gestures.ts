// web/src/edit/gestures.ts: turns pointers on the scene into drafts and edits, by tool. It reads
// only the numbers of pointer events, so that tests need no DOM.
import { Draft, Selection } from "../draw/scene";
import { View } from "../draw/view";
import { Point, Pose, distance, least } from "../geometry";
import { Goal } from "../link/frame";
import { Obstacle, is_ground, is_robot, topmost } from "../obstacle";
import { SceneState } from "../state/scene";
import { DragTool, Sketched, Tool, dragged_goal, dragged_obstacle, dragged_start, finished, is_sketch, sketched } from "./drawn";
import { round_cm, shifted as with_path } from "./edits";
import { Handle, handles_of } from "./handles";

export type { Tool } from "./drawn";

/** The effects of gestures; the page sends the edits to the server. */
export interface GestureTarget {
  scene: SceneState;
  view: View;
  tool(): Tool;
  can_edit(): boolean; // whether obstacles may be moved
  /** A press with a tool that edits begins: from here on `scene` is the world as it is now. */
  will_edit?(): void;
  /** Whether `scene` is an earlier instant, of which nothing can be moved. */
  looks_back?(): boolean;
  set_goal(goal: Goal): void;
  add_goal(goal: Goal): void; // after the goals that the robot has
  change_goal(index: number, goal: Goal): void; // one of the list
  set_start(pose: Pose): void;
  set_pose?(pose: Pose): void; // of the robot, on the map that it knows
  add(obstacle: Obstacle): void;
  change(label: string, from: Obstacle, to: Obstacle): void;
  snap(p: Point): Point;
  appends(): boolean;          // whether the goal tool adds goals
  selection(): Selection;
  refuse(sentence: string): void;
  /** Called during a drag, with the pose where it began; `done` at its end. */
  move(id: number, pose: Pose, from: Pose, done: boolean): void;
  select(selection: Selection): void;
  draft(draft: Draft): void;
  hover(id: number | null): void;
  changed(): void;
  /** The goal of an arm's hand. */
  arm?(): { near(view: View, px: Point): boolean; drag(view: View, px: Point): Drawing | null } | null;
}

/** A target that only shows: its view moves, and nothing is edited. */
export function only_looking(scene: SceneState, view: View, changed: () => void): GestureTarget {
  const nothing = () => undefined;
  return {
    scene, view, changed, tool: () => "pan", can_edit: () => false, appends: () => false, selection: () => null,
    snap: (p) => p, set_goal: nothing, add_goal: nothing, change_goal: nothing, set_start: nothing, add: nothing,
    change: nothing, move: nothing, select: nothing, draft: nothing, hover: nothing, refuse: nothing,
  };
}

const kDragPixels = 6;   // a shorter way is a click
const kHandlePixels = 14; // about a handle
const kGrabPixels = 8;   // from an obstacle's edge a press still hits it
const kTurnStep = Math.PI / 36; // [rad] of a turn by the handle

/** A gesture that draws: its draft while the pointer is at `to` in W, and its edit at the end. */
export interface Drawing {
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
  private sketch_: Point[] = []; // corners so far of a polygon, a path or a wall

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
      this.put_back(); // the first finger began a pinch, neither a drag nor a drawing
      this.t_.draft(this.rest());
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

  /** The corners of the sketch so far. */
  get sketch(): Point[] {
    return this.sketch_;
  }
  /** One more point of a sketch, by a tap or by the crosshair. */
  tap(p: Point): void {
    const tool = this.t_.tool();
    if (is_sketch(tool)) this.take(sketched(tool, this.sketch_, p, kGrabPixels / this.t_.view.scale));
  }
  /** Ends the sketch where it is. */
  finish_sketch(): void {
    const tool = this.t_.tool();
    if (is_sketch(tool)) this.take(finished(tool, this.sketch_));
  }
  private take(step: Sketched): void {
    if ("refusal" in step) this.t_.refuse(step.refusal);
    if ("points" in step) this.sketch_ = step.points;
    if ("obstacle" in step) {
      this.sketch_ = [];
      this.t_.add(step.obstacle);
    }
    this.t_.draft(this.rest());
    this.t_.changed();
  }

  /** For Escape, another tool or a lost pointer: puts a moved obstacle back. */
  cancel(): void {
    this.put_back();
    this.active_ = null;
    this.pointers_.clear();
    this.measure_ = undefined;
    this.sketch_ = [];
    this.t_.draft({});
    this.t_.changed();
  }
  private put_back(): void {
    const active = this.active_;
    if (active?.kind === "move" && active.moved) this.t_.move(active.id, active.from, active.from, true);
  }

  private begin(px: Point, shift: boolean): Active | null {
    const at = this.t_.view.to_world(px.x, px.y);
    const tool = this.t_.tool();
    if (tool === "measure") return { kind: "measure", at };
    if (tool === "pan" && this.t_.looks_back?.()) return pan(px, true);
    if (tool !== "pan") this.t_.will_edit?.();
    const { scene } = this.t_;
    this.measure_ = undefined;
    if (is_sketch(tool)) return this.sketching(px); // also on an obstacle: walls meet
    if (tool === "pose") return this.posing(px, at);
    const arm = this.t_.arm?.();
    if (tool === "hand" || (arm?.near(this.t_.view, px) && this.t_.selection()?.kind === "hand")) {
      return arm?.drag(this.t_.view, px) ?? pan(px, false);
    }
    const handle = this.handle_at(px);
    if (handle) return this.by_handle(px, handle);
    const under = this.obstacle_at(px);
    const obstacle = tool !== "pan" && under && is_ground(under) ? null : under; // goals and shapes are put on ground
    const selected = this.t_.selection();
    const held = obstacle && selected?.kind === "obstacle" && selected.id === obstacle.id;
    // The resting tool moves the selection alone: a view that is dragged moves nothing by mistake.
    if (tool === "pan" && !held && !this.selected_goal_at(px)) return pan(px, true);
    const new_goal = (to: Point, dragged: boolean) => dragged_goal(this.t_.snap(at), to, dragged);
    const adds = shift || this.t_.appends();
    if (tool === "goal" && shift) return drawn_goal(px, new_goal, (to) => this.t_.add_goal(to));
    if (obstacle) return this.hold(px, at, obstacle);
    const goal = this.goal_at(px);
    if (goal) return this.hold_goal(px, at, goal);
    if (tool === "start") {
      const start = (to: Point, dragged: boolean) => dragged_start(this.t_.snap(at), to, dragged, scene.start);
      return {
        kind: "draw", px, draft: (to, dragged) => ({ start: start(to, dragged) }),
        finish: (to, dragged) => this.t_.set_start(start(to, dragged)),
      };
    }
    if (tool === "goal") {
      return drawn_goal(px, new_goal, (to) => {
        if (adds) this.t_.add_goal(to);
        else {
          this.t_.select({ kind: "goal" });
          this.t_.set_goal(to);
        }
      });
    }
    return tool === "pan" ? pan(px, true) : this.drawing(px, at, tool);
  }

  /** Tells the robot where it is. */
  private posing(px: Point, at: Point): Drawing {
    const pose = (to: Point, dragged: boolean) => dragged_start(at, to, dragged, this.t_.scene.frame?.pose ?? null);
    return {
      kind: "draw", px, draft: (to, dragged) => ({ pose: pose(to, dragged) }),
      finish: (to, dragged) => this.t_.set_pose?.(pose(to, dragged)),
    };
  }

  /** An obstacle of one drag. */
  private drawing(px: Point, at: Point, tool: DragTool): Drawing {
    const { obstacles } = this.t_.scene;
    const drawn = (to: Point, dragged: boolean) => dragged_obstacle(tool, this.t_.snap(at), this.t_.snap(to), dragged, obstacles);
    return {
      kind: "draw", px,
      draft: (to, dragged) => ({ obstacle: drawn(to, dragged) ?? undefined }),
      finish: (to, dragged) => {
        const made = drawn(to, dragged);
        if (made) this.t_.add(made);
      },
    };
  }

  /** A tap adds a point; a drag with the wall tool draws the whole wall. */
  private sketching(px: Point): Drawing {
    const at = this.t_.view.to_world(px.x, px.y);
    const whole = this.t_.tool() === "wall" && this.sketch_.length === 0 ? this.drawing(px, at, "wall") : null;
    return {
      kind: "draw", px,
      draft: (to, dragged) => (whole && dragged ? whole.draft(to, true)
        : { sketch: [...this.sketch_, this.t_.snap(to)] }),
      finish: (to, dragged) => {
        if (whole && dragged) whole.finish(to, true);
        else this.tap(this.t_.snap(dragged ? to : at));
      },
    };
  }

  private by_handle(px: Point, { obstacle, handle }: { obstacle: Obstacle; handle: Handle }): Drawing {
    let last = obstacle;
    const at = (to: Point): Obstacle => {
      const made = handle.kind === "turn" ? turned(handle.to(to)!)
        : handle.to(this.t_.snap(to));
      return (last = made ?? last);
    };
    return {
      kind: "draw", px, draft: (to) => ({ obstacle: at(to) }),
      finish: (to, dragged) => {
        if (dragged) this.t_.change(handle.label, obstacle, at(to));
      },
    };
  }

  /** Something that moves by itself is moved with its path, as one edit. */
  private hold(px: Point, at: Point, obstacle: Obstacle): Active | null {
    this.t_.select({ kind: "obstacle", id: obstacle.id });
    if (!this.t_.can_edit() || is_robot(obstacle)) return null;
    const { id, pose } = obstacle;
    if (!obstacle.path) return { kind: "move", id, from: pose, offset: offset_of(pose, at), px, moved: false };
    const moved = (to: Point) => with_path(obstacle, round_cm(to.x - at.x), round_cm(to.y - at.y));
    return {
      kind: "draw", px, draft: (to) => ({ obstacle: moved(to) }),
      finish: (to, dragged) => {
        if (dragged) this.t_.change("Move path", obstacle, moved(to));
      },
    };
  }

  private hold_goal(px: Point, at: Point, { goal, index }: { goal: Goal; index: number | null }): Active {
    this.t_.select(index === null ? { kind: "goal" } : { kind: "goal", index });
    const offset = offset_of(goal, at);
    const snap = (p: Point) => (index === null ? shifted(p, offset) : this.t_.snap(shifted(p, offset)));
    return drawn_goal(px, (to) => ({ ...goal, ...snap(to) }), (to, dragged) => {
      if (!dragged) return;
      if (index === null) this.t_.set_goal(to);
      else this.t_.change_goal(index, to);
    });
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
        const pose = { ...active.from, ...this.t_.snap(shifted(to, active.offset)) };
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
      this.t_.move(active.id, { ...active.from, ...this.t_.snap(shifted(to, active.offset)) }, active.from, true);
    }
    this.t_.changed();
  }

  /** Selects the object under the pointer, and changes nothing. */
  private inspect(px: Point): void {
    const obstacle = this.obstacle_at(px);
    const goal = this.goal_at(px);
    if (this.t_.arm?.()?.near(this.t_.view, px)) this.t_.select({ kind: "hand" });
    else if (obstacle) this.t_.select({ kind: "obstacle", id: obstacle.id });
    else if (goal) this.t_.select(goal.index === null ? { kind: "goal" } : { kind: "goal", index: goal.index });
    else this.t_.select(null);
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

  /** The draft between gestures: the last measured line, the sketch so far. */
  private rest(): Draft {
    if (this.measure_) return { measure: this.measure_ };
    return this.sketch_.length > 0 ? { sketch: this.sketch_ } : {};
  }

  /** The goal under the pointer, with its place in the list; real hardware has but one to move. */
  private goal_at(px: Point): { goal: Goal; index: number | null } | null {
    const { scene: { goal, route }, view } = this.t_;
    const at = view.to_world(px.x, px.y);
    const hit = (g: Goal) => distance(g, at) * view.scale < Math.max(14, 0.22 * view.scale);
    if (!this.t_.can_edit()) return goal && hit(goal) ? { goal, index: null } : null;
    const index = route.goals.map(hit).lastIndexOf(true);
    if (index >= 0) return { goal: route.goals[index], index: route.goals.length > 1 ? index : null };
    return goal && hit(goal) ? { goal, index: null } : null;
  }
  private selected_goal_at(px: Point): boolean {
    const s = this.t_.selection();
    const goal = this.goal_at(px);
    return goal !== null && s?.kind === "goal" && (s.index ?? null) === goal.index;
  }

  /** The handle of the selected obstacle under the pointer. */
  private handle_at(px: Point): { obstacle: Obstacle; handle: Handle } | null {
    const s = this.t_.selection();
    if (s?.kind !== "obstacle" || !this.t_.can_edit()) return null;
    const obstacle = this.t_.scene.obstacles.find((o) => o.id === s.id);
    if (!obstacle) return null;
    const at = this.t_.view.to_world(px.x, px.y);
    const reach = kHandlePixels / this.t_.view.scale;
    // The middle of a small obstacle, all of which is near a handle, still moves it.
    const middle = obstacle.path ? Infinity : distance(obstacle.pose, at);
    const within = Math.min(reach, middle);
    const handle = least(handles_of(obstacle), (h) => distance(h.at, at));
    return handle && distance(handle.at, at) <= within ? { obstacle, handle } : null;
  }

  private obstacle_at(px: Point): Obstacle | null {
    const at = this.t_.view.to_world(px.x, px.y);
    return topmost(this.t_.scene.obstacles, at, kGrabPixels / this.t_.view.scale);
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

/** `o` turned to the nearest step. */
function turned(o: Obstacle): Obstacle {
  return { ...o, pose: { ...o.pose, heading: Math.round(o.pose.heading / kTurnStep) * kTurnStep } };
}
