// web/src/edit/editor.ts: what people do to the world: edits, goals, other runs; each with its undo.
import type { App } from "../app";
import { Accepted, RequestJson, ScenarioDocument } from "../contract";
import { Point, Pose } from "../geometry";
import { Goal } from "../link/frame";
import * as rest from "../link/rest";
import { session_path } from "../link/session";
import { Obstacle } from "../obstacle";
import { kCompareStep, kGoalStep, kObstacleStep } from "../state/first_steps";
import { Route } from "../state/goals";
import { robot_pose } from "../state/scene";
import {
  Step, add_edit, change_edit, goal_json, goal_request, move_edit, move_request, route_edit, start_edit,
  without_goal,
} from "./edits";
import { Edit, EditHistory } from "./history";
import { snapped } from "./snap";
import { change_since } from "./stands";

const kMostBytes = 200_000; // of a message: the server closes the connection at 256 kB
const kStateWait = 500;     // [ms] for the state that shows an edit
const kStateLook = 20;      // [ms]
const kSnapPixels = 12;     // about a corner
const kMoveMs = 90;         // [ms] between two requests of one drag

/** The parts of a session that a load changes. */
interface LoadChange {
  scenario?: string; controller?: string; filter?: string; physics?: string; robot?: string;
}

export class Editor {
  readonly history: EditHistory;
  private readonly begun_ = new WeakMap<Step, number>(); // the run that a load has begun
  private drag_: { busy: boolean; sent: number } | null = null;

  constructor(private readonly app_: App) {
    this.history = new EditHistory({
      send: (step) => this.send(step),
      stands: (step) => this.stands(step),
      changed: () => app_.ui.set({ undo: this.history.can_undo, redo: this.history.can_redo }),
    });
  }

  /** Sends an edit of the world as it is now, and shows that. */
  async edit(edit: Edit): Promise<Accepted | null> {
    this.app_.go_live();
    return this.told(await this.app_.attempt(this.history.perform(edit)));
  }
  /** Shows the warning of the answer. */
  private told(answer: Accepted | null): Accepted | null {
    if (answer?.warning) this.app_.toast("warn", answer.warning);
    return answer;
  }

  private async send(step: Step): Promise<Accepted> {
    if (step.type === "start") return this.app_.link.call("/start", step.pose);
    if (step.type !== "load") return this.app_.link.call("/request", step);
    const before = this.app_.ui.value.session?.run?.id;
    this.app_.ui.set({ loading: "", selection: null });
    try {
      const answer = await this.app_.link.call<Accepted>("/load", step.body);
      await this.until(() => this.app_.ui.value.session?.run?.id !== before);
      this.begun_.set(step, this.app_.ui.value.session?.run?.id ?? 0);
      return answer;
    } finally {
      this.app_.ui.set({ loading: null });
    }
  }

  /** What others have changed since `step`. The state that an answer announces comes a moment later. */
  private async stands(step: Step): Promise<string | null> {
    if (step.type === "load") {
      return this.begun_.get(step) === this.app_.ui.value.session?.run?.id ? null
        : "Somebody else has begun another run since.";
    }
    await this.until(() => change_since(step, this.app_.scene) === null);
    return change_since(step, this.app_.scene);
  }

  /** Waits for `reached`, half a second at most. */
  private async until(reached: () => boolean): Promise<void> {
    for (let waited = 0; !reached() && waited < kStateWait; waited += kStateLook) {
      await new Promise((resolve) => setTimeout(resolve, kStateLook));
    }
  }

  /** Adds the obstacle and selects it, unless somebody took another tool or object meanwhile. */
  async add(obstacle: Obstacle): Promise<boolean> {
    const before = this.app_.ui.value;
    const answer = await this.edit(add_edit(obstacle));
    const { tool, selection } = this.app_.ui.value;
    const waits = tool === before.tool && selection === before.selection;
    if (answer?.id !== undefined && waits) this.app_.ui.set({ selection: { kind: "obstacle", id: answer.id } });
    if (answer) this.app_.done_step(kObstacleStep);
    return answer !== null;
  }

  async undo(): Promise<void> {
    this.app_.go_live();
    const label = await this.app_.attempt(this.history.undo());
    if (label) this.app_.say(`Undone: ${label}`);
  }
  async redo(): Promise<void> {
    this.app_.go_live();
    const label = await this.app_.attempt(this.history.redo());
    if (label) this.app_.say(`Done again: ${label}`);
  }

  /**
   * A drag of obstacle `id`. Poses are sent at a steady pace, and the last one always. The whole
   * drag is one step of undo.
   */
  drag(id: number, pose: Pose, from: Pose, done: boolean): void {
    const drag = (this.drag_ ??= { busy: false, sent: 0 });
    if (done) {
      this.drag_ = null;
      void this.finish_drag(id, pose, from);
      return;
    }
    const now = performance.now();
    if (drag.busy || now - drag.sent < kMoveMs) return;
    drag.busy = true;
    drag.sent = now;
    // A refusal on the way needs no toast: the end of the drag shows one.
    this.app_.link.call("/request", move_request(id, pose)).catch(() => undefined)
      .finally(() => (drag.busy = false));
  }

  /** A refused end goes back to where the drag began. One that is put back there needs no undo. */
  private finish_drag(id: number, pose: Pose, from: Pose): Promise<void> {
    return this.history.take(async () => {
      const o = this.app_.scene.obstacles.find((o) => o.id === id);
      if (await this.app_.request(move_request(id, pose))) return o && pose !== from ? move_edit(o, from, pose) : null;
      this.app_.link.call("/request", move_request(id, from)).catch(() => undefined);
      return null;
    });
  }

  /** Loads a scenario, or the same one with another controller, filter, physics or robot. */
  async load(change: LoadChange): Promise<void> {
    const s = this.app_.ui.value.session;
    if (!s || this.app_.ui.value.loading !== null) return;
    const log = this.app_.ui.value.scenarios.find((x) => x.name === (change.scenario ?? s.scenario.name))?.kind === "log";
    // A log has no controller and no physics. Without a scenario, the world stays as it stands.
    const body = log ? { scenario: change.scenario ?? s.scenario.name, filter: change.filter ?? s.filter }
      : { ...change };
    const label = change.scenario !== undefined ? "Open another world" : "Change the run";
    await this.change_run(label, body);
    if (change.controller) this.app_.done_step(kCompareStep);
    if (change.scenario === s.scenario.name) this.app_.fit_view(); // another one has its own camera
  }

  /** Loads a world that nobody saved. */
  async new_world(scenario: ScenarioDocument): Promise<void> {
    if (await this.change_run("New world", { scenario })) this.app_.fit_view();
  }

  /** Begins another run, which undo takes back: the world, the gains and the robot's place. */
  async change_run(label: string, body: Record<string, unknown>): Promise<boolean> {
    const back = await this.way_back();
    const answer = await this.edit({ label, forward: { type: "load", body }, backward: back });
    return answer !== null;
  }

  /** The step that brings back the world as it stands; null where that cannot be. */
  private async way_back(): Promise<Step | null> {
    const s = this.app_.ui.value.session;
    if (!s || s.source !== "simulation") return null;
    const begin = robot_pose(this.app_.scene);
    try {
      const scenario = await rest.get<ScenarioDocument>(session_path("/scenario")); // no size that cuts the link
      const body = { scenario, seed: s.seed, ...(begin && { begin }) };
      return JSON.stringify(body).length < kMostBytes ? { type: "load", body } : null;
    } catch {
      return null;
    }
  }

  /** The goal that edits change: the preview, else the robot's own. */
  get shown_goal(): Goal | null {
    return this.app_.ui.value.preview?.goal ?? this.app_.scene.goal;
  }

  /** A simulated robot drives at once; real hardware only after go_there(). */
  want_goal(goal: Goal | null, further = false): void {
    this.app_.go_live();
    if (goal && this.app_.desk?.carry(goal)) return;
    if (!this.app_.on_hardware) {
      const { route } = this.app_.scene;
      const appends = goal && further && route.goals.length > 0;
      const asked = appends ? this.want_route("Add waypoint", { ...route, goals: [...route.goals, goal] })
        : this.want_route(goal ? "Set goal" : "Clear goals", { goals: goal ? [goal] : [], next: 0, loop: false });
      if (goal) void asked.then((answer) => answer && this.app_.done_step(kGoalStep));
    } else if (goal) {
      void this.preview(goal, further);
    } else {
      this.app_.ui.set({ preview: null });
      if (this.app_.scene.goal) void this.app_.request(goal_request(null));
    }
  }
  /** Replaces all goals of a simulated robot. */
  want_route(label: string, to: Route): Promise<Accepted | null> {
    const { route, arm_asked: asked } = this.app_.scene;
    const edit = route_edit(label, route, to);
    return this.edit(asked && asked.type !== "set_joints" ? { ...edit, backward: asked } : edit);
  }
  /** Changes shape, size or path of an obstacle. */
  change(label: string, from: Obstacle, to: Obstacle): Promise<Accepted | null> {
    return this.edit(change_edit(label, from, to));
  }
  /** Tells the robot where it is on its map; null: anywhere. There is no undo: it looks for its place anew. */
  async set_pose(pose: Pose | null): Promise<void> {
    this.app_.go_live();
    const answer = this.told(await this.app_.request({ type: "set_initial_pose", ...(pose ?? {}) }));
    if (answer && !answer.warning && pose) this.app_.pick_tool("pan");
  }
  set_start(pose: Pose): void {
    if (this.app_.scene.start) void this.edit(start_edit(this.app_.scene.start, pose));
  }
  /** A point of a drawing, pulled to corners and round numbers where the person wants that. */
  snap(p: Point): Point {
    return snapped(p, this.app_.scene.obstacles, kSnapPixels / this.app_.view.scale, this.app_.ui.value.snap);
  }
  /** Changes one goal of the list, or takes it out. */
  change_goal(index: number, goal: Goal | null): void {
    const { route } = this.app_.scene;
    if (goal) void this.want_route("Move goal", { ...route, goals: route.goals.map((g, i) => (i === index ? goal : g)) });
    else void this.want_route("Remove goal", without_goal(route, index));
  }
  private async preview(goal: Goal, further: boolean): Promise<void> {
    const preview = { goal, further, trouble: null };
    this.app_.ui.set({ preview, selection: { kind: "goal" } });
    this.app_.redraw();
    const answer = await this.app_.ask<{ trouble: string | null }>("/check_goal", goal_json(goal));
    if (answer && this.app_.ui.value.preview === preview) this.app_.ui.set({ preview: { ...preview, trouble: answer.trouble } });
  }
  drop_preview(): void {
    this.app_.ui.set({ preview: null });
    this.app_.redraw();
  }
  /** Sends the goal of the preview. There is no undo: it would drive the robot somewhere else. */
  async go_there(): Promise<void> {
    const preview = this.app_.ui.value.preview;
    if (!preview) return;
    this.app_.go_live();
    const further: RequestJson = { type: "add_goal", ...goal_json(preview.goal) };
    const request = preview.further ? further : goal_request(preview.goal);
    if (await this.app_.request(request)) this.app_.ui.set({ preview: null, selection: null });
    this.app_.redraw();
  }
  /** The world stays as it stands; only the robot goes back to its start. */
  async reset(): Promise<void> {
    this.app_.go_live();
    if (this.app_.on_hardware) {
      await this.app_.ask("/reset");
      this.app_.ui.set({ selection: null });
    } else {
      await this.change_run("Reset", {});
    }
  }
}
